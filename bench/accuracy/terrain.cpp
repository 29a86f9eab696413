// How near the extracted ground is to the true one, under grass, boulders and trees, on slopes, and with
// false returns below it.

#include "tables.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/random.h>
#include <raycloud/exec/stream.h>
#include <raycloud/mesh/mesh_height.h>
#include <raycloud/mesh/terrain.h>
#include <raycloud/synth/scenes.h>
#include <raycloud/synth/simulate.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace bench {
namespace {

constexpr std::uint64_t kTerrainRays = 2'000'000;
constexpr double kNode = 0.5;        // m between places that are compared
constexpr double kGroundBand = 0.2;  // m; ends this near to the mesh are called ground
constexpr double kAbove = 0.4;       // m; things higher than this above the true ground must not be
constexpr double kPit = 0.3;         // m

struct TerrainCase {
  ray::SceneKind kind = ray::SceneKind::terrain;
  double slope_deg = 0.0;      ///< the scene's own ground tilted so
  double false_returns = 0.0;  ///< share of bounded rays
  double gradient = 1.0;
  double rmse_bar = 0.04;
};

/// z grows with x.
void shear(std::vector<Eigen::Vector3d>& points, double slope) {
  for (Eigen::Vector3d& point : points)
    point.z() += slope * point.x();
}

ray::Scene tilted(ray::SceneKind kind, double slope) {
  ray::Scene scene = make_scene(kind, 1);
  for (ray::SceneObject& object : scene.objects)
    shear(object.mesh.vertices, slope);
  shear(scene.ground.vertices, slope);
  shear(scene.path.positions, slope);
  shear(scene.stations, slope);
  return scene;
}

/// Some ends moved on along their rays by 0.5 to 5 m, as echoes that come back by a detour are.
void add_false_returns(ray::RayCloud& cloud, double share) {
  const ray::RandomStream random(7, "false returns");
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.bounded[i] == 0 || random.uniform(i) >= share) continue;
    const Eigen::Vector3d along = (cloud.ends[i] - cloud.starts[i]).normalized();
    cloud.ends[i] += (0.5 + 4.5 * random.uniform(i, 1)) * along;
  }
}

struct TerrainScore {
  double rmse = 0.0, bias = 0.0, type_one = 0.0, type_two = 0.0, total = 0.0, pits = 0.0;
};

/// `clean` is the mesh of the cloud without false returns.
TerrainScore score_of(const ray::RayCloud& cloud, const ray::Scene& scene, const ray::Mesh& mesh,
                      const ray::Mesh& clean) {
  const ray::MeshHeight undisturbed(clean);
  const ray::MeshHeight truth(scene.ground);
  const ray::MeshHeight found(mesh);
  const auto labels = cloud.extra("label")->values<std::uint8_t>();
  TerrainScore score;
  std::set<std::pair<std::int64_t, std::int64_t>> nodes;  // where the ground was seen
  double ground = 0.0, objects = 0.0, missed = 0.0, taken = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.bounded[i] == 0) continue;
    const Eigen::Vector3d& end = cloud.ends[i];
    const bool in_band = std::abs(end.z() - found.at(end.x(), end.y()).height) <= kGroundBand;
    const double true_height = end.z() - truth.at(end.x(), end.y()).height;
    if (labels[i] == static_cast<std::uint8_t>(ray::SceneLabel::ground) && std::abs(true_height) < 0.15) {
      nodes.insert({std::llround(end.x() / kNode), std::llround(end.y() / kNode)});
      ++ground;
      missed += in_band ? 0 : 1;
    } else if (std::abs(true_height) > kAbove) {
      ++objects;
      taken += in_band ? 1 : 0;
    }
  }
  double count = 0.0;
  for (const auto& [column, row] : nodes) {
    const double x = kNode * static_cast<double>(column), y = kNode * static_cast<double>(row);
    const ray::HeightAt real = truth.at(x, y);
    const ray::HeightAt own = found.at(x, y);
    if (real.beyond || own.beyond) continue;
    const double error = own.height - real.height;
    ++count;
    score.rmse += error * error;
    score.bias += error;
    const bool dug = own.height < undisturbed.at(x, y).height - kPit;
    score.pits += error < -kPit && dug ? 1 : 0;
  }
  score.rmse = std::sqrt(score.rmse / count);
  score.bias /= count;
  score.pits *= 10'000.0 / (count * kNode * kNode);
  score.type_one = 100.0 * missed / std::max(ground, 1.0);
  score.type_two = 100.0 * taken / std::max(objects, 1.0);
  score.total = 100.0 * (missed + taken) / std::max(ground + objects, 1.0);
  return score;
}

