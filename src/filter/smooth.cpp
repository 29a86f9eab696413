#include "surface_points.h"

#include <raycloud/filter/smooth.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ray {
namespace {

/// The plane around a point: through point + height · normal.
struct LocalPlane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // zero: there is none
  float height = 0.0F;                               // m
  float reach = 0.0F;                                // m, of its neighbours
};

LocalPlane plane_of(const PointTree& tree, std::size_t place, const Surfel& surfel) {
  if (!surfel.is_surface()) return {};
  const double height = surfel.normal.dot(surfel.centroid - tree.point(place));
  return {
      surfel.normal.cast<float>(), static_cast<float>(height),
      std::nextafter(static_cast<float>(std::sqrt(surfel.reach2)), std::numeric_limits<float>::infinity())};
}

/// Sums of fixed-point numbers do not depend on the order of the terms.
std::int64_t to_fixed(double value) {
  return static_cast<std::int64_t>(std::nearbyint(value * 0x1p36));
}

/// How far along `direction` (a unit vector) the surface is from a point: the mean of what the planes of its
/// neighbours say. On a curved surface the planes lie too low in the middle, by a half of the variance of
/// their points times the curvature, and rise above the surface by as much on average where they are read
/// off: the errors cancel.
double distance_to_surface(const PointTree& tree, std::span<const LocalPlane> planes, std::size_t place,
                           std::span<const Neighbour> neighbours, const Eigen::Vector3d& direction) {
  constexpr double kSteepest = 0.2;  // of a plane to the direction along which it is read off
  const Eigen::Vector3d point = tree.point(place);
  const Eigen::Vector3d own_normal = planes[place].normal.cast<double>();
  std::int64_t sum = 0, weights = 0;
  const auto add = [&](std::size_t other) {
    const LocalPlane& plane = planes[other];
    const Eigen::Vector3d normal = plane.normal.cast<double>();
    const double facing = normal.dot(direction);
    double alike = normal.dot(own_normal);
    if (!(facing > kSteepest) || !(alike > 0.0)) return;
    alike *= alike;
    alike *= alike;
    const double distance =
        (normal.dot(tree.point(other) - point) + static_cast<double>(plane.height)) / facing;
    sum += to_fixed(alike * distance);
    weights += to_fixed(alike);
  };
  add(place);
  for (const Neighbour& neighbour : neighbours)
    add(neighbour.place);
  return weights > 0 ? static_cast<double>(sum) / static_cast<double>(weights) : 0.0;
}

using Move = Eigen::Vector3f;  // m

std::vector<Move> smooth_block(const Context& context, Block<SeenPoint>&& block, double reach) {
  const PointTree tree(context, block.records);
  block.records = {};
  std::vector<LocalPlane> planes(tree.size());
  for_each_place(context, tree, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
    for (std::size_t place = begin; place < end; ++place)
      planes[place] =
          plane_of(tree, place, surfel_at(search, place, {kSurfaceNeighbours, reach / 2.0, true}));
  });
  std::vector<Move> moves(tree.size(), Move::Zero());
  for_each_place(context, tree, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
    constexpr double kFacing = 0.3;  // cosine from which on the ray is better than the normal
    for (std::size_t place = begin; place < end; ++place) {
      const LocalPlane& plane = planes[place];
      if (!block.is_own(tree.index(place)) || plane.normal.isZero()) continue;
      const Eigen::Vector3d normal = plane.normal.cast<double>();
      const Eigen::Vector3d ray = unpack_direction(tree.to_sensor(place)).normalized();
      const Eigen::Vector3d direction = ray.dot(normal) > kFacing ? ray : normal;
      const auto neighbours = search.nearest_facing(place, kSurfaceNeighbours, plane.reach, normal);
      const double distance = distance_to_surface(tree, planes, place, neighbours, direction);
      const double most = plane.reach;
      moves[tree.index(place)] = (std::clamp(distance, -most, most) * direction).cast<float>();
    }
  });
  return moves;
}

}  // namespace

StreamCounts smooth_rays(const Context& context, RaySource& source, RaySink& sink) {
  // The surface at a point depends on the planes of its neighbours, which depend on theirs.
  const BlockNeeds needs{.bytes_per_record = 90,
                         .reach = [](const EndSample& sample) { return 2.0 * neighbour_reach(sample); }};
  return run_blocks<SeenPoint, Move>(context, source, sink, needs, seen_point, smooth_block,
                                     [](RayCloud& rays, std::span<const Move> moves) {
                                       std::size_t next = 0;
                                       for (std::size_t i = 0; i < rays.size(); ++i)
                                         if (rays.bounded[i] != 0)
                                           rays.ends[i] += moves[next++].cast<double>();
                                     });
}

}  // namespace ray
