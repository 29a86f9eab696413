// Scans against the scene they claim to show.
#include "small_scene.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/stream.h>
#include <raycloud/synth/scene_caster.h>
#include <raycloud/synth/simulate.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

namespace ray {
namespace {

using namespace test;

RayCloud scan(const Scene& scene, const SimulationOptions& options, unsigned threads = 2) {
  const Context context{.threads = threads};
  const auto source = simulate(scene, options);
  return read_all(context, *source);
}

Eigen::Vector3d true_end(const RayCloud& rays, std::size_t i) {
  return {rays.extra("true_x")->values<double>()[i], rays.extra("true_y")->values<double>()[i],
          rays.extra("true_z")->values<double>()[i]};
}

Eigen::Vector3d normal(const RayCloud& rays, std::size_t i) {
  return {rays.extra("normal_x")->as_double(i), rays.extra("normal_y")->as_double(i),
          rays.extra("normal_z")->as_double(i)};
}

class BothScanners : public ::testing::TestWithParam<std::variant<SpinningScanner, StandingScanner>> {};
INSTANTIATE_TEST_SUITE_P(Scanners, BothScanners,
                         ::testing::Values(SpinningScanner{}, SpinningScanner{.beams = 16},
                                           StandingScanner{}));

TEST_P(BothScanners, EveryRayEndsAtTheFirstSurfaceAndTellsTheTruthOfIt) {
  const Scene scene = small_scene();
  const RayCloud rays =
      scan(scene, {.rays = 20'000, .scanner = GetParam(), .range = 15.0, .noise = 0.0, .truth = true});
  ASSERT_EQ(rays.size(), 20'000u);
  std::size_t unbounded = 0;
  std::map<int, std::size_t> objects;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Vector3d along = rays.ends[i] - rays.starts[i];
    const Eigen::Vector3d direction = along.normalized();
    const SlowHit slow = slow_cast(scene, rays.starts[i], direction, rays.times[i]);
    const int id = rays.extra("object_id")->values<std::int32_t>()[i];
    // The end of a fast turn is where the two ways to interpolate it differ; the person's sides by less than
    // this.
    const double tolerance = id == 5 || slow.object == 5 ? 0.01 : 1e-9;
    if (rays.bounded[i] == 0) {
      ++unbounded;
      ASSERT_GT(slow.range, 15.0 - tolerance) << i;
      ASSERT_NEAR(along.norm(), 15.0, 1e-9);
      ASSERT_EQ(id, -1);
      ASSERT_EQ(rays.extra("label")->as_double(i), 0.0);
      ASSERT_EQ(normal(rays, i).norm(), 0.0);
      continue;
    }
    ++objects[id];
    if (tolerance < 1e-3) {
      ASSERT_NEAR(along.norm(), slow.range, tolerance) << i;
      ASSERT_EQ(static_cast<std::size_t>(id), slow.object) << i;
    } else {
      ASSERT_LT(along.norm(), slow.range + 0.05) << i;
    }
    const SceneObject& object = scene.objects[static_cast<std::size_t>(id)];
    ASSERT_EQ(rays.extra("label")->as_double(i), static_cast<double>(object.label));
    ASSERT_EQ(rays.extra("moving")->as_double(i), id >= 3 ? 1.0 : 0.0);
    ASSERT_EQ(true_end(rays, i), rays.ends[i]);
    ASSERT_NEAR(normal(rays, i).norm(), 1.0, 1e-6);
    ASSERT_LE(normal(rays, i).dot(direction), 1e-6);
    ASSERT_GE(rays.colours[i].intensity, 1);
  }
  EXPECT_GT(unbounded, 1000u);
  for (const int id : {0, 1, 2, 3, 4, 5})
    EXPECT_GT(objects[id], 2u) << id;
}

TEST(Simulate, MoversAreWhereTheirMotionSays) {
  const Scene scene = small_scene();
  const RayCloud rays = scan(scene, {.rays = 100'000, .noise = 0.0, .truth = true});
  const SceneObject& person = scene.objects[5];
  std::size_t seen = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays.extra("object_id")->values<std::int32_t>()[i] != 5) continue;
    ++seen;
    const Pose pose = pose_at(person.motion, rays.times[i]);
    const Eigen::Vector3d own = pose.rotation.transpose() * (rays.ends[i] - pose.translation);
    // On the surface of its box.
    const Eigen::Array3d beyond =
        (own - Eigen::Vector3d(0, 0, 0.9)).array().abs() - Eigen::Array3d(0.3, 0.2, 0.9);
    ASSERT_NEAR(beyond.maxCoeff(), 0.0, 1e-9);
  }
  EXPECT_GT(seen, 100u);
}

TEST(Simulate, NoiseIsGaussianAlongTheRay) {
  const Scene scene = small_scene();
  const double sigma = 0.03;
  const RayCloud rays = scan(scene, {.rays = 400'000, .noise = sigma, .truth = true});
  double n = 0, sum = 0, square = 0, cube = 0, fourth = 0, last = 0, product = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Vector3d truth = true_end(rays, i);
    const Eigen::Vector3d direction = (truth - rays.starts[i]).normalized();
    const Eigen::Vector3d error = rays.ends[i] - truth;
    const double along = error.dot(direction);
    ASSERT_LT((error - along * direction).norm(), 1e-12) << i;
    if (rays.bounded[i] == 0) {
      ASSERT_EQ(error.norm(), 0.0);
      continue;
    }
    const double z = along / sigma;
    n += 1, sum += z, square += z * z, cube += z * z * z, fourth += z * z * z * z;
    product += z * last;
    last = z;
  }
  ASSERT_GT(n, 190'000);
  // Five standard errors of each moment.
  const double root = std::sqrt(n);
  EXPECT_NEAR(sum / n, 0.0, 5.0 / root);
  EXPECT_NEAR(square / n, 1.0, 5.0 * std::sqrt(2.0) / root);
  EXPECT_NEAR(cube / n, 0.0, 5.0 * std::sqrt(15.0) / root);
  EXPECT_NEAR(fourth / n, 3.0, 5.0 * std::sqrt(96.0) / root);
  EXPECT_NEAR(product / n, 0.0, 5.0 / root) << "one ray's noise tells of the next one's";
}

bool same_bits(const RayCloud& a, const RayCloud& b) {
  const auto same = [](const auto& u, const auto& v) {
    return u.size() == v.size() && std::memcmp(u.data(), v.data(), u.size() * sizeof(u[0])) == 0;
  };
  return same(a.starts, b.starts) && same(a.ends, b.ends) && same(a.times, b.times) &&
         a.colours == b.colours && a.bounded == b.bounded && a.extras == b.extras;
}

TEST(Simulate, ThreadsAndChunksDoNotShow) {
  const Scene scene = small_scene();
  SimulationOptions options{.rays = 5003, .drift = make_drift({0.0, 20.0}, 0.2, 7), .truth = true, .seed = 9};
  const RayCloud reference = scan(scene, options, 1);
  for (const std::size_t chunk : {1u, 7u, 1000u}) {
    options.chunk_rays = chunk;
    for (const unsigned threads : {1u, 2u, 3u, 8u})
      EXPECT_TRUE(same_bits(scan(scene, options, threads), reference)) << chunk << " " << threads;
  }
  options.seed = 10;
  EXPECT_FALSE(same_bits(scan(scene, options), reference));
}

TEST(Simulate, RewoundItIsTheSameScan) {
  const Scene scene = small_scene();
  const Context context;
  const auto source = simulate(scene, {.rays = 1000});
  const RayCloud first = read_all(context, *source);
  source->rewind();
  EXPECT_TRUE(same_bits(read_all(context, *source), first));
  EXPECT_TRUE(first.extras.empty());
  EXPECT_EQ(source->info().ray_count, 1000u);
}

TEST(Simulate, DriftMovesWhatIsWrittenAndNotTheTruth) {
  const Scene scene = small_scene();
  SimulationOptions options{.rays = 20'000, .noise = 0.02, .truth = true};
  const RayCloud exact = scan(scene, options);
  options.drift = make_drift({0.0, 20.0}, 0.3, 5);
  const RayCloud drifted = scan(scene, options);
  double most = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const Pose error = pose_error(options.drift, exact.times[i], exact.starts[i]);
    ASSERT_LT((drifted.starts[i] - error * exact.starts[i]).norm(), 1e-12);
    ASSERT_LT((drifted.ends[i] - error * exact.ends[i]).norm(), 1e-12);
    ASSERT_EQ(true_end(drifted, i), true_end(exact, i));
    most = std::max(most, (drifted.starts[i] - exact.starts[i]).norm());
  }
  EXPECT_LE(most, 0.3 + 1e-12);
  EXPECT_GT(most, 0.29);
  EXPECT_LT((drifted.starts[0] - exact.starts[0]).norm(), 1e-12);
}

TEST(Simulate, AnyNumberOfRays) {
  const Scene scene = small_scene();
  for (const std::uint64_t count : {0u, 1u, 2u, 31u, 33u}) {
    EXPECT_EQ(scan(scene, {.rays = count}).size(), count);
    EXPECT_EQ(scan(scene, {.rays = count, .scanner = StandingScanner{}}).size(), count);
  }
  EXPECT_EQ(simulate(scene, {.rays = 100'000'000'000})->info().ray_count, 100'000'000'000u);
}

TEST(Simulate, RefusesWhatMakesNoScan) {
  const Scene scene = small_scene();
  const auto code = [&](const Scene& in, const SimulationOptions& options) {
    try {
      (void)simulate(in, options);
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::cancelled;
  };
  const double nan = std::nan("");
  EXPECT_EQ(code(scene, {.noise = -0.1}), ErrorCode::usage);
  EXPECT_EQ(code(scene, {.noise = nan}), ErrorCode::usage);
  EXPECT_EQ(code(scene, {.range = 0.0}), ErrorCode::usage);
  EXPECT_EQ(code(scene, {.range = nan}), ErrorCode::usage);
  EXPECT_EQ(code(scene, {.range = 1001.0}), ErrorCode::usage);
  EXPECT_EQ(code(scene, {.scanner = SpinningScanner{.beams = 0}}), ErrorCode::usage);
  EXPECT_EQ(code(scene, {.chunk_rays = 0}), ErrorCode::usage);
  EXPECT_EQ(code(Scene{}, {}), ErrorCode::usage);
  Scene without_stations = small_scene();
  without_stations.stations.clear();
  EXPECT_EQ(code(without_stations, {.scanner = StandingScanner{}}), ErrorCode::usage);
}

TEST(SceneMesh, HasEveryObjectUnderItsId) {
  const Scene scene = small_scene();
  const Mesh mesh = scene_mesh(scene);
  std::size_t faces = 0;
  for (const SceneObject& object : scene.objects)
    faces += object.mesh.faces.size();
  ASSERT_EQ(mesh.faces.size(), faces);
  const auto ids = mesh.face_columns.at(0).values<std::int32_t>();
  const auto labels = mesh.face_columns.at(1).values<std::uint8_t>();
  std::size_t f = 0;
  for (const SceneObject& object : scene.objects) {
    for (const Mesh::Face& face : object.mesh.faces) {
      ASSERT_EQ(ids[f], object.id);
      ASSERT_EQ(labels[f], static_cast<std::uint8_t>(object.label));
      const Eigen::Vector3d begin =
          object.motion.empty() ? Eigen::Vector3d::Zero() : object.motion.positions.front();
      for (std::size_t corner = 0; corner < 3; ++corner) {
        // The person stands unturned at first.
        EXPECT_LT((mesh.vertices[mesh.faces[f][corner]] - object.mesh.vertices[face[corner]] - begin).norm(),
                  1e-12);
      }
      ++f;
    }
  }
}

}  // namespace
}  // namespace ray
