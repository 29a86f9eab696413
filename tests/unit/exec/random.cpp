#include <raycloud/exec/random.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

namespace ray {
namespace {

TEST(RandomStream, IsTheSameEverywhere) {
  // Written down once: a change of these numbers changes every synthetic cloud that was ever published.
  const RandomStream random(1, "golden");
  const std::array<std::uint64_t, 3> got{random.bits(0), random.bits(1), random.bits(0, 1)};
  const std::array<std::uint64_t, 3> expected{11737764182074880936ULL, 7112515512789058849ULL,
                                              10678688218340312264ULL};
  EXPECT_EQ(got, expected);
}

TEST(RandomStream, NamesSeedsIndicesAndDrawsAllMatter) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    for (const char* name : {"a", "b", "ab", "ba"}) {
      for (std::uint64_t index = 0; index < 4; ++index) {
        for (std::uint64_t draw = 0; draw < 4; ++draw)
          seen.insert(RandomStream(seed, name).bits(index, draw));
      }
    }
  }
  EXPECT_EQ(seen.size(), 256U);
}

TEST(RandomStream, UniformHasTheMomentsOfTheUniformDistribution) {
  const RandomStream random(7, "moments");
  constexpr int kCount = 1000000;
  double sum = 0.0;
  double squares = 0.0;
  double neighbours = 0.0;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const double u = random.uniform(i);
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += u * u;
    neighbours += (u - 0.5) * (random.uniform(i + 1) - 0.5);
  }
  // Five standard errors each.
  EXPECT_NEAR(sum / kCount, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / kCount));
  EXPECT_NEAR(squares / kCount, 1.0 / 3.0, 5.0 * std::sqrt(4.0 / 45.0 / kCount));
  EXPECT_NEAR(neighbours / kCount, 0.0, 5.0 / 12.0 / std::sqrt(kCount));
}

TEST(RandomStream, BelowIsEvenOverItsRange) {
  const RandomStream random(9, "dice");
  std::array<int, 6> faces{};
  constexpr int kThrows = 600000;
  for (std::uint64_t i = 0; i < kThrows; ++i)
    ++faces.at(random.below(6, i));
  for (const int count : faces)
    EXPECT_NEAR(count, kThrows / 6, 5 * std::sqrt(kThrows * 5.0 / 36.0));
}

}  // namespace
}  // namespace ray