void print_case(const TerrainCase& one) {
  const ray::Scene scene = tilted(one.kind, std::tan(one.slope_deg * std::numbers::pi / 180.0));
  const auto source =
      simulate(scene, {.rays = kTerrainRays, .scanner = ray::SpinningScanner{.beams = 32}, .truth = true});
  ray::RayCloud cloud = read_all({}, *source);
  const auto mesh_of = [&] {
    ray::MemorySource memory(cloud);
    return extract_terrain({}, memory, {.gradient = one.gradient}).mesh;
  };
  const ray::Mesh clean = mesh_of();
  add_false_returns(cloud, one.false_returns);
  const TerrainScore score = score_of(cloud, scene, mesh_of(), clean);
  const bool met = score.rmse <= one.rmse_bar && std::abs(score.bias) <= 0.03 && score.pits == 0.0;
  char bar[40];
  std::snprintf(bar, sizeof bar, "≤ %.0f cm, ≤ 3 cm, 0", 100.0 * one.rmse_bar);
  std::printf("| %s | %.0f | %.2f %% | %.1f | %.1f | %+.1f | %.2f %% | %.2f %% | %.2f %% | %.0f | %s |\n",
              scene.kind.c_str(), one.slope_deg, 100.0 * one.false_returns, one.gradient, 100.0 * score.rmse,
              100.0 * score.bias, score.type_one, score.type_two, score.total, score.pits,
              verdict(bar, met).c_str());
}

}  // namespace

void print_terrain() {
  std::printf(
      "\n## Terrain\n\nThe ground that `rayextract terrain` finds against the true one, every 0.5 m where the ground was "
      "seen: root mean square error and bias (cm), ground ends not within 20 cm of the mesh (type I), ends more than "
      "40 cm above or below the true ground that are (type II), and pits dug by false returns: places more than 30 cm below both "
      "the true ground and the mesh without false returns (for each hectare). Scenes "
      "of 2 million rays with 2 cm of noise, tilted as a whole; false returns lie 0.5 to 5 m behind the true end.\n\n"
      "| scene | slope (deg) | false returns | gradient | RMSE | bias | type I | type II | total | pits | bar | |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  using ray::SceneKind;
  print_case({SceneKind::terrain, 0, 0.0, 1.0, 0.04});
  print_case({SceneKind::terrain, 0, 0.0005, 1.0, 0.04});
  print_case({SceneKind::terrain, 0, 0.01, 1.0, 0.04});
  print_case({SceneKind::terrain, 0, 0.0005, 2.0, 0.04});
  print_case({SceneKind::terrain, 20, 0.0005, 1.0, 0.04});
  print_case({SceneKind::terrain, 30, 0.0005, 2.0, 0.06});
  print_case({SceneKind::terrain, 50, 0.0005, 2.5, 0.06});
  print_case({SceneKind::forest, 0, 0.0, 1.0, 0.04});
  print_case({SceneKind::forest, 0, 0.0005, 1.0, 0.04});
  print_case({SceneKind::forest, 30, 0.0005, 1.0, 0.04});
  print_case({SceneKind::forest, 30, 0.01, 1.0, 0.04});
  print_case({SceneKind::forest, 50, 0.0005, 2.5, 0.06});
  print_case({SceneKind::forest, 50, 0.01, 2.5, 0.06});
  print_case({SceneKind::forest, 60, 0.0005, 4.0, 0.06});
  print_case({SceneKind::field, 0, 0.0005, 1.0, 0.04});
  print_case({SceneKind::field, 50, 0.0005, 2.5, 0.06});
}

}  // namespace bench
