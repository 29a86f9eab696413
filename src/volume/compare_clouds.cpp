#include "contradicted_ends.h"
#include "end_distances.h"

#include <raycloud/core/error.h>
#include <raycloud/spatial/voxel_set.h>
#include <raycloud/volume/compare_clouds.h>

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

std::size_t number_of(Difference difference) {
  return static_cast<std::size_t>(difference);
}

/// The class of each end of one cloud; `scores` are those of contradicted_ends.
std::vector<Difference> judge(std::span<const std::uint8_t> within, std::span<const float> scores,
                              double rays, Difference changed) {
  std::vector<Difference> differences(within.size());
  for (std::size_t i = 0; i < within.size(); ++i) {
    const bool gone = !scores.empty() && static_cast<double>(scores[i]) > rays;
    differences[i] = within[i] != 0 ? Difference::same : gone ? changed : Difference::unobserved;
  }
  return differences;
}

using CubesOfEach = std::array<VoxelSet, kDifferences>;

/// Adds the cubes of the ends of a cloud. Reads and rewinds it.
void add_cubes(const Context& context, RaySource& source, std::span<const Difference> differences,
               Metres width, CubesOfEach& cubes) {
  std::array<std::vector<Eigen::Vector3d>, kDifferences> points;
  std::size_t next = 0;
  stream(
      context, source, nullptr, [](const RayCloud&) { return 0; },
      [&](const RayCloud& rays, int) {
        for (std::size_t i = 0; i < rays.size(); ++i)
          if (rays.bounded[i] != 0) points[number_of(differences[next++])].push_back(rays.ends[i]);
        for (std::size_t kind = 0; kind < kDifferences; ++kind) {
          static_cast<void>(cubes[kind].insert(voxel_keys(points[kind], width)));
          points[kind].clear();
        }
      });
  source.rewind();
}

double share_of_same(double same, double changed) {
  return same / (same + changed);
}

std::optional<double> similarity_of(const CloudComparison& comparison) {
  const auto changed = [&](const auto& of) {
    return of(comparison.of(Difference::removed)) + of(comparison.of(Difference::added));
  };
  const auto area = [](const DifferenceTotals& totals) { return totals.area; };
  const auto rays = [](const DifferenceTotals& totals) { return static_cast<double>(totals.rays); };
  const DifferenceTotals& same = comparison.of(Difference::same);
  if (same.area + changed(area) > 0.0) return share_of_same(same.area, changed(area));
  if (rays(same) + changed(rays) > 0.0) return share_of_same(0.5 * rays(same), changed(rays));
  return {};
}

}  // namespace

double usual_distance(double spacing_of_first, double spacing_of_second) {
  constexpr double kSpacings = 3.0;
  constexpr double kLeast = 0.05;
  return std::max(kLeast, kSpacings * std::max(spacing_of_first, spacing_of_second));
}

CloudComparison compare_clouds(const Context& context, RaySource& first, RaySource& second,
                               const DifferenceRule& rule) {
  if (!(rule.distance >= 0.0) || !std::isfinite(rule.distance))
    throw Error(ErrorCode::usage, "the distance must not be below 0");
  if (!(rule.rays > 0.0) || !std::isfinite(rule.rays))
    throw Error(ErrorCode::usage, "the number of rays must be above 0");
  const std::array<RaySource*, 2> sources{&first, &second};
  CloudComparison comparison;
  std::array<TimedCloud, 2> timed;
  std::array<std::vector<std::uint8_t>, 2> within;
  std::array<std::vector<float>, 2> areas;
  {
    const std::array<CloudEnds, 2> ends{cloud_ends(context, first), cloud_ends(context, second)};
    comparison.distance =
        rule.distance > 0.0 ? rule.distance : usual_distance(ends[0].spacing, ends[1].spacing);
    for (std::size_t own = 0; own < 2; ++own) {
      EndDistances distances = distances_to(context, ends[own].tree, ends[1 - own].tree, comparison.distance);
      within[own] = std::move(distances.within);
      comparison.clouds[own].distances = std::move(distances.distances);
      areas[own] = areas_of(context, ends[own], comparison.distance);
      timed[own] = {sources[own], ends[own].first_time, ends[own].last_time};
      comparison.dropped += ends[own].dropped;
    }
  }
  CubesOfEach cubes;
  for (std::size_t own = 0; own < 2; ++own) {
    const bool all_same = std::find(within[own].begin(), within[own].end(), 0) == within[own].end();
    std::vector<Difference>& differences = comparison.clouds[own].differences;
    differences = judge(
        within[own], all_same ? std::vector<float>() : contradicted_ends(context, timed[own], timed[1 - own]),
        rule.rays, own == 0 ? Difference::removed : Difference::added);
    for (std::size_t i = 0; i < differences.size(); ++i) {
      DifferenceTotals& totals = comparison.totals[number_of(differences[i])];
      ++totals.rays;
      const bool in_both = differences[i] == Difference::same;
      totals.area += (in_both ? 0.5 : 1.0) * static_cast<double>(areas[own][i]);
    }
    add_cubes(context, *sources[own], differences, {comparison.distance}, cubes);
  }
  for (std::size_t kind = 0; kind < kDifferences; ++kind)
    comparison.totals[kind].volume =
        static_cast<double>(cubes[kind].size()) * std::pow(comparison.distance, 3);
  comparison.similarity = similarity_of(comparison);
  return comparison;
}

}  // namespace ray
