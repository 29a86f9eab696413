// Distances of points from the surface they are samples of, before and after smoothing.

#include "plain_smoothing.h"
#include "sampled.h"
#include "tables.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/filter/smooth.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace bench {

namespace {

using Eigen::Vector3d;

/// The same points before, smoothed by the library, and smoothed without rays.
struct Versions {
  std::vector<double> before, after, plain;
};

/// Adds `value(end, truth)` of the counted points.
template <class Value>
void add_values(Versions& out, const Sampled& sampled, const Value& value) {
  ray::MemorySource source(sampled.rays);
  ray::MemorySink sink;
  ray::smooth_rays({}, source, sink);
  sink.finish();
  const std::vector<Vector3d> plain = plainly_smoothed(sampled.rays.ends);
  for (std::size_t i = 0; i < sampled.truth.size(); ++i) {
    const Truth& truth = sampled.truth[i];
    if (!truth.counted) continue;
    out.before.push_back(value(sampled.rays.ends[i], truth));
    out.after.push_back(value(sink.cloud().ends[i], truth));
    out.plain.push_back(value(plain[i], truth));
  }
}

void smoothing_row(const std::string& what, const Versions& errors, double least_ratio) {
  const double before = root_mean_square(errors.before);
  const double after = root_mean_square(errors.after);
  const double plain = root_mean_square(errors.plain);
  char bar[32] = "";
  if (least_ratio > 0.0) std::snprintf(bar, sizeof bar, "≥ %g times", least_ratio);
  std::printf("| %s | %.2f mm | %.2f mm | %.2f | %.2f mm | %.2f | %s |\n", what.c_str(), 1e3 * before,
              1e3 * after, before / after, 1e3 * plain, before / plain,
              least_ratio > 0.0 ? verdict(bar, before / after >= least_ratio).c_str() : "|");
  std::fflush(stdout);
}

std::vector<Sampled> all_seeds(const std::function<void(Sampled&, const Sampling&)>& add, Sampling sampling) {
  std::vector<Sampled> all(kSeeds);
  for (Sampled& sampled : all) {
    add(sampled, sampling);
    ++sampling.seed;
  }
  return all;
}

double above_plane(const Vector3d& end, const Truth& truth) {
  return truth.normal.dot(end - truth.end);
}

void smooth_planes() {
  const auto add = [](Sampled& out, const Sampling& sampling) {
    const double half = 50 * sampling.spacing;
    add_samples(out, rectangle({-half, -half, 0}, {2 * half, 0, 0}, {0, 2 * half, 0}),
                {{0, 0, 3 * half}, {half, half, 4 * half}}, sampling);
  };
  for (const double spacing : {0.03, 0.05, 0.10}) {
    Versions errors;
    for (const Sampled& sampled : all_seeds(add, {.spacing = spacing, .noise = 0.02}))
      add_values(errors, sampled, above_plane);
    char what[64];
    std::snprintf(what, sizeof what, "plane, spacing %g cm, noise 2 cm", 100 * spacing);
    smoothing_row(what, errors, 4.5);
  }
}

/// The share of the points on their own side of the middle that leave it.
double gone_over(const std::vector<double>& before, const std::vector<double>& after) {
  double own = 0.0;
  double gone = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i] <= 0.0) continue;
    own += 1.0;
    if (after[i] < 0.0) gone += 1.0;
  }
  return gone / own;
}

