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

  void add(const Eigen::Vector3d& offset) {
    const double x = whole(offset.x()), y = whole(offset.y()), z = whole(offset.z());
    sum_x_ += x, sum_y_ += y, sum_z_ += z;
    xx_ += x * x, xy_ += x * y, xz_ += x * z;
    yy_ += y * y, yz_ += y * z, zz_ += z * z;
  }

  /// Of `count` points, those that were not added being at the middle.
  [[nodiscard]] Eigen::Vector3d mean(double count) const {
    return Eigen::Vector3d(sum_x_, sum_y_, sum_z_) / (count * scale_);
  }
  [[nodiscard]] Eigen::Matrix3d covariance(double count) const {
    const Eigen::Vector3d sum(sum_x_, sum_y_, sum_z_);
    Eigen::Matrix3d products;
    products << xx_, xy_, xz_, xy_, yy_, yz_, xz_, yz_, zz_;
    return (products - sum * sum.transpose() / count) / (count * scale_ * scale_);
  }

 private:
  [[nodiscard]] double whole(double offset) const {
    constexpr double kRounds = 0x1.8p52;
    return offset * scale_ + kRounds - kRounds;
  }

  double scale_ = 1.0;
  double sum_x_ = 0.0, sum_y_ = 0.0, sum_z_ = 0.0;
  double xx_ = 0.0, xy_ = 0.0, xz_ = 0.0, yy_ = 0.0, yz_ = 0.0, zz_ = 0.0;
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
    for (const Neighbour& neighbour : neighbours)
      moments.add(tree.point(neighbour.place) - middle);
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

}  // namespace

Shape shape_of(const Surfel& surfel) {
  const Eigen::Vector3d extents = surfel.variances.cwiseSqrt();
  if (!(extents[2] > 0.0)) return {.sphericity = 1.0};
  return {.sphericity = extents[0] / extents[2],
          .cylindricality = (extents[2] - extents[1]) / extents[2],
          .planarity = (extents[1] - extents[0]) / extents[2]};
}

Surfel surfel_at(NeighbourSearch& search, std::size_t place, const SurfelRule& rule) {
  const PointTree& tree = search.tree();
  constexpr double kFlat = 0.1;  // of the second variance: the normal of a thicker surfel may be any
  constexpr int kRounds = 2;
  auto neighbours = search.nearest(place, rule.neighbours, rule.reach);
  Surfel surfel = surfel_of(tree, place, neighbours);
  if (!rule.by_side) return surfel;
  const bool flat = surfel.variances[0] <= kFlat * surfel.variances[1];
  Eigen::Vector3d side = flat ? surfel.normal : unpack_direction(tree.to_sensor(place));
  if (!any_from_behind(tree, surfel.normal, neighbours) && (flat || !any_from_behind(tree, side, neighbours)))
    return surfel;
  for (int round = 0; round < kRounds; ++round) {
    surfel = surfel_of(tree, place, search.nearest_facing(place, rule.neighbours, rule.reach, side));
    side = surfel.normal;
  }
  return surfel;
}

}  // namespace ray
