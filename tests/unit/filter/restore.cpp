#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/filter/decimate.h>
#include <raycloud/filter/restore.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <tuple>

namespace ray {
namespace {

using test::random_cloud;
using test::same_bits;

struct Running {
  unsigned threads = 2;
  std::size_t chunk = 1000;
};

Running any_running() {
  return {*rc::gen::element(1U, 2U, 3U, 8U), *rc::gen::element<std::size_t>(1, 7, 1000)};
}

RayCloud decimated(const RayCloud& full, const Decimation& decimation) {
  MemorySource source(full);
  MemorySink sink(source.info().extras);
  if (const auto* width = std::get_if<Metres>(&decimation))
    decimate_voxels({}, source, sink, *width);
  else
    decimate_every({}, source, sink, std::get<EveryNth>(decimation).n);
  return sink.cloud();
}

struct Restored {
  RayCloud cloud;
  EditSummary edits;
};

Restored restored(const RayCloud& edited, const Decimation& decimation, const RayCloud& full,
                  const Running& running = {}, const RestoreOptions& options = {}) {
  const Context context{.threads = running.threads};
  MemorySource thin(edited, running.chunk), source(full, running.chunk);
  const Restoration restoration(context, thin, source, decimation, options);
  MemorySink sink(restoration.extras());
  const StreamCounts counts = restoration.apply(context, source, sink);
  EXPECT_EQ(counts.rays_in, full.size());
  EXPECT_EQ(counts.rays_out, sink.cloud().size());
  return {sink.cloud(), restoration.edits()};
}

/// Which kept ray stands for each ray, by brute force.
std::vector<std::size_t> stands_for(const RayCloud& full, const Decimation& decimation) {
  std::vector<std::size_t> group;
  std::map<std::tuple<double, double, double>, std::size_t> cubes;
  for (std::size_t i = 0; i < full.size(); i++) {
    if (const auto* width = std::get_if<Metres>(&decimation)) {
      const Eigen::Array3d q = (full.ends[i] / width->value).array().floor();
      group.push_back(cubes.try_emplace({q.x(), q.y(), q.z()}, cubes.size()).first->second);
    } else {
      group.push_back(i / std::get<EveryNth>(decimation).n);
    }
  }
  return group;
}

Decimation any_decimation() {
  return *rc::gen::element<Decimation>(Metres{0.2}, Metres{1.0}, Metres{4.0}, EveryNth{1}, EveryNth{3},
                                       EveryNth{10});
}

RayCloud any_cloud(std::size_t least = 0) {
  RayCloud cloud = random_cloud(
      *rc::gen::arbitrary<std::uint64_t>(),
      {.rays = *rc::gen::inRange<std::size_t>(least, 300),
       .centre = *rc::gen::element(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(500000, 6900000, 100)),
       .half_extent = *rc::gen::element(0.5, 3.0, 20.0),
       .extras = test::schema_of_every_type()});
  // Times: two rays of each as they come, all the same, all different, or out of order.
  const int times = *rc::gen::inRange(0, 4);
  for (std::size_t i = 0; i < cloud.size(); i++) {
    const auto number = static_cast<double>(i);
    if (times == 1) cloud.times[i] = 7.0;
    if (times == 2) cloud.times[i] = 0.25 * number;
    if (times == 3) cloud.times[i] = std::fmod(number * 37.0, 100.0);
  }
  return cloud;
}

std::vector<std::uint8_t> any_mask(std::size_t size) {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "mask");
  const auto one_in = *rc::gen::element<std::uint64_t>(2, 5, 50);
  std::vector<std::uint8_t> mask(size);
  for (std::size_t i = 0; i < size; i++)
    mask[i] = random.below(one_in, i) == 0 ? 0 : 1;
  return mask;
}

Pose any_pose() {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "pose");
  const auto number = [&](std::uint64_t i) { return 2.0 * random.uniform(i) - 1.0; };
  Pose pose = rotation_pose(3.0 * Eigen::Vector3d(number(0), number(1), number(2)));
  pose.translation = 30.0 * Eigen::Vector3d(number(3), number(4), number(5));
  return pose;
}

double farthest(const RayCloud& a, const RayCloud& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); i++)
    most = std::max({most, (a.ends[i] - b.ends[i]).norm(), (a.starts[i] - b.starts[i]).norm()});
  return most;
}

/// All but starts and ends.
bool same_values(RayCloud a, RayCloud b) {
  if (a.size() != b.size()) return false;
  a.starts = b.starts;
  a.ends = b.ends;
  return same_bits(a, b);
}

