#include "cloud_conflicts.h"
#include "measured_ends.h"

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

using CubesOfEach = std::array<VoxelSet, kDifferences>;

/// Judges the ends of one cloud as it is read, and adds up what they are.
class EndJudge {
 public:
  /// `gone` tells which were seen through: by bounded ray, or empty if none was.
  EndJudge(CloudComparison& comparison, std::size_t cloud, std::vector<std::uint8_t> gone)
      : comparison_(comparison), cloud_(cloud), gone_(std::move(gone)) {}

  /// The bounded rays of the next chunk have these measures.
  void see(const RayCloud& rays, std::span<const EndMeasure> measures) {
    ComparedEnds& ends = comparison_.clouds[cloud_];
    std::size_t next = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (rays.bounded[i] == 0) continue;
      const EndMeasure& measure = measures[next++];
      const Difference difference = judge(measure, ends.differences.size());
      ends.differences.push_back(difference);
      ends.distances.push_back(measure.distance);
      points_[number_of(difference)].push_back(rays.ends[i]);
      DifferenceTotals& totals = comparison_.totals[number_of(difference)];
      ++totals.rays;
      const bool in_both = difference == Difference::same;
      totals.area += (in_both ? 0.5 : 1.0) * static_cast<double>(measure.area);
    }
  }
  /// Adds the cubes of the ends since the last call.
  void add_cubes(CubesOfEach& cubes) {
    for (std::size_t kind = 0; kind < kDifferences; ++kind) {
      static_cast<void>(cubes[kind].insert(voxel_keys(points_[kind], {comparison_.distance})));
      points_[kind].clear();
    }
  }

 private:
  [[nodiscard]] Difference judge(const EndMeasure& measure, std::size_t end) const {
    if (measure.within != 0) return Difference::same;
    if (gone_.empty() || gone_[end] == 0) return Difference::unobserved;
    return cloud_ == 0 ? Difference::removed : Difference::added;
  }

  CloudComparison& comparison_;
  std::size_t cloud_;
  std::vector<std::uint8_t> gone_;
  std::array<std::vector<Eigen::Vector3d>, kDifferences> points_;
};

/// Of each bounded ray of a cloud, 1 if merging would take it out; empty if it would take out none.
std::vector<std::uint8_t> seen_through(const Context& context, std::span<const NumberedCloud> clouds,
                                       std::size_t own, double rays) {
  std::vector<std::uint8_t> gone;
  find_conflicts(
      context,
      {.clouds = clouds, .own = own, .rule = {.merge = CloudMerge::min, .rays = rays}, .is_shared = {}},
      {.ends =
           [&](std::span<const std::uint32_t>, std::span<const float> scores) {
             for (const float score : scores)
               gone.push_back(static_cast<double>(score) > rays ? 1 : 0);
           },
       .passes = {}});
  return gone;
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
  constexpr std::uint64_t kMostRows = 0xffffffff;
  const TwoClouds sources{&first, &second};
  CloudComparison comparison;
  std::array<NumberedCloud, 2> clouds;
  std::array<ReadEnds, 2> ends;
  for (std::size_t own = 0; own < 2; ++own) {
    ends[own] = read_ends(context, *sources[own], memory_budget(context) / kMeasuredEndBytes);
    clouds[own] = {.source = sources[own],
                   .first = own == 0 ? 0 : ends[0].rows,
                   .times = {ends[own].first_time, ends[own].last_time}};
    comparison.dropped += ends[own].dropped;
  }
  if (ends[0].rows + ends[1].rows > kMostRows)
    throw Error(ErrorCode::out_of_range, "more than 4 billion rays");
  comparison.distance =
      rule.distance > 0.0 ? rule.distance : usual_distance(ends[0].spacing, ends[1].spacing);
  MeasuredEnds measures(context, sources, std::move(ends), comparison.distance);
  CubesOfEach cubes;
  for (std::size_t own = 0; own < 2; ++own) {
    EndJudge judge(comparison, own,
                   measures.all_within(own) ? std::vector<std::uint8_t>()
                                            : seen_through(context, clouds, own, rule.rays));
    stream(
        context, *sources[own], nullptr, [](const RayCloud&) { return Nothing{}; },
        [&](const RayCloud& rays, Nothing) {
          judge.see(rays, measures.next(own, rays));
          judge.add_cubes(cubes);
        });
    sources[own]->rewind();
  }
  for (std::size_t kind = 0; kind < kDifferences; ++kind)
    comparison.totals[kind].volume =
        static_cast<double>(cubes[kind].size()) * std::pow(comparison.distance, 3);
  comparison.similarity = similarity_of(comparison);
  return comparison;
}

}  // namespace ray
