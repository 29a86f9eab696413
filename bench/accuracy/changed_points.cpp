#include "changed_points.h"

#include "../cloud_ellipsoids.h"
#include "tables.h"

#include <raycloud/spatial/nearest_point.h>
#include <raycloud/volume/free_space.h>

#include <array>
#include <cstdio>
#include <numeric>
#include <vector>

namespace bench {
namespace {

constexpr double kNear = 0.05;  // m

ray::PointTree tree_of_ends(const ray::RayCloud& rays) {
  std::vector<ray::SeenPoint> points;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (rays.bounded[i] != 0)
      points.push_back({rays.ends[i], ray::pack_direction(rays.starts[i] - rays.ends[i])});
  return {{}, points};
}

enum Known : std::uint8_t { kIsNear, kNone, kFew, kSome, kEnough, kKinds };

Known known_of(std::uint16_t crossings, bool is_near) {
  constexpr std::uint16_t kManyRays = 10, kSomeRays = 5;
  if (is_near) return kIsNear;
  if (crossings == 0) return kNone;
  return crossings < kSomeRays ? kFew : crossings < kManyRays ? kSome : kEnough;
}

std::array<double, kKinds> changed_by_kind(const ray::RayCloud& rays) {
  const auto crossings = rays.extra("crossings")->values<std::uint16_t>();
  const auto near = rays.extra("near")->values<std::uint8_t>();
  const auto changed = rays.extra("changed")->values<std::uint8_t>();
  std::array<double, kKinds> counts{};
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (rays.bounded[i] != 0 && changed[i] != 0) ++counts[known_of(crossings[i], near[i] != 0)];
  return counts;
}

double sum(const std::array<double, kKinds>& counts) {
  return std::accumulate(counts.begin(), counts.end(), 0.0);
}

}  // namespace

void add_what_others_tell(ray::RayCloud& rays, const ray::RayCloud& of_other) {
  const ray::EllipsoidTree tree = ellipsoids_of({}, rays, {});
  std::vector<ray::Evidence> evidence(tree.size());
  add_passes(tree, of_other, {}, {0.0, 1.0}, evidence);
  const ray::PointTree others = tree_of_ends(of_other);
  ray::NearestPoint nearest(others);
  ray::Column crossings({"crossings", ray::ScalarType::uint16}, rays.size());
  ray::Column near({"near", ray::ScalarType::uint8}, rays.size());
  for (std::size_t i = 0, next = 0; i < rays.size(); ++i) {
    if (rays.bounded[i] == 0) continue;
    const ray::Evidence& of = evidence[tree.slot(next++)];
    crossings.values<std::uint16_t>()[i] = std::accumulate(of.passes.begin(), of.passes.end(), of.within);
    near.values<std::uint8_t>()[i] = nearest.distance2(rays.ends[i], kNear * kNear) <= kNear * kNear ? 1 : 0;
  }
  rays.extras.push_back(std::move(crossings));
  rays.extras.push_back(std::move(near));
}

void print_left_heading() {
  std::printf(
      "\nAll points that changed, min, n = 10, in %%: those that go, and those that stay by what the other scan "
      "tells of them: one of its ends is within 5 cm; else, so many of its rays went through and on for 5 "
      "cm\n\n| scans | points | go | stay: end within 5 cm | no ray | 1 to 4 | 5 to 9 | 10 or more | bar | |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
}

std::string left_row(const std::string& name, const ray::RayCloud& stays, const ray::RayCloud& goes,
                     double least_gone) {
  const std::array<double, kKinds> left = changed_by_kind(stays);
  const double gone = sum(changed_by_kind(goes)), all = gone + sum(left);
  const auto cell = [](const char* form, double number) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), form, number);
    return std::string(text.data());
  };
  std::string row = "| " + name + cell(" | %.0f |", all) + cell(" %.2f |", 100.0 * gone / all);
  for (const double count : left)
    row += cell(" %.2f |", 100.0 * count / all);
  if (!(least_gone > 0.0)) return row + " | |\n";
  return row + " " + verdict(cell("go ≥ %.0f", least_gone), 100.0 * gone >= least_gone * all) + " |\n";
}

}  // namespace bench
