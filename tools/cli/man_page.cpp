#include "cli/generate.h"
#include "cli/help.h"
#include "cli/layout.h"

#include <cctype>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace ray::cli {
namespace {

/// The code point at the front of valid UTF-8, which it removes.
std::uint32_t take_code_point(std::string_view& text) {
  const auto lead = static_cast<unsigned char>(text.front());
  std::size_t size = lead < 0x80u ? 1 : lead >= 0xF0u ? 4 : lead >= 0xE0u ? 3 : 2;
  std::uint32_t point = size == 1 ? lead : lead & (0xFFu >> (size + 1));
  text.remove_prefix(1);
  for (; size > 1 && !text.empty(); --size, text.remove_prefix(1)) {
    point = (point << 6) | (static_cast<unsigned char>(text.front()) & 0x3Fu);
  }
  return point;
}

/// Text as roff, with what is in back-quotes in bold.
std::string roff(std::string_view text) {
  std::string out;
  bool bold = false;
  if (!text.empty() && (text.front() == '.' || text.front() == '\'')) out += "\\&";
  while (!text.empty()) {
    const std::uint32_t point = take_code_point(text);
    char escape[16];
    std::snprintf(escape, sizeof escape, "\\[u%04X]", static_cast<unsigned>(point));
    if (point >= 0x80u) {
      out += escape;
    } else if (point == '`') {
      out += bold ? "\\fR" : "\\fB";
      bold = !bold;
    } else if (point == '\\') {
      out += "\\e";
    } else if (point == '-') {
      out += "\\-";
    } else {
      out += static_cast<char>(point);
    }
  }
  return out;
}

std::string bold(const std::string& text) {
  return "\\fB" + roff(text) + "\\fR";
}

std::string section(const std::string& title) {
  return ".SH " + title + "\n";
}

std::string prose(std::string_view text) {
  std::string out;
  for (const TextBlock& block : text_blocks(text)) {
    if (block.words.empty()) out += ".PP\n" + roff(block.text) + "\n";
    for (const auto& [word, meaning] : block.words)
      out += ".TP\n" + bold(word) + "\n" + roff(meaning) + "\n";
  }
  return out;
}

std::string sentence(std::string text) {
  if (text.empty()) return text;
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text + ".";
}

std::string usage_lines(const Command& command) {
  std::string out;
  for (const Usage& usage : command.usages)
    out += bold(form(command, usage)) + "\n.br\n";
  return out;
}

std::string usage_section(const Command& command) {
  std::string out;
  for (const Usage& usage : command.usages) {
    out += ".TP\n" + bold(form(command, usage)) + "\n" + roff(sentence(usage.help)) + "\n";
  }
  return out;
}

std::string option_section(const Command& command) {
  std::string out;
  for (const Option& option : all_options(command)) {
    const std::string only = takers(command, option);
    const std::string about = help_text(option) + (only.empty() ? "" : "; " + only);
    out += ".TP\n" + bold(signature(option)) + "\n" + roff(sentence(about)) + "\n";
  }
  return out;
}

std::string example_section(const Command& command) {
  std::string out;
  for (const Usage& usage : command.usages) {
    out += ".TP\n" + bold(usage.example) + "\n" + roff(sentence(usage.help)) + "\n";
  }
  return out;
}

std::string see_also(const Command& command) {
  std::string out = "\\fBraycloud\\fR(1)";
  for (const std::string& name : command.see_also)
    out += ", " + bold(name) + "(1)";
  return out + "\n";
}

}  // namespace

std::string man_page(const Command& command) {
  std::string title = command.name;
  for (char& c : title)
    c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  std::string page = ".TH " + title + " 1 \"\" \"raycloudtools " RAYCLOUD_VERSION "\" \"User Commands\"\n";
  page += section("NAME") + roff(command.name) + " \\- " + roff(command.summary) + "\n";
  page += section("SYNOPSIS") + usage_lines(command);
  page += section("DESCRIPTION") + prose(command.description) + usage_section(command) +
          prose(word_remarks(command));
  if (!command.writes.empty()) page += section("OUTPUT") + prose("Writes " + command.writes + ".");
  page += section("OPTIONS") + option_section(command);
  page += section("EXAMPLES") + example_section(command);
  page += section("EXIT STATUS") +
          prose(
              "0: done. 1: a failure, told in one line on standard error. 2: a wrong command line. "
              "130: interrupted.");
  if (!command.memory.empty()) page += section("MEMORY") + prose(command.memory);
  return page + section("SEE ALSO") + see_also(command);
}

}  // namespace ray::cli
