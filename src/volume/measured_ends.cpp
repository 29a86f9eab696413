#include "measured_ends.h"

#include <raycloud/exec/blocks.h>
#include <raycloud/spatial/nearest_point.h>
#include <raycloud/spatial/neighbour_search.h>
#include <raycloud/spatial/point_tree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ray {
namespace {

constexpr std::size_t kEndsAtOnce = 4096;
constexpr double kSeen = 2.0;  ///< how many times the distance is looked for others
constexpr std::size_t kMostParts = 1024;
constexpr double kRounding = 1.0 + 1e-9;

/// π r² / k of the `k` neighbours found, the furthest of which is at distance r.
double area_within(std::span<const Neighbour> neighbours) {
  double furthest2 = 0.0;
  for (const Neighbour& neighbour : neighbours)
    furthest2 = std::max(furthest2, neighbour.distance2);
  return std::numbers::pi * furthest2 / static_cast<double>(neighbours.size());
}

/// By index. Those that are not `own` are neighbours only; empty: all are.
std::vector<EndMeasure> measured(const Context& context, const PointTree& ends, const PointTree& other,
                                 std::span<const std::uint8_t> own, double reach, double distance) {
  constexpr std::size_t kNeighbours = 16;
  std::vector<EndMeasure> measures(ends.size());
  parallel_for(context, ends.size(), kEndsAtOnce, [&](std::size_t begin, std::size_t end) {
    NearestPoint nearest(other);
    NeighbourSearch search(ends);
    const double within2 = kSeen * distance * (kSeen * distance);
    for (std::size_t place = begin; place < end; ++place) {
      const std::uint32_t i = ends.index(place);
      if (!own.empty() && own[i] == 0) continue;
      const double distance2 = nearest.distance2(ends.point(place), within2);
      const std::span<const Neighbour> near = search.nearest(place, kNeighbours, reach);
      measures[i] = {static_cast<float>(std::sqrt(distance2)),
                     static_cast<float>(near.empty() ? distance * distance : area_within(near)),
                     static_cast<std::uint8_t>(distance2 <= distance * distance ? 1 : 0)};
    }
  });
  return measures;
}

/// m, of the neighbours by which areas are measured.
double area_reach(const ReadEnds& ends) {
  constexpr double kSpacings = 32.0;
  return ends.spacing > 0.0 ? kSpacings * ends.spacing : std::numeric_limits<double>::infinity();
}

bool are_all_within(std::span<const EndMeasure> measures) {
  return std::all_of(measures.begin(), measures.end(),
                     [](const EndMeasure& measure) { return measure.within != 0; });
}

}  // namespace

MeasuredEnds::MeasuredEnds(const Context& context, const TwoClouds& clouds, std::array<ReadEnds, 2>&& ends,
                           double distance) {
  const std::uint64_t count = ends[0].sample.bounded + ends[1].sample.bounded;
  if (!ends[0].fits() || !ends[1].fits() || count * kMeasuredEndBytes > memory_budget(context)) {
    measure_in_blocks(context, clouds, ends, distance);
    return;
  }
  std::array<std::unique_ptr<PointTree>, 2> trees;
  for (std::size_t own = 0; own < 2; ++own) {
    trees[own] = std::make_unique<PointTree>(context, ends[own].points);
    ends[own].points = std::vector<SeenPoint>();
  }
  for (std::size_t own = 0; own < 2; ++own) {
    whole_[own] = measured(context, *trees[own], *trees[1 - own], {}, area_reach(ends[own]), distance);
    all_within_[own] = are_all_within(whole_[own]);
  }
}

void MeasuredEnds::measure_in_blocks(const Context& context, const TwoClouds& clouds,
                                     const std::array<ReadEnds, 2>& ends, double distance) {
  const std::size_t memory = memory_budget(context);
  std::vector<Eigen::Vector3d> sample = ends[0].sample.ends;
  sample.insert(sample.end(), ends[1].sample.ends.begin(), ends[1].sample.ends.end());
  const std::uint64_t count = ends[0].sample.bounded + ends[1].sample.bounded;
  // What lies around a block takes room too.
  const std::size_t parts = std::min<std::uint64_t>(2 * (count * kMeasuredEndBytes / memory + 1), kMostParts);
  cuts_ = std::make_unique<SpaceCuts>(std::move(sample), parts);
  std::array<std::unique_ptr<blocks::SpilledRecords<SeenPoint>>, 2> near;
  for (std::size_t cloud = 0; cloud < 2; ++cloud) {
    near[cloud] = std::make_unique<blocks::SpilledRecords<SeenPoint>>(
        *cuts_, kRounding * std::max(area_reach(ends[cloud]), kSeen * distance), memory / 2);
    stream(
        context, *clouds[cloud], nullptr,
        [&](const RayCloud& rays) {
          return near[cloud]->sort(rays, blocks::extract_all<SeenPoint>(rays, seen_end));
        },
        [&](const RayCloud&, const blocks::Copies<SeenPoint>& copies) { near[cloud]->add(copies); });
    clouds[cloud]->rewind();
    spilled_[cloud] = std::make_unique<SpilledRows<EndMeasure>>(cuts_->parts(), memory / 64);
  }
  for (std::size_t part = 0; part < cuts_->parts(); ++part) {
    check_cancelled(context);
    std::array<std::vector<std::uint8_t>, 2> own;
    std::array<std::unique_ptr<PointTree>, 2> trees;
    for (std::size_t cloud = 0; cloud < 2; ++cloud) {
      const Block<SeenPoint> block = near[cloud]->take(part);
      own[cloud] = block.own;
      trees[cloud] = std::make_unique<PointTree>(context, block.records);
    }
    for (std::size_t cloud = 0; cloud < 2; ++cloud) {
      const std::vector<EndMeasure> all =
          measured(context, *trees[cloud], *trees[1 - cloud], own[cloud], area_reach(ends[cloud]), distance);
      std::vector<EndMeasure> of_own;
      for (std::size_t i = 0; i < all.size(); ++i)
        if (own[cloud][i] != 0) of_own.push_back(all[i]);
      all_within_[cloud] = all_within_[cloud] && are_all_within(of_own);
      spilled_[cloud]->append(part, of_own);
    }
  }
}

std::span<const EndMeasure> MeasuredEnds::next(std::size_t cloud, const RayCloud& rays) {
  parts_.clear();
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (rays.bounded[i] != 0)
      parts_.push_back(cuts_ ? static_cast<std::uint32_t>(cuts_->part_of(rays.ends[i])) : 0);
  if (cuts_) return spilled_[cloud]->take(parts_);
  next_[cloud] += parts_.size();
  return std::span<const EndMeasure>(whole_[cloud]).subspan(next_[cloud] - parts_.size(), parts_.size());
}

}  // namespace ray