RC_GTEST_PROP(Restore, WithoutEditsGivesTheFullCloudBitForBit, ()) {
  const RayCloud full = any_cloud();
  const Decimation decimation = any_decimation();
  const RayCloud thin = decimated(full, decimation);
  const Restored result = restored(thin, decimation, full, any_running());
  RC_ASSERT(same_bits(result.cloud, full));
  RC_ASSERT(result.edits.kept == thin.size());
  RC_ASSERT(result.edits.removed + result.edits.added + result.edits.moved == 0U);
}

RC_GTEST_PROP(Restore, RemovesTheCubesOfRemovedRays, ()) {
  const RayCloud full = any_cloud();
  const Decimation decimation = any_decimation();
  RayCloud thin = decimated(full, decimation);
  const std::vector<std::uint8_t> stays = any_mask(thin.size());
  thin.select(stays);
  RC_PRE(!thin.empty() || full.empty());
  RayCloud expected = full;
  std::vector<std::uint8_t> mask;
  for (const std::size_t group : stands_for(full, decimation))
    mask.push_back(stays[group]);
  expected.select(mask);
  RC_ASSERT(same_bits(restored(thin, decimation, full, any_running()).cloud, expected));
}

RC_GTEST_PROP(Restore, CopiesChangedColoursBoundednessAndValues, ()) {
  const RayCloud full = any_cloud();
  const Decimation decimation = any_decimation();
  RayCloud thin = decimated(full, decimation);
  const std::vector<std::uint8_t> stays = any_mask(thin.size());
  const std::vector<std::size_t> group = stands_for(full, decimation);
  RayCloud expected = full;
  for (std::size_t g = 0; g < thin.size(); g++) {
    if (stays[g] != 0) continue;
    const auto what = *rc::gen::inRange(0, 4);
    const auto value = static_cast<std::uint8_t>(g % 251);
    if (what == 0) thin.colours[g] = {value, 1, 2, thin.colours[g].intensity};
    if (what == 1) thin.colours[g].intensity = value;
    if (what == 2) thin.bounded[g] ^= 1;
    if (what == 3) thin.extra("extra_uint16")->values<std::uint16_t>()[g] ^= 5;
    for (std::size_t i = 0; i < full.size(); i++) {
      if (group[i] != g) continue;
      Colour& colour = expected.colours[i];
      if (what == 0) {
        const Colour original = decimated(full, decimation).colours[g];
        const bool is_new = original.red != value || original.green != 1 || original.blue != 2;
        if (is_new) colour = {value, 1, 2, colour.intensity};
      }
      if (what == 1 && decimated(full, decimation).colours[g].intensity != value) colour.intensity = value;
      if (what == 2) expected.bounded[i] = thin.bounded[g];
      if (what == 3) {
        expected.extra("extra_uint16")->values<std::uint16_t>()[i] =
            thin.extra("extra_uint16")->values<std::uint16_t>()[g];
      }
    }
  }
  RC_ASSERT(same_bits(restored(thin, decimation, full, any_running()).cloud, expected));
}

RC_GTEST_PROP(Restore, MovesTheWholeCloudAlsoAfterRemovalAndRecolouring, ()) {
  const RayCloud full = any_cloud(20);
  const Decimation decimation = any_decimation();
  RayCloud thin = decimated(full, decimation);
  const std::vector<std::uint8_t> stays = any_mask(thin.size());
  const Pose pose = *rc::gen::arbitrary<bool>() ? any_pose() : translation_pose({1.5, -2.0, 0.25});
  thin.select(stays);
  RC_PRE(thin.size() >= 3U);
  thin.transform(pose);
  RayCloud expected = full;
  std::vector<std::uint8_t> mask;
  for (const std::size_t group : stands_for(full, decimation))
    mask.push_back(stays[group]);
  expected.select(mask);
  expected.transform(pose);
  const Restored result = restored(thin, decimation, full, any_running());
  RC_ASSERT(same_values(result.cloud, expected));
  RC_ASSERT(farthest(result.cloud, expected) < 1e-6);
  RC_ASSERT(result.edits.moved == thin.size());
  RC_ASSERT(result.edits.worst.value < 1e-6);
}

RC_GTEST_PROP(Restore, MovesOnlyWhatMovedAndTheRestKeepsItsBits, ()) {
  const RayCloud full = any_cloud(20);
  const Decimation decimation = any_decimation();
  RayCloud thin = decimated(full, decimation);
  const std::vector<std::uint8_t> stays = any_mask(thin.size());
  const Pose pose = any_pose();
  for (std::size_t g = 0; g < thin.size(); g++) {
    if (stays[g] != 0) continue;
    thin.starts[g] = pose * thin.starts[g];
    thin.ends[g] = pose * thin.ends[g];
  }
  const std::vector<std::size_t> group = stands_for(full, decimation);
  RC_PRE(std::count(stays.begin(), stays.end(), 0) >= 3);
  const RayCloud result = restored(thin, decimation, full, any_running()).cloud;
  RC_ASSERT(same_values(result, full));
  for (std::size_t i = 0; i < full.size(); i++) {
    if (stays[group[i]] != 0) {
      RC_ASSERT(result.ends[i] == full.ends[i] && result.starts[i] == full.starts[i]);
    } else {
      RC_ASSERT((result.ends[i] - pose * full.ends[i]).norm() < 1e-6);
      RC_ASSERT((result.starts[i] - pose * full.starts[i]).norm() < 1e-6);
    }
  }
}

