#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/filter/import_rays.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace ray {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

// A sink that keeps what it was given where the caller can see it, and refuses what single precision would
// lose.
class ProbeSink final : public RaySink {
 public:
  struct Seen {
    std::vector<CloudInfo> made;
    RayCloud cloud;
    bool finished = false;
  };
  ProbeSink(Seen& seen, const CloudInfo& info) : seen_(seen), info_(info), memory_(info.extras) {
    seen.made.push_back(info);
  }
  void encode(const RayCloud& rays, RawChunk& raw) const override {
    for (const Eigen::Vector3d& end : rays.ends)
      if (info_.precision == Precision::single && (end - end.cast<float>().cast<double>()).norm() > 1e-4)
        throw PrecisionLoss("too fine");
    memory_.encode(rays, raw);
  }
  void write(const RawChunk& raw) override { memory_.write(raw); }
  void finish() override {
    memory_.finish();
    seen_.cloud = memory_.cloud();
    seen_.finished = true;
  }

 private:
  Seen& seen_;
  CloudInfo info_;
  MemorySink memory_;
};

struct Import {
  ProbeSink::Seen seen;
  ImportReport report;
};

Import import(const RayCloud& cloud, CloudInfo info, const ImportOptions& options,
              std::size_t chunk_rays = 100, const Context& context = {}) {
  info.extras = schema_of(cloud);
  MemorySource source(cloud, info, chunk_rays);
  Import result;
  result.report = import_rays(context, source, options, [&](const CloudInfo& made) {
    return std::make_unique<ProbeSink>(result.seen, made);
  });
  return result;
}

