/// What is said of poses by the evidence of both sides.

#include "align/jury.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/random.h>

#include <gtest/gtest.h>

#include <cmath>

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

/// A street of 60 m along x, 8 m wide, 1 cm of noise, whose house fronts have piers every 6 m; or no piers.
Known street_scan(std::uint64_t seed, bool has_piers) {
  constexpr double kLength = 60.0, kEvery = 6.0, kPier = 0.4, kDepth = 0.06, kHalf = 4.0, kHeight = 6.0;
  constexpr std::size_t kRays = 200'000, kKinds = 60;
  const RandomStream random(seed, "street");
  RayCloud cloud;
  cloud.resize(kRays);
  for (std::size_t i = 0; i < kRays; ++i) {
    const double x = kLength * random.uniform(i, 0), v = random.uniform(i, 1), u = random.uniform(i, 4),
                 noise = 0.035 * (random.uniform(i, 2) - 0.5), side = random.below(2, i, 3) == 0 ? -1.0 : 1.0,
                 face = random.below(2, i, 6) == 0 ? -0.5 : 0.5;
    const double off = std::remainder(x, kEvery);
    const double front = kHalf - (has_piers && std::abs(off) < 0.5 * kPier ? kDepth : 0.0);
    Eigen::Vector3d& end = cloud.ends[i];
    cloud.starts[i] = {x, 0.0, 1.6};
    switch (random.below(kKinds, i, 5)) {
      case 0:  // the sides of piers
        end = {x - off + face * kPier + noise, side * (kHalf - kDepth * u), kHeight * v};
        cloud.starts[i].x() = end.x() + 6.0 * face;
        break;
      default:
        if (random.below(3, i, 7) == 0)
          end = {x, 2.0 * kHalf * (v - 0.5), noise};
        else
          end = {x, side * (front + noise), kHeight * v};
    }
    cloud.bounded[i] = has_piers || random.below(kKinds, i, 5) > 0 ? 1 : 0;
  }
  MemorySource source(std::move(cloud));
  const Survey survey = survey_ends({}, source);
  return Known({}, gather_surfaces({}, source, survey, patch_width(survey)));
}

/// Along a street little tells a pose from one half a patch further; where nothing does, none may be told.
TEST(Jury, TellsPosesHalfAPatchApartClosely) {
  for (const bool has_piers : {true, false}) {
    const Known cloud = street_scan(1, has_piers), reference = street_scan(2, has_piers);
    const Jury jury(cloud, reference);
    Hypothesis best{
        {Eigen::Matrix3d::Identity(), cloud.surfaces.survey.origin - reference.surfaces.survey.origin},
        {},
        {},
        0.0};
    Hypothesis other = best;
    other.pose.translation.x() += 0.5 * cloud.fine.width();
    jury.judge(best), jury.judge(other);
    const double closely = jury.sigmas_worse_closely(other, best);
    EXPECT_LT(sigmas_worse(other, best), 2.0);
    if (has_piers)
      EXPECT_GT(closely, 5.0);
    else
      EXPECT_LT(closely, 2.0);
  }
}

/// A wall of 31 cm along y, seen from one side; rays to the sky pass along both sides, or through the place
/// of the wall where there is none.
RayCloud wall_scan(bool is_from_behind, bool is_there) {
  constexpr std::size_t kRays = 60'000;
  constexpr double kThick = 0.31;
  const RandomStream random(is_from_behind ? 1 : 2, "wall");
  RayCloud cloud;
  cloud.resize(kRays);
  for (std::size_t i = 0; i < kRays; ++i) {
    const double y = 8.0 * random.uniform(i, 0), z = 4.0 * random.uniform(i, 1),
                 beside = 1.5 * random.uniform(i, 2), noise = 0.035 * (random.uniform(i, 3) - 0.5);
    const double from = is_from_behind ? 4.0 : -4.0, face = is_from_behind ? kThick : 0.0,
                 along = i % 8 == 0 ? -beside : kThick + beside;
    const bool is_along = is_there && i % 4 == 0;
    cloud.starts[i] = is_along ? Eigen::Vector3d(along, -4.0, z) : Eigen::Vector3d(from, y, z);
    cloud.ends[i] = is_along   ? Eigen::Vector3d(along, 12.0, z)
                    : is_there ? Eigen::Vector3d(face + noise, y, z)
                               : Eigen::Vector3d(-from, y, z);
    cloud.bounded[i] = is_there && !is_along ? 1 : 0;
    // Something that both have seen.
    if (i % 4 == 1) cloud.ends[i] = {from, y, -1.0 + noise}, cloud.bounded[i] = 1;
  }
  return cloud;
}

TEST(Jury, RaysOnBothSidesOfAThinWallDidNotGoThrough) {
  const auto refuted = [](bool is_there) {
    const auto known = [](RayCloud rays) {
      MemorySource source(std::move(rays));
      Survey survey = survey_ends({}, source);
      survey.origin.setZero();
      return Known({}, gather_surfaces({}, source, survey, 0.2));
    };
    const Known cloud = known(wall_scan(false, true)), reference = known(wall_scan(true, is_there));
    Hypothesis one;
    one.pose.rotation.setIdentity(), one.pose.translation.setZero();
    Jury(cloud, reference).judge(one);
    return one.there.refuted;
  };
  EXPECT_EQ(refuted(true), 0.0);
  EXPECT_GT(refuted(false), 5.0);
}

/// Of a pose with little overlap much is edges, and apart: that is not to be taken for refuted.
TEST(Jury, TellsWhatIsApartFromWhatIsRefuted) {
  const auto with = [](float against, float refuted) {
    Hypothesis one;
    for (int i = 0; i < 100; ++i) {
      one.there.cells.push_back({1.0F, i % 2 == 0 ? against : 0.0F, i % 2 == 0 ? refuted : 0.0F});
      one.there.known += 1.0;
      one.there.against += i % 2 == 0 ? against : 0.0, one.there.refuted += i % 2 == 0 ? refuted : 0.0;
    }
    return one;
  };
  const Hypothesis best = with(0.1F, 0.05F), apart = with(0.4F, 0.05F), refuted = with(0.4F, 0.35F);
  EXPECT_GT(sigmas_worse(apart, best), 5.0);
  EXPECT_EQ(sigmas_more_refuted(apart, best), 0.0);
  EXPECT_GT(sigmas_more_refuted(refuted, best), 5.0);
}

}  // namespace
}  // namespace ray::align
