#include "cli/complete.h"

#include "cli/fit.h"
#include "cli/split_options.h"

#include <algorithm>
#include <set>
#include <utility>

namespace ray::cli {
namespace {

/// Collects the lines, each once and only if it continues what is typed.
class Candidates {
 public:
  explicit Candidates(std::string typed) : typed_(std::move(typed)) {}

  void add(const std::string& word, const std::string& about) {
    if (word.starts_with(typed_) && seen_.insert(word).second) lines_ += word + "\t" + about + "\n";
  }

  void add_words(const Word& word, bool unit, const std::string& about) {
    for (const std::string& one : unit ? unit_words(word) : spelled_words(word))
      add(one, about);
    if (!is_file(word)) return;
    files_ = true;
    any_file_ = any_file_ || word.choices.empty();
    extensions_.insert(word.choices.begin(), word.choices.end());
  }

  [[nodiscard]] bool empty() const { return lines_.empty() && !files_; }

  [[nodiscard]] std::string lines() const {
    if (!files_) return lines_;
    std::string wanted = "\t";
    for (const std::string& extension : any_file_ ? std::set<std::string>() : extensions_) {
      wanted += (wanted.size() > 1 ? " " : "") + extension.substr(1);
    }
    return lines_ + wanted + "\n";
  }

 private:
  std::string typed_;
  std::string lines_;
  std::set<std::string> seen_;
  std::set<std::string> extensions_;
  bool files_ = false;
  bool any_file_ = false;
};

}  // namespace

std::string complete(const Command& command, std::span<const std::string> words) {
  const std::string typed = words.empty() ? "" : words.back();
  const std::span<const std::string> before = words.first(words.empty() ? 0 : words.size() - 1);
  const std::vector<Option> options = all_options(command);
  const SplitLine line = split_options(options, before);
  Candidates candidates(typed);
  if (line.awaits_value) {
    const Option& option = options[*line.awaits_value];
    candidates.add_words(*option.value, false, option.help);
    return candidates.lines();
  }
  if (!typed.starts_with("-")) {
    for (const Expected& expected : continuations(command, line.words)) {
      if (expected.word == nullptr) continue;
      candidates.add_words(*expected.word, expected.unit, command.usages[expected.usage].help);
    }
    if (!candidates.empty()) return candidates.lines();
  }
  for (std::size_t i = 0; i < options.size(); ++i) {
    const bool given = std::any_of(line.given.begin(), line.given.end(),
                                   [i](const GivenOption& one) { return one.option == i; });
    if (!given) candidates.add("--" + options[i].name, options[i].help);
  }
  return candidates.lines();
}

}  // namespace ray::cli