void smooth_walls() {
  static constexpr double kHalf = 0.03;  // m
  const auto add = [](Sampled& out, const Sampling& sampling) {
    add_samples(out, rectangle({-1.5, -1.5, kHalf}, {3, 0, 0}, {0, 3, 0}, 0), {{0, 0, 3}, {1, 1, 3}},
                sampling);
    add_samples(out, rectangle({-1.5, -1.5, -kHalf}, {0, 3, 0}, {3, 0, 0}, 1), {{0, 0, -3}, {1, -1, -3}},
                sampling);
  };
  for (const double noise : {0.01, 0.02}) {
    const std::vector<Sampled> scans = all_seeds(add, {.noise = noise});
    Versions heights;  // above the middle of the wall, to the side of each
    for (const Sampled& sampled : scans)
      add_values(heights, sampled,
                 [](const Vector3d& end, const Truth& truth) { return truth.normal.dot(end); });
    for (const int side : {0, 1}) {
      Versions errors;
      for (const Sampled& sampled : scans) {
        Sampled one = sampled;
        for (Truth& truth : one.truth)
          truth.counted = truth.counted && truth.part == side;
        add_values(errors, one, above_plane);
      }
      char what[80];
      std::snprintf(what, sizeof what, "6 cm wall, %s side, noise %g cm", side == 0 ? "one" : "other",
                    100 * noise);
      smoothing_row(what, errors, 2.5);
    }
    const double gone = gone_over(heights.before, heights.after);
    std::printf("| 6 cm wall, noise %g cm: gone to the other side | | %.2f %% | | %.2f %% | | %s |\n",
                100 * noise, 100 * gone, 100 * gone_over(heights.before, heights.plain),
                verdict("< 0.5 %", gone < 0.005).c_str());
  }
}

void smooth_trunk(double radius, double spacing) {
  const auto add = [&](Sampled& out, const Sampling& sampling) {
    const std::vector<Vector3d> around{{4, 0, 1.5}, {0, 4, 1.5}, {-4, 0, 1.5}, {0, -4, 1.5}};
    add_samples(out, cylinder(radius, 3.0), around, sampling);
  };
  Versions errors;
  for (const Sampled& sampled : all_seeds(add, {.spacing = spacing, .noise = 0.01}))
    add_values(errors, sampled,
               [&](const Vector3d& end, const Truth&) { return end.head<2>().norm() - radius; });
  char what[80];
  std::snprintf(what, sizeof what, "trunk r = %g cm, spacing %g cm, noise 1 cm", 100 * radius, 100 * spacing);
  smoothing_row(what, errors, 0.0);
  const double bias = mean(errors.after);
  const bool has_bar = radius == 0.2 && spacing == 0.03;
  std::printf("| the same: bias of the mean radius | %.2f mm | %.2f mm | | %.2f mm | | %s |\n",
              1e3 * mean(errors.before), 1e3 * bias, 1e3 * mean(errors.plain),
              has_bar ? verdict("< 1 mm", std::abs(bias) < 1e-3).c_str() : "|");
}

/// From the surface of what is solid where both x and z are below 0.
double from_box(const Vector3d& p) {
  const double inside = std::max(p.x(), p.z());
  return inside <= 0.0 ? inside : std::hypot(std::max(p.x(), 0.0), std::max(p.z(), 0.0));
}

void smooth_edge() {
  const auto add = [](Sampled& out, const Sampling& sampling) {
    const std::vector<Vector3d> sensors{{3, 0, 3}, {4, 1, 2}, {2, -1, 4}};
    add_samples(out, rectangle({-1, -1, 0}, {1, 0, 0}, {0, 2, 0}), sensors, sampling);
    add_samples(out, rectangle({0, -1, -1}, {0, 2, 0}, {0, 0, 1}), sensors, sampling);
    for (Truth& truth : out.truth)
      truth.counted = std::max(std::abs(truth.end.x()), std::abs(truth.end.z())) < 0.1 &&
                      std::abs(truth.end.y()) < 1.0 - kRim;
  };
  for (const double noise : {0.01, 0.02}) {
    Versions errors;
    for (const Sampled& sampled : all_seeds(add, {.noise = noise}))
      add_values(errors, sampled, [](const Vector3d& end, const Truth&) { return from_box(end); });
    char what[64];
    std::snprintf(what, sizeof what, "90° edge, within 10 cm, noise %g cm", 100 * noise);
    smoothing_row(what, errors, 0.0);
  }
}

}  // namespace

void print_smoothing() {
  std::printf("\nSmoothing: root mean square distance from the surface; spacing 3 cm where not said\n\n");
  std::printf(
      "| surface | before | after | times less | without rays, two passes | times less | bar | |\n"
      "|---|---|---|---|---|---|---|---|\n");
  smooth_planes();
  smooth_walls();
  smooth_trunk(0.2, 0.03);
  for (const double radius : {0.05, 0.1, 0.5})
    smooth_trunk(radius, 0.03);
  smooth_trunk(0.2, 0.1);
  smooth_edge();
}

}  // namespace bench
