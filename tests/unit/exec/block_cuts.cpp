#include <raycloud/exec/block_cuts.h>
#include <raycloud/exec/random.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace ray::blocks {
namespace {

/// A square of 100 m.
EndSample square(std::uint64_t bounded) {
  const RandomStream random(1, "square");
  EndSample sample{.ends = {}, .bounded = bounded};
  for (std::uint64_t i = 0; i < 20'000; ++i)
    sample.ends.emplace_back(100.0 * random.uniform(i, 0), 100.0 * random.uniform(i, 1), 0.0);
  return sample;
}

/// Records of the largest block with what is around, by asking all ends for all blocks.
double largest_of(const SpaceCuts& cuts, const EndSample& sample, double reach) {
  std::size_t largest = 0;
  for (std::size_t part = 0; part < cuts.parts(); ++part) {
    Eigen::AlignedBox3d box = cuts.box_of(part);
    box.min().array() -= reach;
    box.max().array() += reach;
    std::size_t count = 0;
    for (const Eigen::Vector3d& end : sample.ends)
      count += box.contains(end) ? 1 : 0;
    largest = std::max(largest, count);
  }
  return static_cast<double>(largest) * static_cast<double>(sample.bounded) /
         static_cast<double>(sample.ends.size());
}

TEST(CutsFor, FewBlocksThatFitOrAreNearlyAsSmallAsCanBe) {
  const EndSample sample = square(1'000'000);
  constexpr std::size_t kFitting = 12'000, kMost = 256;
  for (const double reach : {0.0, 0.5, 1.0, 3.0, 10.0, 200.0}) {
    const double enough =
        std::max(1.0 * kFitting, 1.4 * largest_of(SpaceCuts(sample.ends, kMost), sample, reach));
    const SpaceCuts cuts = cuts_for(sample, reach, kFitting);
    EXPECT_LE(largest_of(cuts, sample, reach), enough) << reach;
    EXPECT_GE(cuts.parts(), kMost / 4);
    EXPECT_LE(cuts.parts(), kMost);
  }
  EXPECT_EQ(cuts_for(sample, 0.0, kFitting).parts(), 128U);  // of 8 thousand each
  // All is in all of them, with what is around.
  EXPECT_EQ(cuts_for(sample, 200.0, kFitting).parts(), kMost / 4);
  EXPECT_EQ(cuts_for(sample, std::numeric_limits<double>::infinity(), kFitting).parts(), kMost / 4);
}

TEST(CutsFor, TwoAtLeastAndAThousandAtMost) {
  EXPECT_EQ(cuts_for(square(1000), 0.0, 999).parts(), 2U);
  EXPECT_LE(cuts_for(square(1'000'000), 0.0, 1).parts(), 1024U);
  EXPECT_EQ(cuts_for({}, 1.0, 1).parts(), 1U);
}

}  // namespace
}  // namespace ray::blocks
