// Angles between the normals of surfels and those of the surfaces, with and without the knowledge of where
// each point was seen from (paper, Table 2, as numbers).

#include "sampled.h"
#include "tables.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/spatial/surfel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

namespace bench {

namespace {

using Eigen::Vector3d;

/// Adds a scene's points.
using Scenery = std::function<void(Sampled&, const Sampling&)>;

struct Angles {
  double median = 0.0;  ///< degrees
  double most = 0.0;    ///< of 95 %
};

void add_angles(const Sampled& sampled, bool by_side, std::vector<double>& angles) {
  const ray::PointTree tree({}, seen_points(sampled.rays));
  std::vector<double> by_place(tree.size(), -1.0);
  ray::parallel_for({}, tree.size(), 1024, [&](std::size_t begin, std::size_t end) {
    ray::NeighbourSearch search(tree);
    ray::SurfelFinder finder(search, {.by_side = by_side});
    finder.for_each(begin, end, [&](const ray::SurfelOf& found) {
      const Truth& truth = sampled.truth[tree.index(found.place)];
      if (!truth.counted) return;
      const Vector3d& normal = found.surfel.normal;
      by_place[found.place] =
          std::atan2(normal.cross(truth.normal).norm(), normal.dot(truth.normal)) * 180.0 / std::numbers::pi;
    });
  });
  std::copy_if(by_place.begin(), by_place.end(), std::back_inserter(angles), [](double a) { return a >= 0; });
}

Angles pooled_angles(const Scenery& scenery, Sampling sampling, bool by_side) {
  std::vector<double> angles;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    sampling.seed = static_cast<std::uint64_t>(seed);
    Sampled sampled;
    scenery(sampled, sampling);
    add_angles(sampled, by_side, angles);
  }
  return {quantile(angles, 0.5), quantile(angles, 0.95)};
}

/// Returns the median with rays. `plane` is that of a plane like this; 0 where there is no bar.
double normals_row(const std::string& what, const Scenery& scenery, const Sampling& sampling, double plane) {
  const Angles with = pooled_angles(scenery, sampling, true);
  const Angles without = pooled_angles(scenery, sampling, false);
  const bool has_bar = plane > 0.0;
  std::printf("| %s | %g cm | %g cm | %.2f° | %.2f° | %.2f° | %.2f° | %s |\n", what.c_str(),
              100 * sampling.spacing, 100 * sampling.noise, with.median, with.most, without.median,
              without.most, has_bar ? verdict("≤ 1.15 × a plane", with.median <= 1.15 * plane).c_str() : "|");
  std::fflush(stdout);
  return with.median;
}

const std::array kSamplings{Sampling{.noise = 0.01}, Sampling{.noise = 0.02}, Sampling{.noise = 0.05},
                            Sampling{.spacing = 0.1, .noise = 0.02}};
using Medians = std::array<double, kSamplings.size()>;  // one for each

Medians normals_rows(const std::string& what, const Scenery& scenery, const Medians& planes = {}) {
  Medians medians{};
  for (std::size_t i = 0; i < kSamplings.size(); ++i)
    medians[i] = normals_row(what, scenery, kSamplings[i], planes[i]);
  return medians;
}

void add_plane(Sampled& out, const Sampling& sampling) {
  add_samples(out, rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), {{0, 0, 3}, {2, 1, 2}}, sampling);
}

void add_edge(Sampled& out, const Sampling& sampling) {
  const std::vector<Vector3d> sensors{{2, 0, 2}, {3, 1, 1}, {1, -1, 3}};
  // Counted is what is within 20 cm of the edge, where the rim is no rim.
  const auto near = [](Surface surface) {
    surface.at = [at = surface.at](double u, double v) {
      Truth truth = at(u, v);
      truth.counted = std::max(std::abs(truth.end.x()), std::abs(truth.end.z())) < 0.2 &&
                      std::abs(truth.end.y()) < 1.0 - kRim;
      return truth;
    };
    return surface;
  };
  add_samples(out, near(rectangle({-0.5, -1, 0}, {0.5, 0, 0}, {0, 2, 0})), sensors, sampling);
  add_samples(out, near(rectangle({0, -1, -0.5}, {0, 2, 0}, {0, 0, 0.5})), sensors, sampling);
}

Scenery pole(double radius) {
  return [radius](Sampled& out, const Sampling& sampling) {
    const std::vector<Vector3d> around{{3, 0, 1}, {-1.5, 2.6, 1.5}, {-1.5, -2.6, 0.5}};
    add_samples(out, cylinder(radius, 2.0), around, sampling);
  };
}

Scenery two_sided_wall(double thickness) {
  return [h = thickness / 2](Sampled& out, const Sampling& sampling) {
    add_samples(out, rectangle({-1, -1, h}, {2, 0, 0}, {0, 2, 0}), {{0, 0, 3}, {2, 1, 2}}, sampling);
    add_samples(out, rectangle({-1, -1, -h}, {0, 2, 0}, {2, 0, 0}), {{0, 0, -3}, {-1, 2, -2}}, sampling);
  };
}

}  // namespace

void print_normals() {
  std::printf("\nNormals: angles from the truth, turned to the sensor (0 to 180°)\n\n");
  std::printf(
      "| surface | spacing | noise | with rays: median | 95 %% | without: median | 95 %% | bar for the median with rays | |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  const Medians planes = normals_rows("plane", add_plane);
  normals_rows("90° edge, within 20 cm", add_edge);
  for (const int radius : {5, 10, 20, 50})
    normals_rows("cylinder r = " + std::to_string(radius) + " cm", pole(0.01 * radius));
  for (const int thickness : {2, 5, 10, 30})
    normals_rows("two-sided wall " + std::to_string(thickness) + " cm", two_sided_wall(0.01 * thickness),
                 planes);
}

}  // namespace bench
