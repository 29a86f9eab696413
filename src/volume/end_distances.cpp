#include "end_distances.h"

#include <raycloud/exec/blocks.h>
#include <raycloud/exec/stream.h>
#include <raycloud/spatial/nearest_point.h>
#include <raycloud/spatial/neighbour_search.h>
#include <raycloud/spatial/point_spacing.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ray {
namespace {

constexpr std::size_t kEndsAtOnce = 4096;

/// π r² / k of the `k` neighbours found, the furthest of which is at distance r.
double area_within(std::span<const Neighbour> neighbours) {
  double furthest2 = 0.0;
  for (const Neighbour& neighbour : neighbours)
    furthest2 = std::max(furthest2, neighbour.distance2);
  return std::numbers::pi * furthest2 / static_cast<double>(neighbours.size());
}

}  // namespace

CloudEnds cloud_ends(const Context& context, RaySource& source) {
  struct OfChunk {
    std::vector<SeenPoint> points;
    double first = 0.0, last = 0.0;
  };
  std::vector<SeenPoint> points;
  blocks::EndSampler sampler;
  double first_time = std::numeric_limits<double>::infinity(), last_time = -first_time;
  if (source.info().ray_count) points.reserve(*source.info().ray_count);
  const StreamCounts counts = stream(
      context, source, nullptr,
      [](const RayCloud& rays) {
        OfChunk chunk;
        for (std::size_t i = 0; i < rays.size(); ++i)
          if (rays.bounded[i] != 0) chunk.points.push_back({rays.ends[i], {}});
        const auto [first, last] = std::minmax_element(rays.times.begin(), rays.times.end());
        if (first != rays.times.end()) chunk.first = *first, chunk.last = *last;
        return chunk;
      },
      [&](const RayCloud& rays, const OfChunk& chunk) {
        points.insert(points.end(), chunk.points.begin(), chunk.points.end());
        sampler.add(rays, chunk.points.size());
        if (rays.empty()) return;
        first_time = std::min(first_time, chunk.first);
        last_time = std::max(last_time, chunk.last);
      });
  source.rewind();
  const EndSample& sample = sampler.sample();
  return {.tree = PointTree(context, points),
          .spacing = estimate_spacing(sample.ends, sample.bounded).value,
          .dropped = counts.dropped,
          .first_time = first_time,
          .last_time = last_time};
}

EndDistances distances_to(const Context& context, const PointTree& ends, const PointTree& other,
                          double distance) {
  constexpr double kReach = 2.0;
  EndDistances result{std::vector<std::uint8_t>(ends.size()), std::vector<float>(ends.size())};
  parallel_for(context, ends.size(), kEndsAtOnce, [&](std::size_t begin, std::size_t end) {
    NearestPoint nearest(other);
    const double within2 = kReach * distance * (kReach * distance);
    for (std::size_t place = begin; place < end; ++place) {
      const double distance2 = nearest.distance2(ends.point(place), within2);
      const std::uint32_t i = ends.index(place);
      result.within[i] = distance2 <= distance * distance ? 1 : 0;
      result.distances[i] = static_cast<float>(std::sqrt(distance2));
    }
  });
  return result;
}

std::vector<float> areas_of(const Context& context, const CloudEnds& ends, double distance) {
  constexpr std::size_t kNeighbours = 16;
  constexpr double kSpacings = 32.0;
  const PointTree& tree = ends.tree;
  const double reach =
      ends.spacing > 0.0 ? kSpacings * ends.spacing : std::numeric_limits<double>::infinity();
  std::vector<float> areas(tree.size());
  parallel_for(context, tree.size(), kEndsAtOnce, [&](std::size_t begin, std::size_t end) {
    NeighbourSearch search(tree);
    for (std::size_t place = begin; place < end; ++place) {
      const std::span<const Neighbour> near = search.nearest(place, kNeighbours, reach);
      areas[tree.index(place)] = static_cast<float>(near.empty() ? distance * distance : area_within(near));
    }
  });
  return areas;
}

}  // namespace ray
