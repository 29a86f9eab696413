#include "support/scratch.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/spill.h>
#include <raycloud/exec/spilled_rows.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace ray {
namespace {

/// TMPDIR is this, for as long as this is.
class TemporaryFolderIs {
 public:
  explicit TemporaryFolderIs(const std::string& folder) {
    if (const char* before = std::getenv("TMPDIR")) before_ = before;
    setenv("TMPDIR", folder.c_str(), 1);
  }
  ~TemporaryFolderIs() {
    if (before_)
      setenv("TMPDIR", before_->c_str(), 1);
    else
      unsetenv("TMPDIR");
  }

 private:
  std::optional<std::string> before_;
};

std::byte byte_at(std::size_t stream, std::size_t i) {
  return static_cast<std::byte>((stream * 71 + i * 13 + i / 251) % 256);
}

/// Appends streams of these lengths in pieces of `piece` bytes, by turns, and reads them by turns in other
/// pieces.
bool come_back(const std::vector<std::size_t>& lengths, std::size_t page, std::size_t piece,
               std::size_t piece_back) {
  Spill spill(lengths.size(), page);
  const std::size_t longest = *std::max_element(lengths.begin(), lengths.end());
  std::vector<std::byte> bytes;
  for (std::size_t at = 0; at < longest; at += piece)
    for (std::size_t s = 0; s < lengths.size(); ++s) {
      bytes.clear();
      for (std::size_t i = at; i < std::min(at + piece, lengths[s]); ++i)
        bytes.push_back(byte_at(s, i));
      spill.append(s, bytes.data(), bytes.size());
    }
  bool same = true;
  for (std::size_t at = 0; at < longest; at += piece_back)
    for (std::size_t s = 0; s < lengths.size(); ++s) {
      const std::size_t end = std::min(at + piece_back, lengths[s]);
      if (at >= end) continue;
      bytes.assign(end - at, std::byte{0xee});
      spill.read(s, bytes.data(), bytes.size());
      for (std::size_t i = at; i < end; ++i)
        same = same && bytes[i - at] == byte_at(s, i);
      if (end == lengths[s]) spill.drop(s);
    }
  for (std::size_t s = 0; s < lengths.size(); ++s)
    same = same && spill.size(s) == lengths[s];
  return same;
}

TEST(Spill, StreamsComeBackForLengthsAroundThePage) {
  for (const std::size_t page : {1UL, 2UL, 7UL, 64UL})
    for (const std::size_t pages : {0UL, 1UL, 2UL, 5UL})
      for (const std::size_t piece : {1UL, 3UL, page, 2 * page + 1})
        for (const std::size_t more : {0UL, 1UL, page - 1})
          EXPECT_TRUE(come_back({pages * page + more, page, 0, 1}, page, piece, 5))
              << page << " " << pages << " " << piece << " " << more;
}

RC_GTEST_PROP(Spill, StreamsComeBack, ()) {
  const auto lengths = *rc::gen::nonEmpty(
      rc::gen::container<std::vector<std::size_t>>(rc::gen::inRange<std::size_t>(0, 2000)));
  const auto size = [](std::size_t most) { return *rc::gen::inRange<std::size_t>(1, most); };
  RC_ASSERT(come_back(lengths, size(300), size(500), size(500)));
}

TEST(Spill, LeavesNothingInTheFolder) {
  const test::Scratch scratch;
  const TemporaryFolderIs folder(scratch.folder().string());
  Spill spill(1, 16);
  const std::array<std::byte, 100> bytes{};
  spill.append(0, bytes.data(), bytes.size());
  EXPECT_TRUE(std::filesystem::is_empty(scratch.folder()));
}

template <class Call>
void expect_file_access(const Call& call) {
  try {
    call();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::file_access);
    EXPECT_NE(std::string(error.what()).find("--memory"), std::string::npos);
  }
}

TEST(Spill, AFolderThatIsMissing) {
  const test::Scratch scratch;
  const TemporaryFolderIs folder(scratch.path("missing").string());
  expect_file_access([] { const Spill spill(1, 16); });
}

TEST(Spill, AFullDisk) {
  // The largest file that this process may write stands for it.
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 1000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  expect_file_access([] {
    Spill spill(2, 64);
    const std::array<std::byte, 100> bytes{};
    for (std::size_t i = 0; i < 20; ++i)
      spill.append(i % 2, bytes.data(), bytes.size());
  });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
}

/// Rows of streams are read in order, again, and one from here and one from there.
RC_GTEST_PROP(SpilledRows, giveEachStreamBackInOrder, ()) {
  struct Row {
    std::uint64_t stream;
    std::uint32_t number;
  };
  const auto to = *rc::gen::container<std::vector<std::uint32_t>>(*rc::gen::inRange<std::size_t>(0, 3000),
                                                                  rc::gen::inRange<std::uint32_t>(0, 7));
  SpilledRows<Row> rows(7, 1);
  std::vector<std::uint32_t> count(7);
  for (const std::uint32_t stream : to) {
    const Row row{stream, count[stream]++};
    rows.append(stream, std::span(&row, 1));
  }
  const auto twice = *rc::gen::inRange<std::uint32_t>(0, 7);
  for (int time = 0; time < 2; ++time) {
    const std::vector<Row> all = rows.load(twice);
    RC_ASSERT(all.size() == count[twice]);
    for (std::uint32_t i = 0; i < all.size(); ++i)
      RC_ASSERT(all[i].stream == twice && all[i].number == i);
  }
  std::fill(count.begin(), count.end(), 0);
  const std::size_t pieces = *rc::gen::inRange<std::size_t>(1, 500);
  for (std::size_t begin = 0; begin < to.size(); begin += pieces) {
    const auto wanted = std::span(to).subspan(begin, std::min(pieces, to.size() - begin));
    const std::span<const Row> taken = rows.take(wanted);
    for (std::size_t i = 0; i < wanted.size(); ++i)
      RC_ASSERT(taken[i].stream == wanted[i] && taken[i].number == count[wanted[i]]++);
  }
}

}  // namespace
}  // namespace ray
