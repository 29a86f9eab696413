#include "cli/fit.h"

#include "cli/suggest.h"

#include <tuple>
#include <utility>

namespace ray::cli {
namespace {

/// Tries one usage after the other and remembers what went wrong where.
class Fitting {
 public:
  Fitting(const Command& command, std::span<const std::string> words)
      : command_(command), words_(words), reserved_(reserved_words(command)) {}

  Fit best() {
    for (usage_ = 0; usage_ < command_.usages.size(); ++usage_) {
      assigned_.clear();
      ranks_.clear();
      if (!from(0, 0)) continue;
      if (result_.fits && !(ranks_ > best_ranks_)) continue;
      best_ranks_ = ranks_;
      result_.fits = true;
      result_.usage = usage_;
      result_.assigned = assigned_;
    }
    return std::move(result_);
  }

  std::vector<Expected> at_end() {
    for (usage_ = 0; usage_ < command_.usages.size(); ++usage_) {
      assigned_.clear();
      ranks_.clear();
      static_cast<void>(from(0, 0));
    }
    return std::move(at_end_);
  }

 private:
  /// Whether the usage's words from `word` on fit the arguments from `at` on.
  bool from(std::size_t word, std::size_t at) {
    const std::vector<Word>& usage = command_.usages[usage_].words;
    if (word == usage.size()) {
      if (at == words_.size()) return true;
      failed({.usage = usage_}, at, false);
      return false;
    }
    if (is_list(usage[word])) return list_from(word, at);
    return one_from(word, at) || (usage[word].optional && from(word + 1, at));
  }

  bool one_from(std::size_t word, std::size_t at) {
    const Word& wanted = command_.usages[usage_].words[word];
    Reading reading = read(wanted, words_.subspan(at), reserved_);
    const std::size_t ranks_before = ranks_.size();
    ranks_.insert(ranks_.end(), reading.ranks.begin(), reading.ranks.end());
    bool good = reading.used > 0;
    if (good) {
      assigned_.push_back({&wanted, at, reading.used, std::move(reading.numbers)});
      good = from(word + 1, at + reading.used);
      if (!good) assigned_.pop_back();
    } else {
      failed({usage_, &wanted, reading.wrong == 1}, at + reading.wrong, reading.sure);
    }
    if (!good) ranks_.resize(ranks_before);
    return good;
  }

  /// As many arguments as can be, then fewer until the rest of the usage fits.
  bool list_from(std::size_t word, std::size_t at) {
    const Word& wanted = command_.usages[usage_].words[word];
    const std::size_t ranks_before = ranks_.size();
    std::size_t end = at;
    while (end < words_.size() && read(wanted, words_.subspan(end), reserved_).used > 0)
      ++end;
    ranks_.resize(ranks_before + (end - at), is_file(wanted) ? Rank::file : Rank::text);
    failed({.usage = usage_, .word = &wanted}, end, false);
    for (; end > at; --end) {
      assigned_.push_back({&wanted, at, end - at, {}});
      if (from(word + 1, end)) return true;
      assigned_.pop_back();
      ranks_.pop_back();
    }
    return wanted.optional && from(word + 1, at);
  }

  /// Keeps the failures that tell most: sure ones first, then the furthest, then those of the most specific
  /// usage.
  void failed(const Expected& expected, std::size_t at, bool sure) {
    if (at == words_.size()) at_end_.push_back(expected);
    if (at < words_.size() && expected.word != nullptr) sure = sure || nearly(expected, words_[at]);
    const auto place = std::make_tuple(sure, at);
    const auto kept = std::make_tuple(sure_, result_.wrong);
    if (place < kept) return;
    if (place > kept) {
      result_.expected.clear();
      closest_ranks_.clear();
    }
    if (result_.expected.empty() || ranks_ > closest_ranks_) {
      if (!result_.fits) result_.usage = usage_;
      closest_ranks_ = ranks_;
    }
    sure_ = sure;
    result_.wrong = at;
    result_.expected.push_back(expected);
  }

  static bool nearly(const Expected& expected, const std::string& typed) {
    return !nearest(typed, expected.unit ? unit_words(*expected.word) : spelled_words(*expected.word))
                .empty();
  }

  const Command& command_;
  std::span<const std::string> words_;
  Reserved reserved_;
  std::size_t usage_ = 0;
  std::vector<Assigned> assigned_;
  std::vector<Rank> ranks_;
  std::vector<Rank> best_ranks_;
  std::vector<Rank> closest_ranks_;
  std::vector<Expected> at_end_;
  bool sure_ = false;
  Fit result_;
};

}  // namespace

Fit fit(const Command& command, std::span<const std::string> words) {
  return Fitting(command, words).best();
}

std::vector<Expected> continuations(const Command& command, std::span<const std::string> words) {
  return Fitting(command, words).at_end();
}

Reserved reserved_words(const Command& command) {
  Reserved reserved;
  for (const Usage& usage : command.usages) {
    for (const Word& word : usage.words) {
      for (std::string& fixed : fixed_words(word))
        reserved.insert(std::move(fixed));
    }
  }
  return reserved;
}

}  // namespace ray::cli
