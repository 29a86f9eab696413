#include "cli/split_options.h"

#include "cli/shell_words.h"
#include "cli/suggest.h"
#include "cli/value.h"

#include <algorithm>
#include <utility>

namespace ray::cli {
namespace {

bool looks_like_option(const std::string& argument) {
  return argument.starts_with('-') && !is_negative_value(argument);
}

std::string underscored(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

class Splitter {
 public:
  Splitter(std::span<const Option> options, std::span<const std::string> arguments)
      : options_(options), arguments_(arguments) {}

  SplitLine split() {
    bool ended = false;
    for (at_ = 0; at_ < arguments_.size(); ++at_) {
      const std::string& argument = arguments_[at_];
      if (ended || !looks_like_option(argument)) {
        line_.words.push_back(argument);
        line_.words_at.push_back(at_);
      } else if (argument == "--") {
        ended = true;
      } else {
        option(argument);
      }
    }
    return std::move(line_);
  }

 private:
  void option(const std::string& argument) {
    const std::size_t equals = argument.starts_with("--") ? argument.find('=') : std::string::npos;
    const std::string name = argument.substr(0, equals);
    const std::size_t found = find(name);
    if (found == options_.size()) return mistake(unknown(name), at_);
    const bool twice = std::any_of(line_.given.begin(), line_.given.end(),
                                   [&](const GivenOption& other) { return other.option == found; });
    GivenOption given{.option = found, .at = at_, .value_at = at_};
    const std::string shown = "--" + options_[found].name;
    if (twice) mistake(shown + " is given twice", at_);
    if (!options_[found].value) {
      if (equals != std::string::npos) return mistake(shown + " takes no value", at_);
    } else if (equals != std::string::npos) {
      given.text = argument.substr(equals + 1);
      read_value(given);
    } else if (at_ + 1 < arguments_.size() && !looks_like_option(arguments_[at_ + 1])) {
      given.value_at = ++at_;
      given.text = arguments_[at_];
      read_value(given);
    } else {
      if (at_ + 1 == arguments_.size()) line_.awaits_value = found;
      return mistake(shown + " needs a value: " + expectation(*options_[found].value), at_ + 1);
    }
    line_.given.push_back(std::move(given));
  }

  void read_value(GivenOption& given) {
    const Option& taken = options_[given.option];
    Reading reading = read(*taken.value, std::span(&given.text, 1), {});
    given.numbers = std::move(reading.numbers);
    if (reading.used == 1) return;
    mistake("--" + taken.name + " takes " + expectation(*taken.value) + ", not " + shell_quoted(given.text) +
                did_you_mean(given.text, fixed_words(*taken.value)),
            given.value_at);
  }

  std::size_t find(const std::string& name) const {
    const auto same = [&](const Option& option) {
      if (name.size() == 2) return option.letter != 0 && name[1] == option.letter;
      return underscored(name.substr(std::min<std::size_t>(2, name.size()))) == underscored(option.name);
    };
    const bool is_name = name.size() == 2 || name.starts_with("--");
    const auto found = is_name ? std::find_if(options_.begin(), options_.end(), same) : options_.end();
    return static_cast<std::size_t>(found - options_.begin());
  }

  std::string unknown(const std::string& name) const {
    std::vector<std::string> names;
    for (const Option& option : options_)
      names.push_back("--" + option.name);
    return "there is no option " + shell_quoted(name) + did_you_mean(name, names);
  }

  void mistake(std::string message, std::size_t at) { line_.mistakes.push_back({std::move(message), at}); }

  std::span<const Option> options_;
  std::span<const std::string> arguments_;
  std::size_t at_ = 0;
  SplitLine line_;
};

}  // namespace

SplitLine split_options(std::span<const Option> options, std::span<const std::string> arguments) {
  return Splitter(options, arguments).split();
}

}  // namespace ray::cli
