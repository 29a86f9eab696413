// What merging two maps of a changed world takes out and what it keeps, on simulated scans.

#include "changed_points.h"
#include "street_scene.h"
#include "tables.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/stream.h>
#include <raycloud/synth/scene_caster.h>
#include <raycloud/synth/scenes.h>
#include <raycloud/synth/simulate.h>
#include <raycloud/volume/compare_clouds.h>
#include <raycloud/volume/merge_clouds.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace bench {
namespace {

constexpr std::array kMergeNumbers{2.0, 10.0, 20.0};
constexpr double kUsualNumber = 10.0;
constexpr int kSeenThroughBy = 10;    // rays, at least, for a changed point to count
constexpr double kNextDay = 86400.0;  // s

struct WorldPair {
  ray::Scene first, second;
  ray::Scene only_first, only_second;  ///< what the other has not
};

/// Things with that label are by turns in the first and in the second only; the second scan goes the path the
/// other way round.
WorldPair changed(const ray::Scene& scene, ray::SceneLabel label) {
  WorldPair pair;
  pair.first = pair.second = scene;
  pair.only_first.path = pair.only_second.path = scene.path;
  pair.first.objects.clear();
  pair.second.objects.clear();
  const auto add = [](ray::Scene& to, ray::SceneObject object) {
    object.id = static_cast<std::int32_t>(to.objects.size());
    object.present = {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    to.objects.push_back(std::move(object));
  };
  bool in_first = true;
  for (const ray::SceneObject& object : scene.objects) {
    if (object.label != label) {
      add(pair.first, object);
      add(pair.second, object);
      continue;
    }
    add(in_first ? pair.first : pair.second, object);
    add(in_first ? pair.only_first : pair.only_second, object);
    in_first = !in_first;
  }
  std::reverse(pair.second.path.positions.begin(), pair.second.path.positions.end());
  return pair;
}

struct HowScanned {
  std::string name;
  std::uint64_t rays = 300'000;
  bool standing = false;
};

/// With the columns `changed` (the end is on a thing that the other has not) and `through` (the ray goes
/// through a thing that only the other has), and times from `begin` on.
ray::RayCloud scan_of(const ray::Scene& scene, const ray::Scene& of_other, ray::SceneLabel label,
                      const HowScanned& how, double begin, std::uint64_t seed) {
  ray::SimulationOptions options{.rays = how.rays, .truth = true, .seed = seed};
  if (how.standing) options.scanner = ray::StandingScanner{};
  ray::RayCloud rays = read_all({}, *simulate(scene, options));
  const auto labels = rays.extra("label")->values<std::uint8_t>();
  ray::Column ends({"changed", ray::ScalarType::uint8}, rays.size());
  ray::Column through({"through", ray::ScalarType::uint8}, rays.size());
  const ray::SceneCaster caster(of_other);
  constexpr double kBeyond = 0.1;  // m
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ends.values<std::uint8_t>()[i] = labels[i] == static_cast<std::uint8_t>(label) ? 1 : 0;
    const Eigen::Vector3d way = rays.ends[i] - rays.starts[i];
    const double length = way.norm();
    const bool meets = !of_other.objects.empty() && length > kBeyond &&
                       caster.cast(rays.starts[i], way / length, length - kBeyond, 0.0).has_value();
    through.values<std::uint8_t>()[i] = meets ? 1 : 0;
    rays.times[i] += begin;
  }
  rays.extras.clear();
  rays.extras.push_back(std::move(ends));
  rays.extras.push_back(std::move(through));
  return rays;
}

struct Halves {
  ray::RayCloud stays, goes;
};

Halves merged(const ray::RayCloud& first, const ray::RayCloud& second, const ray::MergeRule& rule) {
  ray::MemorySource a(first), b(second);
  const std::array<ray::RaySource*, 2> clouds{&a, &b};
  ray::MemorySink stays(schema_of(first)), goes(schema_of(first));
  merge_clouds({}, clouds, stays, &goes, rule);
  return {stays.cloud(), goes.cloud()};
}

/// Shares of the bounded ends, or of all rays, that a column marks and that it does not.
struct Parts {
  double marked = 0.0, others = 0.0;
};

template <class Wanted>
Parts parts_of(const ray::RayCloud& rays, const char* column, const Wanted& wanted) {
  Parts parts;
  const auto marks = rays.extra(column)->values<std::uint8_t>();
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (wanted(i)) (marks[i] != 0 ? parts.marked : parts.others) += 1.0;
  return parts;
}

/// % of the others that stay and % of the marked ones that go.
std::pair<double, double> kept_and_gone(const Parts& stays, const Parts& goes) {
  const auto percent = [](double part, double rest) {
    return part + rest > 0.0 ? 100.0 * part / (part + rest) : 100.0;
  };
  return {percent(stays.others, goes.others), percent(goes.marked, stays.marked)};
}

/// What comparing calls a difference: of ends on what is the same in both, of changed ones that enough rays
/// tell of, and of changed ones that no ray tells of.
void difference_row(const std::string& name, const ray::RayCloud& first, const ray::RayCloud& second,
                    double least_found) {
  ray::MemorySource a(first), b(second);
  const ray::CloudComparison comparison = compare_clouds({}, a, b, {.rays = kUsualNumber});
  double same[2]{}, seen[2]{}, hidden[2]{};
  for (std::size_t cloud = 0; cloud < 2; ++cloud) {
    const ray::RayCloud& rays = cloud == 0 ? first : second;
    const auto crossings = rays.extra("crossings")->values<std::uint16_t>();
    const auto changed_ends = rays.extra("changed")->values<std::uint8_t>();
    for (std::size_t i = 0, next = 0; i < rays.size(); ++i) {
      if (rays.bounded[i] == 0) continue;
      const ray::Difference difference = comparison.clouds[cloud].differences[next++];
      const bool different = difference == ray::Difference::removed || difference == ray::Difference::added;
      if (changed_ends[i] == 0)
        ++same[different];
      else if (crossings[i] >= kSeenThroughBy)
        ++seen[different];
      else if (crossings[i] == 0)
        ++hidden[different];
    }
  }
  const auto percent = [](const double(&of)[2]) {
    return of[0] + of[1] > 0.0 ? 100.0 * of[1] / (of[0] + of[1]) : 0.0;
  };
  const bool met = percent(same) <= 0.1 && percent(seen) >= least_found;
  std::printf("| %s, differences | | %.3f, %.2f, %.2f; %.4f | | %s |\n", name.c_str(), percent(same),
              percent(seen), percent(hidden), comparison.similarity.value_or(0.0),
              least_found > 0.0 ? verdict("same ≤ 0.1, changed ≥ 95", met).c_str() : " |");
  std::fflush(stdout);
}

/// Returns the row on what is left.
std::string merge_rows(const HowScanned& how, const ray::Scene& scene, ray::SceneLabel label,
                       double least_gone) {
  const WorldPair pair = changed(scene, label);
  ray::RayCloud first = scan_of(pair.first, pair.only_second, label, how, 0.0, 1);
  ray::RayCloud second = scan_of(pair.second, pair.only_first, label, how, kNextDay, 2);
  add_what_others_tell(first, second);
  add_what_others_tell(second, first);
  const bool changes = !pair.only_first.objects.empty();
  std::string left;
  const auto row = [&](const char* what, const ray::MergeRule& rule, bool every_number, const auto& judge) {
    std::printf("| %s, %s |", how.name.c_str(), what);
    const bool strict = rule.merge == ray::CloudMerge::min;
    const double least_kept = strict ? 99.9 : 99.5;
    bool met = true;
    for (const double n : kMergeNumbers) {
      if (n != kUsualNumber && !every_number) {
        std::printf(" |");
        continue;
      }
      ray::MergeRule with = rule;
      with.rays = n;
      const Halves halves = merged(first, second, with);
      const auto [kept, gone] = judge(halves);
      if (changes && left.empty() && n == kUsualNumber)
        left = left_row(how.name, halves.stays, halves.goes, least_gone);
      changes ? std::printf(" %.2f, %.2f |", kept, gone) : std::printf(" %.2f |", kept);
      if (n == kUsualNumber) met = kept >= least_kept && gone >= least_gone;
    }
    const bool has_bar = least_gone > 0.0 && !rule.paper;
    std::printf(
        " %s |\n",
        has_bar ? verdict(strict ? "kept ≥ 99.9, gone ≥ 95" : "kept ≥ 99.5, gone ≥ 95", met).c_str() : " |");
    std::fflush(stdout);
  };
  // Points that enough rays of the other cloud tell of, and rays that end on what is the same in both.
  const auto ends_of = [](const ray::RayCloud& rays, double until) {
    const auto crossings = rays.extra("crossings")->values<std::uint16_t>();
    const auto changed_ends = rays.extra("changed")->values<std::uint8_t>();
    const auto through = rays.extra("through")->values<std::uint8_t>();
    return parts_of(rays, "changed", [=, &rays](std::size_t i) {
      return rays.bounded[i] != 0 && rays.times[i] < until &&
             (changed_ends[i] != 0 ? crossings[i] >= kSeenThroughBy : through[i] == 0);
    });
  };
  const auto ends = [&](const Halves& halves) {
    constexpr double kAllTime = std::numeric_limits<double>::infinity();
    return kept_and_gone(ends_of(halves.stays, kAllTime), ends_of(halves.goes, kAllTime));
  };
  const auto older_ends = [&](const Halves& halves) {
    return kept_and_gone(ends_of(halves.stays, kNextDay), ends_of(halves.goes, kNextDay));
  };
  const auto rays = [&](const Halves& halves) {
    const auto all = [](std::size_t) { return true; };
    return kept_and_gone(parts_of(halves.stays, "through", all), parts_of(halves.goes, "through", all));
  };
  row("min", {.merge = ray::CloudMerge::min}, true, ends);
  row("min, --paper", {.merge = ray::CloudMerge::min, .paper = true}, false, ends);
  row("max", {.merge = ray::CloudMerge::max}, false, rays);
  row("newest", {.merge = ray::CloudMerge::newest}, false, older_ends);
  difference_row(how.name, first, second, least_gone);
  return left;
}

}  // namespace

