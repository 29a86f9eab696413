/// What is said of poses by the evidence of both sides.

#include "align/jury.h"

#include <gtest/gtest.h>

namespace ray::align {
namespace {

Evidence side(double known, double refuted) {
  Evidence evidence;
  evidence.known = known, evidence.refuted = refuted;
  return evidence;
}

/// A wood in summer on one in winter, as measured, and poses that are wrong.
TEST(Jury, TellsWhatOnlyOneCloudHasFromAWrongPose) {
  const auto is_by_one_only = [](const Evidence& there, const Evidence& back) {
    const Hypothesis one{{}, there, back, 0.0};
    EXPECT_EQ(one.is_refuted_by_one_only(), (Hypothesis{{}, back, there, 0.0}.is_refuted_by_one_only()));
    return one.is_refuted_by_one_only();
  };
  EXPECT_TRUE(is_by_one_only(side(255, 0.1044 * 255), side(233, 0.0144 * 233)));
  EXPECT_TRUE(is_by_one_only(side(189, 0.1238 * 189), side(150, 0.0133 * 150)));
  EXPECT_FALSE(is_by_one_only(side(200, 20), side(200, 20))) << "both have what the other does not";
  EXPECT_FALSE(is_by_one_only(side(200, 60), side(200, 0))) << "too much";
  EXPECT_FALSE(is_by_one_only(side(200, 20), side(20, 0))) << "the other side knows too little to tell";
  EXPECT_FALSE(is_by_one_only(side(200, 20), side(0, 0))) << "the other side knows nothing";
}

}  // namespace
}  // namespace ray::align
