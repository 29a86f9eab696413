#include <raycloud/spatial/surfel.h>
#include <raycloud/spatial/symmetric_eigen.h>

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

/// Offsets from the point in the middle as whole numbers of a 2^-22th of the furthest: sums of their products
/// are exact, and so do not depend on the order of the neighbours.
class ExactMoments {
 public:
  explicit ExactMoments(double furthest2) {
    int exponent = 0;
    static_cast<void>(std::frexp(std::sqrt(furthest2), &exponent));
    scale_ = std::ldexp(1.0, 22 - exponent);
  }

  /// The offsets of two points.
  void add(const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
    const Pair x = whole(first.x(), second.x()), y = whole(first.y(), second.y()),
               z = whole(first.z(), second.z());
    sum_x_ += x, sum_y_ += y, sum_z_ += z;
    xx_ += x * x, xy_ += x * y, xz_ += x * z;
    yy_ += y * y, yz_ += y * z, zz_ += z * z;
  }

  /// Of `count` points, those that were not added being at the middle.
  [[nodiscard]] Eigen::Vector3d mean(double count) const {
    return Eigen::Vector3d(sum_x_.sum(), sum_y_.sum(), sum_z_.sum()) / (count * scale_);
  }
  [[nodiscard]] Eigen::Matrix3d covariance(double count) const {
    const Eigen::Vector3d sum(sum_x_.sum(), sum_y_.sum(), sum_z_.sum());
    const double xx = xx_.sum(), xy = xy_.sum(), xz = xz_.sum(), yy = yy_.sum(), yz = yz_.sum(),
                 zz = zz_.sum();
    Eigen::Matrix3d products;
    products << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return (products - sum * sum.transpose() / count) / (count * scale_ * scale_);
  }

 private:
  using Pair = Eigen::Array2d;
  [[nodiscard]] Pair whole(double first, double second) const {
    constexpr double kRounds = 0x1.8p52;
    return Pair(first, second) * scale_ + kRounds - kRounds;
  }

  double scale_ = 1.0;
  Pair sum_x_ = Pair::Zero(), sum_y_ = Pair::Zero(), sum_z_ = Pair::Zero();
  Pair xx_ = Pair::Zero(), xy_ = Pair::Zero(), xz_ = Pair::Zero();
  Pair yy_ = Pair::Zero(), yz_ = Pair::Zero(), zz_ = Pair::Zero();
};

Surfel surfel_of(const PointTree& tree, std::size_t place, std::span<const Neighbour> neighbours) {
  Surfel surfel;
  const Eigen::Vector3d middle = tree.point(place);
  const Eigen::Vector3d to_sensor = unpack_direction(tree.to_sensor(place));
  surfel.count = static_cast<std::uint32_t>(neighbours.size() + 1);
  surfel.centroid = middle;
  for (const Neighbour& neighbour : neighbours)
    surfel.reach2 = std::max(surfel.reach2, neighbour.distance2);
  if (surfel.reach2 > 0.0) {
    ExactMoments moments(surfel.reach2);
    const auto offset = [&](std::size_t i) -> Eigen::Vector3d {
      return tree.point(neighbours[i].place) - middle;
    };
    std::size_t next = 0;
    for (; next + 1 < neighbours.size(); next += 2)
      moments.add(offset(next), offset(next + 1));
    if (next < neighbours.size()) moments.add(offset(next), Eigen::Vector3d::Zero());
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
  return std::any_of(neighbours.begin(), neighbours.end(), [&](const Neighbour& neighbour) {
    const PackedDirection& d = tree.to_sensor(neighbour.place);
    return normal.x() * d[0] + normal.y() * d[1] + normal.z() * d[2] < 0.0;
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

/// A direction to tell sides by, where the nearest neighbours are no flat surface: the normal of more of
/// them, if that is one, as it is where the two sides of a wall are no further apart than their points; else
/// the ray.
Eigen::Vector3d side_of_thick(NeighbourSearch& search, std::size_t place, const SurfelRule& rule) {
  const std::size_t wide = std::min(3 * rule.neighbours, NeighbourSearch::kMost);
  const Surfel surfel = surfel_of(search.tree(), place, search.nearest(place, wide, rule.reach));
  constexpr double kFlatEnough = 0.4;  // for that many
  return is_flat(surfel, kFlatEnough) ? surfel.normal : unpack_direction(search.tree().to_sensor(place));
}

/// With more of the neighbours seen from the side of the ray, if these are a surface.
Surfel past_ring(NeighbourSearch& search, std::size_t place, const SurfelRule& rule, const Surfel& ring,
                 const Eigen::Vector3d& ray) {
  const std::size_t wide = std::min(3 * rule.neighbours, NeighbourSearch::kMost);
  const Surfel surfel = surfel_of(search.tree(), place, search.nearest_facing(place, wide, rule.reach, ray));
  return is_flat(surfel) && !is_ring(surfel, ray) ? surfel : ring;
}

Surfel nearest_surfel(NeighbourSearch& search, std::size_t place, const SurfelRule& rule) {
  const PointTree& tree = search.tree();
  const auto neighbours = search.nearest(place, rule.neighbours, rule.reach);
  Surfel surfel = surfel_of(tree, place, neighbours);
  if (!rule.by_side) return surfel;
  const bool flat = is_flat(surfel);
  const bool from_behind = any_from_behind(tree, surfel.normal, neighbours);
  if (flat ? !from_behind : all_seen_alike(tree, place, neighbours)) return surfel;
  const auto of_side = [&](const Eigen::Vector3d& side) {
    return surfel_of(tree, place, search.nearest_facing(place, rule.neighbours, rule.reach, side));
  };
  if (flat) return of_side(of_side(surfel.normal).normal);
  // Round or thick? The first way of telling sides, if it leaves a clearly flatter surface.
  const Eigen::Vector3d side = side_of_thick(search, place, rule);
  if (from_behind) surfel = of_side(surfel.normal);
  const Surfel other = of_side(side);
  constexpr double kClearly = 0.25;
  const bool first_is_flatter =
      surfel.variances[0] * other.variances[1] < kClearly * other.variances[0] * surfel.variances[1];
  return of_side((first_is_flatter ? surfel : other).normal);
}

}  // namespace

Shape shape_of(const Surfel& surfel) {
  const Eigen::Vector3d extents = surfel.variances.cwiseSqrt();
  if (!(extents[2] > 0.0)) return {.sphericity = 1.0};
  return {.sphericity = extents[0] / extents[2],
          .cylindricality = (extents[2] - extents[1]) / extents[2],
          .planarity = (extents[1] - extents[0]) / extents[2]};
}

Surfel surfel_at(NeighbourSearch& search, std::size_t place, const SurfelRule& rule) {
  const Surfel surfel = nearest_surfel(search, place, rule);
  if (!rule.past_rings) return surfel;
  const Eigen::Vector3d ray = unpack_direction(search.tree().to_sensor(place));
  return is_ring(surfel, ray) ? past_ring(search, place, rule, surfel, ray) : surfel;
}

}  // namespace ray
