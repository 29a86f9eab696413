#include "exact_moments.h"

#include <raycloud/spatial/surfel.h>
#include <raycloud/spatial/symmetric_eigen.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ray {
namespace {

Surfel surfel_of(const PointTree& tree, std::size_t place, std::span<const Neighbour> neighbours) {
  Surfel surfel;
  const Eigen::Vector3d middle = tree.point(place);
  const Eigen::Vector3d to_sensor = unpack_direction(tree.to_sensor(place));
  surfel.count = static_cast<std::uint32_t>(neighbours.size() + 1);
  surfel.centroid = middle;
  for (const Neighbour& neighbour : neighbours)
    surfel.reach2 = std::max(surfel.reach2, neighbour.distance2);
  if (surfel.reach2 > 0.0) {
    const ExactMoments moments(tree, middle, neighbours, surfel.reach2);
    const double count = surfel.count;
    surfel.centroid += moments.mean(count);
    const SymmetricEigen eigen = symmetric_eigen(moments.covariance(count));
    surfel.variances = eigen.values.cwiseMax(0.0);
    surfel.normal = eigen.vectors.col(0);
    surfel.axis = eigen.vectors.col(2);
  }
  if (!surfel.is_surface() && to_sensor.squaredNorm() > 0.0) surfel.normal = to_sensor.normalized();
  if (surfel.normal.dot(to_sensor) < 0.0) surfel.normal = -surfel.normal;
  return surfel;
}

bool any_from_behind(const PointTree& tree, const Eigen::Vector3d& normal,
                     std::span<const Neighbour> neighbours) {
  return !std::all_of(neighbours.begin(), neighbours.end(), [&](const Neighbour& neighbour) {
    return is_seen_from(normal, tree.to_sensor(neighbour.place));
  });
}

/// The normal of a thicker surfel may be any.
bool is_flat(const Surfel& surfel, double flat = 0.1) {
  return surfel.variances[0] <= flat * surfel.variances[1];
}

/// No surface: what one beam left as it turned. Of a line, the normal may be any across it; of a sheet along
/// the ray, the noise of the range makes it, and no beam ends on a surface that it sees from its edge.
bool is_ring(const Surfel& surfel, const Eigen::Vector3d& ray) {
  constexpr double kThin = 0.05;
  constexpr double kEdgeOn = 0.1;  // cosine
  return surfel.variances[1] < kThin * surfel.variances[2] || surfel.normal.dot(ray) < kEdgeOn * ray.norm();
}

/// From within 30 degrees of the direction that this point was seen from: one side.
bool all_seen_alike(const PointTree& tree, std::size_t place, std::span<const Neighbour> neighbours) {
  constexpr double kAlike = 0.87 * 32767.0 * 32767.0;
  const PackedDirection& own = tree.to_sensor(place);
  return std::all_of(neighbours.begin(), neighbours.end(), [&](const Neighbour& neighbour) {
    const PackedDirection& d = tree.to_sensor(neighbour.place);
    const std::int32_t x = own[0] * d[0], y = own[1] * d[1], z = own[2] * d[2];
    return 1.0 * x + y + z >= kAlike;
  });
}

/// How many of the nearest, of any side, tell where the sides are.
std::size_t wide_count(const SurfelRule& rule) {
  return std::min(3 * rule.neighbours, NeighbourSearch::kMost);
}

/// More of the nearest than a surfel has, and from these, nearly always, the nearest of any side.
class WideNeighbours {
 public:
  /// `found` are the nearest; `nearest` is the surfel of as many of them as the rule says, of any side.
  WideNeighbours(NeighbourSearch& search, std::size_t place, const SurfelRule& rule,
                 std::span<const Neighbour> found, const Surfel& nearest)
      : search_(search), place_(place), rule_(rule), found_(found), count_(found.size()) {
    std::copy(found.begin(), found.end(), all_.begin());
    for (std::size_t i = 0; i < count_; ++i) {
      const PackedDirection& d = search.tree().to_sensor(all_[i].place);
      const auto at = static_cast<Eigen::Index>(i);
      x_[at] = d[0], y_[at] = d[1], z_[at] = d[2];
    }
    // Where all are of a side, the nearest of that side are the nearest.
    constexpr std::uint64_t kAll = ~std::uint64_t{0};
    if (count_ > 0) known_[known_count_++] = {kAll >> (64 - count_), nearest};
  }

  /// All, as long as they were the last that were searched; none after that.
  [[nodiscard]] std::span<const Neighbour> found() const { return found_; }

  [[nodiscard]] Surfel surfel_of_side(const Eigen::Vector3d& side) {
    const std::uint64_t facing = bits_facing(side);
    for (std::size_t i = 0; i < known_count_; ++i)
      if (known_[i].facing == facing) return known_[i].surfel;
    const auto count = static_cast<std::size_t>(std::popcount(facing));
    const bool are_all = count_ < wide_count(rule_);
    if (count < rule_.neighbours && !are_all) {
      found_ = {};
      return surfel_of(search_.tree(), place_,
                       search_.nearest_facing(place_, rule_.neighbours, rule_.reach, side));
    }
    Known& known = known_[std::min(known_count_, known_.size() - 1)];
    known_count_ = std::min(known_count_ + 1, known_.size());
    known = {facing, surfel_of(search_.tree(), place_, nearest_of(facing))};
    return known.surfel;
  }

 private:
  static constexpr std::size_t kMost = NeighbourSearch::kMost;
  using Doubles = Eigen::Array<double, kMost, 1>;