RC_GTEST_PROP(Restore, AppendsNewRaysAndKeepsNewColumns, ()) {
  const RayCloud full = any_cloud(1);
  const Decimation decimation = any_decimation();
  RayCloud thin = decimated(full, decimation);
  const std::size_t kept = thin.size();
  RayCloud more = random_cloud(
      *rc::gen::arbitrary<std::uint64_t>(),
      {.rays = *rc::gen::inRange<std::size_t>(1, 20), .extras = {{"extra_uint8", ScalarType::uint8}}});
  for (double& time : more.times)
    time += 1e6;
  thin.append(more);
  thin.extras.emplace_back(ColumnInfo{"tree", ScalarType::int32}, thin.size());
  for (std::size_t i = 0; i < thin.size(); i++)
    thin.extras.back().values<std::int32_t>()[i] = static_cast<std::int32_t>(i) + 1;
  const Restored result = restored(thin, decimation, full, any_running());
  RC_ASSERT(result.edits.added == more.size());
  RayCloud expected = full;
  const std::vector<std::size_t> group = stands_for(full, decimation);
  expected.append(more);
  expected.extras.emplace_back(ColumnInfo{"tree", ScalarType::int32}, expected.size());
  const auto trees = expected.extras.back().values<std::int32_t>();
  for (std::size_t i = 0; i < trees.size(); i++)
    trees[i] = static_cast<std::int32_t>(i < full.size() ? group[i] : kept + i - full.size()) + 1;
  RC_ASSERT(same_bits(result.cloud, expected));
}

TEST(Restore, AMillionRaysEditedInEveryWay) {
  RayCloud full = random_cloud(11, {.rays = 1000000, .half_extent = 30.0});
  const Decimation decimation = Metres{1.0};
  RayCloud thin = decimated(full, decimation);
  const std::size_t groups = thin.size();
  ASSERT_GT(groups, 100000U);
  const Pose pose = rotation_pose({0.1, -0.2, 1.0});
  std::vector<std::uint8_t> stays(groups);
  for (std::size_t g = 0; g < groups; g++) {
    stays[g] = g % 7 != 0;
    if (g % 3 == 0) thin.colours[g] = {1, 2, 3, thin.colours[g].intensity};
  }
  thin.select(stays);
  thin.transform(pose);
  RayCloud expected = full;
  const std::vector<std::size_t> group = stands_for(full, decimation);
  std::vector<std::uint8_t> mask;
  for (std::size_t i = 0; i < full.size(); i++) {
    mask.push_back(stays[group[i]]);
    if (group[i] % 3 == 0) expected.colours[i] = {1, 2, 3, expected.colours[i].intensity};
  }
  expected.select(mask);
  expected.transform(pose);
  const Restored result = restored(thin, decimation, full, {.threads = 2, .chunk = 32768});
  EXPECT_TRUE(same_values(result.cloud, expected));
  EXPECT_LT(farthest(result.cloud, expected), 1e-9);
}

/// Moves of single precision, which a file may have cost, give the motion to better than they are.
TEST(Restore, AMotionIsFoundThroughRounding) {
  const RayCloud full = random_cloud(3, {.rays = 5000, .half_extent = 40.0});
  RayCloud thin = decimated(full, Metres{2.0});
  const Pose pose = rotation_pose({0.3, 0.2, -2.0});
  thin.transform(pose);
  for (auto* points : {&thin.starts, &thin.ends}) {
    for (Eigen::Vector3d& point : *points)
      point = point.cast<float>().cast<double>();
  }
  RayCloud expected = full;
  expected.transform(pose);
  const Restored result = restored(thin, Metres{2.0}, full);
  EXPECT_LT(farthest(result.cloud, expected), 1e-6);
}

TEST(Restore, RoundingAloneIsNoMove) {
  const RayCloud full = random_cloud(3, {.rays = 5000, .half_extent = 40.0});
  RayCloud thin = decimated(full, Metres{2.0});
  for (Eigen::Vector3d& point : thin.ends)
    point = point.cast<float>().cast<double>();
  EXPECT_TRUE(same_bits(restored(thin, Metres{2.0}, full).cloud, full));
}

