#include "surface_fit.h"
#include "surface_points.h"

#include <raycloud/exec/fresh_memory.h>
#include <raycloud/exec/parallel.h>
#include <raycloud/filter/smooth.h>

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

LocalPlane plane_of(const PointTree& tree, std::size_t place, const Surfel& surfel) {
  if (!surfel.is_surface()) return {};
  const double height = surfel.normal.dot(surfel.centroid - tree.point(place));
  return {surfel.normal.cast<float>(), static_cast<float>(height),
          static_cast<float>(surfel.variances[1] + surfel.variances[2]),
          static_cast<float>(std::sqrt(surfel.reach2))};
}

// The surface at a point is that of the planes within so many times the reach of its own: some forty.
constexpr double kWider = 1.6;

using Move = Eigen::Vector3f;  // m

/// How far the points of a leaf look for planes: the furthest of them, but for a few that are far off. m
double reach_of_leaf(std::span<const LocalPlane> planes) {
  constexpr float kFarOff = 1.5F;  // times the mean
  float sum = 0.0F, furthest = 0.0F;
  for (const LocalPlane& plane : planes)
    sum += plane.reach;
  const float most = kFarOff * sum / static_cast<float>(planes.size());
  for (const LocalPlane& plane : planes)
    if (plane.reach <= most) furthest = std::max(furthest, plane.reach);
  return kWider * static_cast<double>(furthest);
}

/// To a height above the plane's point: along the ray where that is not too much aslant, else along the
/// normal.
Move move_of(const LocalPlane& plane, double height, const PackedDirection& to_sensor) {
  constexpr double kFacing = 0.3;  // cosine from which on the ray is better than the normal
  const Eigen::Vector3d normal = plane.normal.cast<double>();
  const Eigen::Vector3d ray = unpack_direction(to_sensor).normalized();
  const double facing = ray.dot(normal);
  const bool along_ray = facing > kFacing;
  const double most = plane.reach;
  const double distance = std::clamp(along_ray ? height / facing : height, -most, most);
  return (distance * (along_ray ? ray : normal)).cast<float>();
}

std::vector<Move> smooth_block(const Context& context, Block<SeenPoint>&& block, double reach) {
  const PointTree tree(context, block.records);
  block.records = std::vector<SeenPoint>();
  auto planes = touched_vector<LocalPlane>(context, tree.size());
  const auto neighbours_of = [&](NeighbourSearch& search, std::size_t place) {
    const LocalPlane& plane = planes[place];
    return search.places_facing(place, SurfaceFit::kMost, kWider * static_cast<double>(plane.reach),
                                plane.normal.cast<double>());
  };
  NeededPlaces(block, tree)
      .work_on(
          context, 1,
          [&](NeighbourSearch& search, std::size_t begin, std::size_t end, const auto& wanted) {
            SurfelFinder finder(search, {kSurfaceNeighbours, reach / (1.0 + kWider), true});
            finder.for_each(begin, end, wanted, [&](const SurfelOf& found) {
              planes[found.place] = plane_of(tree, found.place, found.surfel);
            });
          },
          {.radius = [&](std::size_t place) { return kWider * static_cast<double>(planes[place].reach); },
           .neighbours = neighbours_of});
  std::vector<Move> moves;
  reserve_touched(context, moves, tree.size());
  moves.resize(tree.size(), Move::Zero());
  for_each_place(context, tree, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
    SurfaceFit fit(tree, planes);
    const auto move = [&] {
      for (const auto& [place, height] : fit.heights())
        moves[tree.index(place)] = move_of(planes[place], height, tree.to_sensor(place));
    };
    std::size_t leaf_end = begin;
    for (std::size_t place = begin; place < end; ++place) {
      if (place == leaf_end) {
        leaf_end = std::min(search.leaf_of(place).end, end);
        search.look_around(place, reach_of_leaf(std::span(planes).subspan(place, leaf_end - place)));
      }
      if (!block.is_own(tree.index(place)) || planes[place].normal.isZero()) continue;
      fit.add(place, neighbours_of(search, place));
      if (fit.is_full()) move();
    }
    move();
  });
  return moves;
}

}  // namespace

StreamCounts smooth_rays(const Context& context, RaySource& source, RaySink& sink) {
  // The surface at a point depends on the planes of its neighbours, and these on theirs.
  const BlockNeeds needs{.bytes_per_record = 90, .reach = [](const EndSample& sample) {
                           return (1.0 + kWider) * neighbour_reach(sample);
                         }};
  return run_blocks<SeenPoint, Move>(context, source, sink, needs, seen_point, smooth_block,
                                     [](RayCloud& rays, std::span<const Move> moves) {
                                       std::size_t next = 0;
                                       for (std::size_t i = 0; i < rays.size(); ++i)
                                         if (rays.bounded[i] != 0)
                                           rays.ends[i] += moves[next++].cast<double>();
                                     });
}

}  // namespace ray