std::string error_of(const RayCloud& cloud, const CloudInfo& info, const ImportOptions& options) {
  try {
    static_cast<void>(import(cloud, info, options));
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

const CloudInfo kPoints{.present = {.starts = false, .intensity = false}};

RayCloud points(std::size_t count = 5000) {
  RayCloud cloud = test::random_cloud(7, {.rays = count, .extras = {{"intensity", ScalarType::uint16}}});
  cloud.starts = cloud.ends;
  for (std::size_t i = 0; i < count; ++i)
    cloud.times[i] = 100.0 + 0.001 * static_cast<double>(i);
  return cloud;
}

Trajectory path_over(double begin, double end) {
  Trajectory path;
  for (double time = begin; time < end; time += 0.1) {
    path.times.push_back(time);
    path.positions.emplace_back(std::sin(time), 2.0 * time, 1.0);
  }
  return path;
}

TEST(import_rays, everything_but_starts_intensity_and_bounded_stays) {
  const RayCloud cloud = points();
  const Import result =
      import(cloud, kPoints, {.origin = MovingSensor{.trajectory = path_over(99.95, 106.0)}});
  ASSERT_TRUE(result.seen.finished);
  const RayCloud& rays = result.seen.cloud;
  EXPECT_EQ(rays.ends, cloud.ends);
  EXPECT_EQ(rays.times, cloud.times);
  EXPECT_EQ(rays.extras, cloud.extras);
  for (std::size_t i = 0; i < rays.size(); i += 97)
    EXPECT_NEAR(rays.starts[i].y(), 2.0 * rays.times[i], 1e-9);
  EXPECT_EQ(result.report.rays_in, cloud.size());
  EXPECT_EQ(result.report.rays_out, cloud.size());
  EXPECT_TRUE(result.report.info.present.starts);
}

TEST(import_rays, what_cannot_be_is_refused_before_a_sink_is_made) {
  const RayCloud cloud = points();
  ImportOptions options{.origin = MovingSensor{.trajectory = path_over(5, 6)}, .points_name = "scan.ply"};
  EXPECT_THAT(error_of(cloud, kPoints, options),
              HasSubstr("scan.ply: no time in common with trajectory: points 100.0"));
  options.time_scale = 0.05;
  EXPECT_EQ(error_of(cloud, kPoints, options), "no error");
  options.time_scale = -1.0;
  EXPECT_THAT(error_of(cloud, kPoints, options), HasSubstr("time scale"));
  options.time_scale = 1.0;
  CloudInfo timeless = kPoints;
  timeless.present.times = false;
  EXPECT_THAT(error_of(cloud, timeless, options), HasSubstr("scan.ply: has no times"));
  EXPECT_THAT(error_of(cloud, kPoints, {.points_name = "scan.ply"}),
              HasSubstr("scan.ply: does not say where its sensor"));
  RayCloud nans = points(3);
  for (auto& end : nans.ends)
    end.x() = std::nan("");
  EXPECT_THAT(error_of(nans, kPoints, {.origin = FixedSensor{{0, 0, 0}}}), HasSubstr("every row has a NaN"));

  MemorySource source(cloud, kPoints);
  const auto never = [](const CloudInfo&) -> std::unique_ptr<RaySink> { throw std::logic_error("made"); };
  options.origin = MovingSensor{.trajectory = path_over(5, 6)};
  EXPECT_THROW(static_cast<void>(import_rays({}, source, options, never)), Error);
}

TEST(import_rays, a_trajectory_that_holds_no_point_leaves_no_output) {
  RayCloud cloud = points(1000);
  for (std::size_t i = 0; i < 1000; ++i)
    cloud.times[i] = i < 500 ? 0.0 : 1000.0;
  ProbeSink::Seen seen;
  MemorySource source(cloud, CloudInfo{.extras = schema_of(cloud), .present = kPoints.present});
  const ImportOptions options{.origin = MovingSensor{.trajectory = path_over(500, 510)}};
  EXPECT_THROW(static_cast<void>(import_rays(
                   {}, source, options,
                   [&](const CloudInfo& info) { return std::make_unique<ProbeSink>(seen, info); })),
               Error);
  EXPECT_FALSE(seen.finished);
}

TEST(import_rays, no_rays_at_all_are_a_legal_cloud) {
  const Import result = import(points(0), kPoints, {.origin = FixedSensor{{0, 0, 0}}});
  EXPECT_TRUE(result.seen.finished);
  EXPECT_EQ(result.report.rays_out, 0u);
}

TEST(import_rays, points_outside_the_trajectory_are_left_out_counted_and_told) {
  const Import result =
      import(points(), kPoints, {.origin = MovingSensor{.trajectory = path_over(101.0, 103.0)}});
  EXPECT_GT(result.report.origins.before, 800u);
  EXPECT_EQ(result.report.rays_out + result.report.origins.before + result.report.origins.after, 5000u);
  EXPECT_THAT(result.report.notes, Contains(HasSubstr("outside the time of trajectory")));
}

TEST(import_rays, times_are_scaled_then_offset) {
  const Import result =
      import(points(10), kPoints, {.origin = FixedSensor{{0, 0, 0}}, .time_scale = 2.0, .time_offset = -5.0});
  EXPECT_EQ(result.seen.cloud.times[3], 2.0 * points(10).times[3] - 5.0);
}

TEST(import_rays, missing_times_are_made_up_in_file_order) {
  CloudInfo info = kPoints;
  info.present.times = false;
  const Import result = import(points(), info, {.origin = FixedSensor{{0, 0, 0}}}, 7);
  EXPECT_EQ(result.seen.made.back().time_base, "made_up");
  for (std::size_t i = 0; i < 5000; ++i)
    ASSERT_EQ(result.seen.cloud.times[i], static_cast<double>(i) * 1e-6);
  EXPECT_THAT(result.report.notes, Contains(HasSubstr("made up")));
}

TEST(import_rays, precision_loss_starts_again_in_double) {
  RayCloud cloud = points(1000);
  cloud.ends[990].x() += 500000.123;
  const Import result = import(cloud, kPoints, {.origin = FixedSensor{{0, 0, 0}}});
  ASSERT_EQ(result.seen.made.size(), 2u);
  EXPECT_EQ(result.seen.made[1].precision, Precision::double_);
  EXPECT_EQ(result.seen.cloud.ends, cloud.ends);
}

// The sample sees zeros only; one other value anywhere changes what they mean.
RC_GTEST_PROP(import_rays, an_intensity_the_sample_missed_counts, ()) {
  RayCloud cloud = points(2000);
  auto values = cloud.extras[0].values<std::uint16_t>();
  std::fill(values.begin(), values.end(), std::uint16_t{0});
  const auto where = *rc::gen::inRange<std::size_t>(0, cloud.size());
  values[where] = 5000;
  const Import result = import(cloud, kPoints, {.origin = FixedSensor{{0, 0, 0}}}, 5);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    RC_ASSERT((result.seen.cloud.bounded[i] != 0) == (i == where));
  RC_ASSERT(result.seen.cloud.colours[where].intensity == std::lround(255.0 * 5000 / 65535));
}

TEST(import_rays, the_start_can_be_moved_to_the_origin) {
  const Eigen::Vector3d sensor(500000, 6900000, 30);
  const Import result =
      import(points(10), kPoints, {.origin = FixedSensor{sensor}, .remove_start_position = true});
  EXPECT_EQ(result.seen.cloud.starts[4], Eigen::Vector3d::Zero());
  EXPECT_LT((result.seen.cloud.ends[4] + sensor - points(10).ends[4]).norm(), 1e-8);
}

TEST(import_rays, neither_chunks_nor_threads_change_a_bit) {
  const RayCloud cloud = points(1500);
  const ImportOptions options{.origin = MovingSensor{.trajectory = path_over(100.3, 104.0)}};
  const Import whole = import(cloud, kPoints, options, 1000000, {.threads = 1});
  for (const std::size_t chunk : {1u, 7u, 1000u})
    for (const unsigned threads : {1u, 3u}) {
      const Import other = import(cloud, kPoints, options, chunk, {.threads = threads});
      EXPECT_TRUE(test::same_bits(other.seen.cloud, whole.seen.cloud));
      EXPECT_EQ(other.report.audit.findings, whole.report.audit.findings);
      EXPECT_EQ(other.report.notes, whole.report.notes);
    }
}

}  // namespace
}  // namespace ray