void print_merging() {
  std::printf(
      "\nMerging two scans of a world in which things have changed places: %% of what did not change that "
      "stays, and of what did that goes. For min these are points, the latter those that %d rays of the other "
      "scan went through and on for 5 cm; for newest the same of the older scan; for max rays, the latter "
      "those that go through a thing which only the other scan has. For differences: %% of what comparing calls "
      "different, of points that did not change, of those that did as for min, and of those that did and that no "
      "ray of the other scan went through; and the similarity\n\n| scans |",
      kSeenThroughBy);
  for (const double n : kMergeNumbers)
    std::printf(" n = %.0f |", n);
  std::printf(" bar, n = 10 | |\n|---|---|---|---|---|---|\n");
  using Label = ray::SceneLabel;
  const ray::Scene room = make_scene(ray::SceneKind::room, 2);
  std::string left;
  left += merge_rows({.name = "room"}, room, Label::furniture, 95.0);
  left += merge_rows({.name = "another room"}, make_scene(ray::SceneKind::room, 5), Label::furniture, 95.0);
  left += merge_rows({.name = "room, from a tripod", .standing = true}, room, Label::furniture, 95.0);
  left += merge_rows({.name = "building, sparse", .rays = 1'000'000}, make_scene(ray::SceneKind::building, 2),
                     Label::furniture, 0.0);
  left += merge_rows({.name = "street", .rays = 600'000}, street_scene(7, 0), Label::vehicle, 95.0);
  left +=
      merge_rows({.name = "yard, nothing changed", .rays = 400'000}, street_scene(8, 0), Label::boulder, 0.0);
  left += merge_rows({.name = "forest, nothing changed"}, make_scene(ray::SceneKind::forest, 2),
                     Label::vehicle, 0.0);
  print_left_heading();
  std::printf("%s", left.c_str());
}

}  // namespace bench