  /// A bit for each that was seen from the side.
  [[nodiscard]] std::uint64_t bits_facing(const Eigen::Vector3d& side) const {
    const Doubles facing = side.x() * x_ + side.y() * y_ + side.z() * z_;  // as is_seen_from has it
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < count_; ++i)
      bits |= std::uint64_t{facing[static_cast<Eigen::Index>(i)] >= 0.0} << i;
    return bits;
  }

  std::span<const Neighbour> nearest_of(std::uint64_t bits) {
    std::size_t count = 0;
    for (; bits != 0; bits &= bits - 1)
      of_side_[count++] = all_[static_cast<std::size_t>(std::countr_zero(bits))];
    return {of_side_.data(), keep_nearest(search_.tree(), {of_side_.data(), count}, rule_.neighbours)};
  }

  struct Known {
    std::uint64_t facing;
    Surfel surfel;
  };

  NeighbourSearch& search_;
  std::size_t place_;
  const SurfelRule& rule_;
  std::span<const Neighbour> found_;
  std::size_t count_;
  std::array<Neighbour, kMost> all_, of_side_;
  Doubles x_ = Doubles::Zero(), y_ = x_, z_ = x_;
  std::array<Known, 3> known_;
  std::size_t known_count_ = 0;
};

/// Where the nearest neighbours are no flat surface: round or thick? If more of them are flat, as they are
/// where the two sides of a wall are no further apart than their points, their normal says where the sides
/// are, else the ray; but the first normal does, if that leaves a clearly flatter surface.
SurfelOf surfel_of_thick(NeighbourSearch& search, std::size_t place, const SurfelRule& rule,
                         const SurfelOf& nearest, bool from_behind) {
  constexpr double kFlatEnough = 0.4;  // for that many
  constexpr double kClearly = 0.25;
  const PointTree& tree = search.tree();
  std::array<PackedDirection, NeighbourSearch::kMost> to_sensors;  // for the next search ends what was found
  const std::span<PackedDirection> nearest_to_sensors(to_sensors.data(), nearest.nearest.size());
  std::transform(nearest.nearest.begin(), nearest.nearest.end(), to_sensors.begin(),
                 [&](const Neighbour& neighbour) { return tree.to_sensor(neighbour.place); });
  const std::span<const Neighbour> found = search.nearest(place, wide_count(rule), rule.reach);
  const Surfel wide = surfel_of(tree, place, found);
  const Eigen::Vector3d side =
      is_flat(wide, kFlatEnough) ? wide.normal : unpack_direction(tree.to_sensor(place));
  // The nearest of a side are the nearest, if those are of it.
  if (!from_behind && std::all_of(nearest_to_sensors.begin(), nearest_to_sensors.end(),
                                  [&](const PackedDirection& d) { return is_seen_from(side, d); }))
    return {nearest.surfel, found};
  WideNeighbours neighbours(search, place, rule, found, nearest.surfel);
  const Surfel first = from_behind ? neighbours.surfel_of_side(nearest.surfel.normal) : nearest.surfel;
  const Surfel other = neighbours.surfel_of_side(side);
  const bool first_is_flatter =
      first.variances[0] * other.variances[1] < kClearly * other.variances[0] * first.variances[1];
  const Surfel surfel = neighbours.surfel_of_side((first_is_flatter ? first : other).normal);
  return {surfel, neighbours.found()};
}

/// With more of the neighbours seen from the side of the ray, if these are a surface.
Surfel past_ring(NeighbourSearch& search, std::size_t place, const SurfelRule& rule, const Surfel& ring,
                 const Eigen::Vector3d& ray) {
  const std::size_t wide = std::min(3 * rule.neighbours, NeighbourSearch::kMost);
  const Surfel surfel = surfel_of(search.tree(), place, search.nearest_facing(place, wide, rule.reach, ray));
  return is_flat(surfel) && !is_ring(surfel, ray) ? surfel : ring;
}

}  // namespace

Shape shape_of(const Surfel& surfel) {
  const Eigen::Vector3d extents = surfel.variances.cwiseSqrt();
  if (!(extents[2] > 0.0)) return {.sphericity = 1.0};
  return {.sphericity = extents[0] / extents[2],
          .cylindricality = (extents[2] - extents[1]) / extents[2],
          .planarity = (extents[1] - extents[0]) / extents[2]};
}

SurfelOf surfel_and_nearest(NeighbourSearch& search, std::size_t place, const SurfelRule& rule) {
  const PointTree& tree = search.tree();
  SurfelOf result;
  result.nearest = search.nearest(place, rule.neighbours, rule.reach);
  result.surfel = surfel_of(tree, place, result.nearest);
  if (rule.by_side) {
    const auto of_side = [&](const Eigen::Vector3d& side) {
      return surfel_of(tree, place, search.nearest_facing(place, rule.neighbours, rule.reach, side));
    };
    const Surfel& nearest = result.surfel;
    const bool from_behind = any_from_behind(tree, nearest.normal, result.nearest);
    if (!is_flat(nearest) && !all_seen_alike(tree, place, result.nearest))
      result = surfel_of_thick(search, place, rule, result, from_behind);
    else if (is_flat(nearest) && from_behind)
      result = {of_side(of_side(nearest.normal).normal), {}};
  }
  if (!rule.past_rings) return result;
  const Eigen::Vector3d ray = unpack_direction(tree.to_sensor(place));
  if (is_ring(result.surfel, ray)) result = {past_ring(search, place, rule, result.surfel, ray), {}};
  return result;
}

Surfel surfel_at(NeighbourSearch& search, std::size_t place, const SurfelRule& rule) {
  return surfel_and_nearest(search, place, rule).surfel;
}

}  // namespace ray