RayCloud smoothed(RayCloud cloud, double most) {
  const RandomStream random(5, "smooth");
  for (std::size_t i = 0; i < cloud.size(); i++)
    cloud.ends[i].z() += most * (2.0 * random.uniform(i) - 1.0);
  return cloud;
}

TEST(Restore, SmoothingIsRefusedWithTheReasonUnlessNonrigid) {
  const RayCloud full = random_cloud(3, {.rays = 3000, .half_extent = 5.0});
  for (const Decimation& decimation : {Decimation{Metres{1.0}}, Decimation{EveryNth{5}}}) {
    const RayCloud thin = decimated(full, decimation);
    for (const double most : {0.004, 0.2}) {
      const RayCloud edited = smoothed(thin, most);
      try {
        static_cast<void>(restored(edited, decimation, full));
        FAIL() << most;
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::wrong_content);
        EXPECT_NE(std::string(error.what()).find("--nonrigid"), std::string::npos) << error.what();
      }
      const Restored result = restored(edited, decimation, full, {}, {.nonrigid = true});
      EXPECT_TRUE(same_values(result.cloud, full));
      const std::vector<std::size_t> group = stands_for(full, decimation);
      std::vector<std::uint8_t> seen(thin.size());
      for (std::size_t i = 0; i < full.size(); i++) {
        EXPECT_EQ(result.cloud.starts[i], full.starts[i]);
        EXPECT_LE((result.cloud.ends[i] - full.ends[i]).norm(), most + 1e-12);
        if (seen[group[i]]++ == 0) {  // the kept ray itself
          EXPECT_LT((result.cloud.ends[i] - edited.ends[group[i]]).norm(), 1e-12);
        }
      }
    }
  }
}

/// A slow bend: what is interpolated is close to it everywhere.
TEST(Restore, NonrigidFollowsASmoothBend) {
  const RayCloud full = random_cloud(9, {.rays = 20000, .half_extent = 4.0});
  const auto bend = [](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(p + Eigen::Vector3d(0.2 * std::sin(p.y() / 4.0), 0, 0.1 * std::cos(p.x() / 3.0)));
  };
  RayCloud thin = decimated(full, Metres{0.5});
  for (Eigen::Vector3d& end : thin.ends)
    end = bend(end);
  const RayCloud result = restored(thin, Metres{0.5}, full, {}, {.nonrigid = true}).cloud;
  double worst = 0.0;
  for (std::size_t i = 0; i < full.size(); i++)
    worst = std::max(worst, (result.ends[i] - bend(full.ends[i])).norm());
  EXPECT_LT(worst, 0.03);  // of moves up to 0.22
}

TEST(Restore, OneRayThatMoved) {
  RayCloud full = random_cloud(1, {.rays = 1});
  full.starts[0] = {0, 0, 2};
  full.ends[0] = {5, 0, 0};
  RayCloud thin = full;
  const Pose pose = rotation_pose({0, 0, 1.0});
  thin.transform(pose);
  const RayCloud result = restored(thin, Metres{0.1}, full).cloud;
  EXPECT_LT(farthest(result, thin), 1e-9);
}

TEST(Restore, NothingFromNothing) {
  const RayCloud none = random_cloud(1, {.rays = 0}), some = random_cloud(1, {.rays = 5});
  EXPECT_EQ(restored(none, Metres{0.1}, none).cloud.size(), 0U);
  EXPECT_EQ(restored(none, Metres{0.1}, some).cloud.size(), 0U);          // all were removed
  EXPECT_TRUE(same_bits(restored(some, Metres{0.1}, none).cloud, some));  // all are new
}

ErrorCode refusal(const RayCloud& edited, const Decimation& decimation, const RayCloud& full) {
  try {
    static_cast<void>(restored(edited, decimation, full));
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "nothing was thrown";
  return ErrorCode::cancelled;
}

TEST(Restore, RefusesWhatDoesNotBelongTogether) {
  const RayCloud full = random_cloud(1, {.rays = 100, .extras = {{"a", ScalarType::uint8}}});
  RayCloud shifted = decimated(full, Metres{1.0});
  for (double& time : shifted.times)
    time += 1000.0;
  EXPECT_EQ(refusal(shifted, Metres{1.0}, full), ErrorCode::wrong_content);
  RayCloud retyped = decimated(full, Metres{1.0});
  retyped.extras[0] = Column({"a", ScalarType::float32}, retyped.size());
  EXPECT_EQ(refusal(retyped, Metres{1.0}, full), ErrorCode::wrong_content);
  for (const double width : {0.0, -1.0, std::nan(""), HUGE_VAL})
    EXPECT_EQ(refusal(full, Metres{width}, full), ErrorCode::usage);
  EXPECT_EQ(refusal(full, EveryNth{0}, full), ErrorCode::usage);
}

}  // namespace
}  // namespace ray
