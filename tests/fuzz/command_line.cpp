// Any words whatever, one a line, against a table with every kind of word: `parse` gives a match whose values
// can be asked for, or throws UsageError, and nothing else comes out.
#include "cli/command.h"
#include "cli/match.h"
#include "cli/parse.h"
#include "cli/usage_error.h"
#include "cli/word.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace ray::cli;

const Command& command() {
  static const Command table{
      .name = "raything",
      .summary = "try every kind of word",
      .usages = {{.name = "width", .words = {cloud(), length("WIDTH")}},
                 {.name = "every", .words = {cloud(), count("N", "ray")}},
                 {.name = "limit",
                  .words = {cloud(), length("WIDTH"), integer("MOST", kPositive), literal("points")}},
                 {.name = "sigma", .words = {cloud(), quantity("N", "sigma")}},
                 {.name = "share", .words = {cloud(), literal("time"), quantity("P", "%")}},
                 {.name = "spacing", .words = {cloud(), length_per("WIDTH", "ray")}},
                 {.name = "move", .words = {cloud(), vector("X,Y,Z[,T]")}},
                 {.name = "paint", .words = {literal("paint"), clouds(), colour()}},
                 {.name = "box",
                  .words = {cloud(), literal("box"), vector("X,Y,Z"),
                            optional(vector("RX,RY,RZ", kPositive))}},
                 {.name = "view",
                  .words = {cloud(), choice("VIEW", {"top", "left"}), output("IMAGE", {".png"})}},
                 {.name = "merge",
                  .words = {choice("RULE", {"min", "max"}), inputs("SCANS"), number("S", between(0, 1))}}},
      .options = {{.name = "lit", .letter = 'l'},
                  {.name = "size", .letter = 's', .value = size("BYTES"), .fallback = "4GB"},
                  {.name = "pixels", .value = integer("PIXELS", kPositive), .fallback = "512"},
                  {.name = "shift", .value = vector("X,Y,Z"), .usages = {"width", "box"}},
                  output_option("CLOUD_thing.ply"),
                  view_option()}};
  return table;
}

void ask_for_values(const Match& match) {
  const Usage& usage = command().usages.at(match.usage_index());
  for (const Word& word : usage.words) {
    if (!match.has(word.name)) continue;
    switch (word.kind) {
      case Kind::integer:
      case Kind::count:
        (void)match.integer(word.name);
        break;
      case Kind::number:
      case Kind::quantity:
        (void)match.number(word.name);
        break;
      case Kind::length:
        (void)match.length(word.name);
        break;
      case Kind::vector:
        (void)match.components(word.name);
        break;
      case Kind::inputs:
        (void)match.files(word.name);
        break;
      case Kind::literal:
        break;
      default:
        (void)match.text(word.name);
    }
  }
  (void)match.integer("--size");
  (void)match.integer("--pixels");
  (void)match.history();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::string> arguments;
  std::string word;
  for (const char letter : std::string_view(reinterpret_cast<const char*>(data), size)) {
    if (letter == '\n') {
      arguments.push_back(word);
      word.clear();
    } else if (letter != '\0') {  // no argument of a process has one
      word += letter;
    }
  }
  if (!word.empty()) arguments.push_back(word);
  try {
    ask_for_values(parse(command(), arguments));
  } catch (const UsageError& error) {
    (void)error.picture();
  }
  return 0;
}
