// A long street of which one scan is bent: what is left of the bend, and whether what is not bent stays.

#include "tables.h"

#include <raycloud/align/clouds.h>
#include <raycloud/core/bend.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/random.h>
#include <raycloud/exec/stream.h>
#include <raycloud/synth/simulate.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace bench {
namespace {

constexpr double kHalfLength = 250.0;  // m

void add_quad(ray::Mesh& mesh, const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
              const Eigen::Vector3d& v) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {corner, corner + u, corner + u + v, corner + v});
  mesh.faces.push_back({first, first + 1, first + 2});
  mesh.faces.push_back({first, first + 2, first + 3});
}

/// Houses of changing width, height and distance from the middle of the street, and a flat ground; the
/// scanner goes along it once.
ray::Scene long_street() {
  const ray::RandomStream random(1, "long street");
  ray::Scene scene;
  scene.kind = "long street";
  ray::Mesh mesh;
  add_quad(mesh, {-kHalfLength - 20.0, -30.0, 0.0}, {2.0 * kHalfLength + 40.0, 0.0, 0.0}, {0.0, 60.0, 0.0});
  std::uint64_t house = 0;
  for (const double side : {-1.0, 1.0})
    for (double x = -kHalfLength; x < kHalfLength; ++house) {
      const double width = 6.0 + 8.0 * random.uniform(house, 0),
                   height = 5.0 + 5.0 * random.uniform(house, 1),
                   front = side * (6.0 + 4.0 * random.uniform(house, 2)), depth = 10.0 * side;
      add_quad(mesh, {x, front, 0.0}, {width, 0.0, 0.0}, {0.0, 0.0, height});
      for (const double end : {x, x + width})
        add_quad(mesh, {end, front, 0.0}, {0.0, depth, 0.0}, {0.0, 0.0, height});
      x += width + (random.uniform(house, 3) < 0.3 ? 3.0 : 0.0);
    }
  ray::SceneObject object;
  object.label = ray::SceneLabel::wall;
  object.name = "street";
  object.mesh = std::move(mesh);
  scene.objects.push_back(std::move(object));
  for (double x = -kHalfLength; x <= kHalfLength; x += 1.0) {
    scene.path.times.push_back((x + kHalfLength) / 1.5);
    scene.path.positions.emplace_back(x, 0.5 * std::sin(0.05 * x), 1.6);
  }
  return scene;
}

struct Left {
  double usual = 0.0, most = 0.0;  ///< m: root mean square, and all but one in a thousand
};

Left left_of(const ray::CloudAlignment& found, const ray::RayCloud& bent, const ray::RayCloud& truth,
             bool with_bend) {
  std::vector<double> distances;
  double squares = 0.0;
  for (std::size_t i = 0; i < bent.size(); ++i) {
    if (bent.bounded[i] == 0 || std::abs(truth.ends[i].x()) > kHalfLength) continue;
    Eigen::Vector3d end = found.pose * bent.ends[i];
    if (with_bend) end = found.bend * end;
    distances.push_back((end - truth.ends[i]).norm());
    squares += distances.back() * distances.back();
  }
  std::sort(distances.begin(), distances.end());
  return {std::sqrt(squares / static_cast<double>(distances.size())),
          distances[distances.size() / 1000 * 999]};
}

}  // namespace

void print_bends() {
  constexpr std::uint64_t kRays = 2'000'000;
  constexpr double kYaw = 0.2 * std::numbers::pi / 180.0;
  const ray::Scene scene = long_street();
  const auto scan = [&](std::uint64_t seed) {
    return read_all({}, *simulate(scene, {.rays = kRays, .range = 60.0, .seed = seed}));
  };
  const ray::RayCloud reference = scan(1), truth = scan(2);
  std::printf(
      "\nA street of 500 m, two scans of 2 million rays, one of them bent sideways, turned by 0.2 degrees and moved by 0.6 m: how far points "
      "are from where they belong\n\n"
      "| bend at the ends, m | bend found | rigid, m | with the bend: usual, most (99.9 %%), m | seconds | bar | |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const double size : {1.0, 0.3, 0.1, 0.0}) {
    ray::Bend bend;
    bend.shifts(1, 0) = size / (kHalfLength * kHalfLength);
    ray::RayCloud rays = truth;
    bend_rays(bend, rays);
    ray::Pose moved = ray::rotation_pose({0.0, 0.0, kYaw});
    moved.translation = {0.5, -0.3, 0.1};
    rays.transform(moved);
    ray::MemorySource a(rays), b(reference);
    const auto begin = std::chrono::steady_clock::now();
    const ray::CloudAlignment found = align_clouds({}, a, b, {.local = true, .nonrigid = true});
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const Left rigid = left_of(found, rays, truth, false), left = left_of(found, rays, truth, true);
    const bool met = found.doubt.empty() && left.usual < 0.01 && found.bend.is_none() == (size == 0.0);
    std::printf("| %.1f | %s | %.3f | %.4f, %.4f | %.1f | %s |\n", size,
                !found.doubt.empty()   ? "refused"
                : found.bend.is_none() ? "none"
                                       : "yes",
                rigid.usual, left.usual, left.most, seconds,
                verdict(size > 0.0 ? "found, 1 cm" : "none found, 1 cm", met).c_str());
    std::fflush(stdout);
  }
}

}  // namespace bench
