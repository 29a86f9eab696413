// The laws of the commands that hold from file to file, at the library's level.
#include "support/random_cloud.h"
#include "support/scratch.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/stream.h>
#include <raycloud/filter/decimate.h>
#include <raycloud/filter/import_rays.h>
#include <raycloud/filter/sensor_path.h>
#include <raycloud/filter/transform.h>
#include <raycloud/io/point_file.h>
#include <raycloud/io/ray_cloud_file.h>
#include <raycloud/io/trajectory_file.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

namespace ray {
namespace {

using test::random_cloud;
using test::same_bits;
using Path = std::filesystem::path;

void write_cloud(const Path& path, const RayCloud& cloud, Precision precision) {
  CloudInfo info;
  info.precision = precision;
  info.extras = schema_of(cloud);
  MemorySource source(cloud);
  const auto sink = create_ray_cloud(path, info);
  stream_each({}, source, *sink, [](RayCloud&) {});
  sink->finish();
}

RayCloud read_cloud(const Path& path) {
  const auto source = open_ray_cloud(path);
  return read_all({}, *source);
}

void move(const Path& path, const Pose& pose) {
  const auto source = open_ray_cloud(path);
  const auto sink = create_ray_cloud(path, source->info());
  transform_cloud({}, *source, *sink, pose);
  sink->finish();
}

double worst_distance(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    worst = std::max(worst, (a[i] - b[i]).norm());
  return worst;
}

Eigen::Vector3d any_vector(double scale) {
  const auto component = [&] { return scale * (*rc::gen::inRange(-1000, 1001)) / 1000.0; };
  return {component(), component(), component()};
}

RayCloud any_cloud(bool float_coordinates, std::size_t max_rays = 120) {
  return random_cloud(*rc::gen::arbitrary<std::uint64_t>(),
                      {.rays = *rc::gen::inRange<std::size_t>(0, max_rays),
                       .float_coordinates = float_coordinates,
                       .extras = test::schema_of_every_type()});
}

RC_GTEST_PROP(FileLaws, PlyAndLazGiveBackEveryColumnOfEveryType, ()) {
  const test::Scratch scratch;
  const RayCloud cloud = any_cloud(true);
  write_cloud(scratch.path("cloud.ply"), cloud, Precision::single);
  const RayCloud from_ply = read_cloud(scratch.path("cloud.ply"));
  RC_ASSERT(same_bits(from_ply, cloud));
  write_cloud(scratch.path("cloud.laz"), cloud, Precision::single);
  const RayCloud from_laz = read_cloud(scratch.path("cloud.laz"));
  RC_ASSERT(from_laz.extras == cloud.extras);
  RC_ASSERT(from_laz.times == cloud.times);
  RC_ASSERT(from_laz.colours == cloud.colours);
  RC_ASSERT(from_laz.bounded == cloud.bounded);
  RC_ASSERT(worst_distance(from_laz.ends, cloud.ends) <= 1e-4);
  RC_ASSERT(worst_distance(from_laz.starts, cloud.starts) <= 1e-4);
}

RC_GTEST_PROP(FileLaws, MovingThereAndBackReturnsTheCloudToRounding, ()) {
  const test::Scratch scratch;
  const Path path = scratch.path("cloud.ply");
  const RayCloud cloud = any_cloud(false);
  write_cloud(path, cloud, Precision::double_);
  const Eigen::Vector3d rotation = any_vector(6.0);
  const Eigen::Vector3d offset = any_vector(1000.0);
  move(path, rotation_pose(rotation));
  move(path, translation_pose(offset));
  move(path, translation_pose(-offset));
  move(path, rotation_pose(-rotation));
  const RayCloud back = read_cloud(path);
  RC_ASSERT(worst_distance(back.ends, cloud.ends) < 1e-11);
  RC_ASSERT(worst_distance(back.starts, cloud.starts) < 1e-11);
  RC_ASSERT(back.times == cloud.times);
  RC_ASSERT(back.extras == cloud.extras);
}

RC_GTEST_PROP(FileLaws, MovingByNothingKeepsEveryBit, ()) {
  const test::Scratch scratch;
  const Path path = scratch.path("cloud.ply");
  write_cloud(path, any_cloud(true), Precision::single);
  const RayCloud before = read_cloud(path);
  move(path, {});
  RC_ASSERT(same_bits(read_cloud(path), before));
}

std::array<std::int64_t, 3> voxel_of(const Eigen::Vector3d& end, double width) {
  return {static_cast<std::int64_t>(std::floor(end.x() / width)),
          static_cast<std::int64_t>(std::floor(end.y() / width)),
          static_cast<std::int64_t>(std::floor(end.z() / width))};
}

RC_GTEST_PROP(FileLaws, DecimationKeepsTheFirstRayOfEveryOccupiedVoxelAndNoOther, ()) {
  const test::Scratch scratch;
  const RayCloud cloud = any_cloud(true, 400);
  const double width = *rc::gen::element(0.05, 1.0, 7.0, 1000.0);
  write_cloud(scratch.path("cloud.ply"), cloud, Precision::single);
  const auto source = open_ray_cloud(scratch.path("cloud.ply"), {.chunk_rays = 13});
  const auto sink = create_ray_cloud(scratch.path("out.ply"), source->info());
  decimate_voxels({}, *source, *sink, Metres{width});
  sink->finish();

  std::set<std::array<std::int64_t, 3>> seen;
  std::vector<std::uint8_t> first(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    first[i] = seen.insert(voxel_of(cloud.ends[i], width)).second;
  RayCloud expected = cloud;
  expected.select(first);
  RC_ASSERT(same_bits(read_cloud(scratch.path("out.ply")), expected));
}

/// A sensor that moves smoothly at up to `speed` m/s; its cloud is what such a sensor would have recorded.
RayCloud moving_sensor_cloud(std::uint64_t seed, std::size_t rays, double speed,
                             std::vector<ColumnInfo> extras) {
  RayCloud cloud = random_cloud(seed, {.rays = rays, .extras = std::move(extras)});
  for (std::size_t i = 0; i < rays; ++i) {
    cloud.times[i] = 1000.0 + 0.001 * static_cast<double>(i);
    const double phase = 0.5 * cloud.times[i];
    cloud.starts[i] =
        2.0 * speed * Eigen::Vector3d(std::sin(phase), std::cos(phase), 0.1 * std::sin(2.0 * phase));
    if (cloud.bounded[i] == 0) cloud.colours[i].intensity = 0;
  }
  return cloud;
}

void check_export_import(const char* points_name, double end_tolerance, std::vector<ColumnInfo> extras = {}) {
  const test::Scratch scratch;
  const RayCloud cloud = moving_sensor_cloud(11, 5000, 1.5, std::move(extras));
  MemorySource source(cloud);
  SensorPath path(0.1);
  CloudInfo info = source.info();
  info.history = {"rayexport"};
  const auto points = create_points(scratch.path(points_name), info);
  stream(
      Context{}, source, points.get(), [](RayCloud&) { return Nothing{}; },
      [&](RayCloud& rays, Nothing&) { path.add(rays); });
  points->finish();
  write_trajectory(scratch.path("trajectory.txt"), path.trajectory());

  ImportOptions options;
  options.origin = MovingSensor{.trajectory = read_trajectory(scratch.path("trajectory.txt")).trajectory};
  const auto again = open_points(scratch.path(points_name));
  (void)import_rays({}, *again, options,
                    [&](const CloudInfo& out) { return create_ray_cloud(scratch.path("again.ply"), out); });
  const RayCloud back = read_cloud(scratch.path("again.ply"));
  ASSERT_EQ(back.size(), cloud.size());
  EXPECT_LE(worst_distance(back.ends, cloud.ends), end_tolerance) << points_name;
  EXPECT_EQ(back.times, cloud.times) << points_name;
  EXPECT_EQ(back.colours, cloud.colours) << points_name;
  EXPECT_EQ(back.bounded, cloud.bounded) << points_name;
  EXPECT_TRUE(back.extras == cloud.extras) << points_name;
  MemorySource once_more(cloud);
  const double error = sampling_error({}, once_more, path.trajectory()).value;
  EXPECT_LE(worst_distance(back.starts, cloud.starts), error + 1e-6) << points_name;
  // Acceleration a of the path bounds the chord error of nodes at most 0.2 s apart: a t^2 / 8, a < 1 m/s2.
  EXPECT_LE(error, 0.2 * 0.2 / 8.0 + 1e-3) << points_name;
}

TEST(FileLaws, ExportThenImportGivesEndsAndTimesExactlyAndStartsWithinTheSamplingError) {
  check_export_import("points.ply", 0.0);
  check_export_import("points.txt", 0.0);
  check_export_import("points.csv", 0.0);
  check_export_import("points.laz", 1e-4);
  check_export_import("points.las", 1e-4);
}

TEST(FileLaws, ExportThenImportKeepsBothIntensitiesAndEveryColumn) {
  std::vector<ColumnInfo> extras = test::schema_of_every_type();
  extras.push_back({"intensity", ScalarType::uint16});
  for (const char* points : {"points.ply", "points.las", "points.laz"})
    check_export_import(points, 1e-4, extras);
}

TEST(FileLaws, UtmCoordinatesKeepATenthOfAMillimetreThroughEveryStep) {
  const test::Scratch scratch;
  const Eigen::Vector3d utm(500000.0, 6900000.0, 250.0);
  const RayCloud cloud = random_cloud(3, {.rays = 1000, .centre = utm, .half_extent = 300.0});
  write_cloud(scratch.path("cloud.ply"), cloud, Precision::double_);
  EXPECT_LE(worst_distance(read_cloud(scratch.path("cloud.ply")).ends, cloud.ends), 1e-9);

  const auto source = open_ray_cloud(scratch.path("cloud.ply"));
  const auto sink = create_ray_cloud(scratch.path("thin.ply"), source->info());
  decimate_voxels({}, *source, *sink, Metres{1e-3});
  sink->finish();
  const Pose turn = rotation_pose({0.0, 0.0, 0.7});
  move(scratch.path("thin.ply"), turn);
  const RayCloud moved = read_cloud(scratch.path("thin.ply"));
  write_cloud(scratch.path("thin.laz"), moved, Precision::double_);
  RayCloud back = read_cloud(scratch.path("thin.laz"));
  back.transform(rotation_pose({0.0, 0.0, -0.7}));
  ASSERT_GT(back.size(), 900U);
  std::size_t row = 0;
  for (std::size_t i = 0; i < back.size(); ++i) {
    while (row < cloud.size() && (cloud.ends[row] - back.ends[i]).norm() > 1e-4)
      ++row;
    ASSERT_LT(row, cloud.size()) << "ray " << i << " is nowhere in the original";
    EXPECT_LE((cloud.starts[row] - back.starts[i]).norm(), 2e-4);
  }
}

TEST(FileLaws, SinglePrecisionIsRefusedWhereItWouldLoseATenthOfAMillimetre) {
  const test::Scratch scratch;
  const RayCloud cloud = random_cloud(4, {.rays = 10, .centre = {500000.0, 6900000.0, 0.0}});
  EXPECT_THROW(write_cloud(scratch.path("cloud.ply"), cloud, Precision::single), PrecisionLoss);
  EXPECT_TRUE(std::filesystem::is_empty(scratch.folder()));
}

std::string bytes_of(const Path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(FileLaws, FilesAreTheSameBytesForEveryThreadCountAndChunkSize) {
  const test::Scratch scratch;
  const RayCloud cloud =
      random_cloud(6, {.rays = 3000, .float_coordinates = true, .extras = test::schema_of_every_type()});
  write_cloud(scratch.path("cloud.ply"), cloud, Precision::single);
  for (const char* name : {"out.ply", "out.las", "out.laz"}) {
    std::string expected;
    for (const unsigned threads : {1U, 2U, 3U, 8U}) {
      for (const std::size_t chunk : {7UL, 1000000UL}) {
        const auto source = open_ray_cloud(scratch.path("cloud.ply"), {.chunk_rays = chunk});
        const auto sink = create_ray_cloud(scratch.path(name), source->info());
        decimate_voxels({.threads = threads}, *source, *sink, Metres{2.0});
        sink->finish();
        const std::string bytes = bytes_of(scratch.path(name));
        if (expected.empty()) expected = bytes;
        ASSERT_TRUE(bytes == expected) << name << ", " << threads << " threads, chunks of " << chunk;
      }
    }
  }
}

}  // namespace
}  // namespace ray
