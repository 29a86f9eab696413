#include <raycloud/volume/ellipsoid.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ray {
namespace {

constexpr double kScale2 = 1.7 * 1.7;
constexpr double kThinnest = 0.002;  // m

}  // namespace

Ellipsoid ellipsoid_of(const Surfel& surfel, const Eigen::Vector3d& point, const Eigen::Vector3d& to_sensor,
                       double range_noise) {
  constexpr double kThinnestShare2 = 1.0 / (200.0 * 200.0);
  constexpr double kFlat = 0.1;  // of the variance across
  constexpr double kRounding = 65536.0;
  const Eigen::Vector3d across = surfel.axis.cross(surfel.normal);
  const double least2 = std::max(kThinnest * kThinnest, kThinnestShare2 * kScale2 * surfel.variances[2]);
  const auto part = [&](const Eigen::Vector3d& axis, double variance) {
    return Eigen::Matrix3d(std::max(kScale2 * variance, least2) * axis * axis.transpose());
  };
  Eigen::Matrix3d extent =
      part(surfel.normal, surfel.variances[0]) +
      (surfel.is_surface()
           ? Eigen::Matrix3d(part(across, surfel.variances[1]) + part(surfel.axis, surfel.variances[2]))
           : Eigen::Matrix3d(std::max(kScale2 * surfel.variances[2], least2) *
                             (Eigen::Matrix3d::Identity() - surfel.normal * surfel.normal.transpose())));
  if (to_sensor.squaredNorm() > 0.0) {
    const Eigen::Vector3d ray = to_sensor.normalized();
    extent += range_noise * range_noise * ray * ray.transpose();
  }
  Ellipsoid ellipsoid;
  ellipsoid.shape = extent.inverse();
  // What is stored is symmetric and in single precision.
  for (int row = 0; row < 3; ++row)
    for (int column = row; column < 3; ++column)
      ellipsoid.shape(row, column) = ellipsoid.shape(column, row) =
          static_cast<double>(static_cast<float>(ellipsoid.shape(row, column)));
  constexpr double kOwn = 0.98;  // how far out its point may be
  const Eigen::Vector3d offset = point - surfel.centroid;
  const double out = std::sqrt(offset.dot(ellipsoid.shape * offset));
  const Eigen::Vector3d centre = surfel.centroid + (out > kOwn ? 1.0 - kOwn / out : 0.0) * offset;
  ellipsoid.centre = (centre * kRounding).array().round() / kRounding;
  if (surfel.is_surface() && surfel.variances[0] <= kFlat * surfel.variances[1])
    ellipsoid.normal = (surfel.normal * 32767.0).array().round() / 32767.0;
  return ellipsoid;
}

Chord chord_of(const Ellipsoid& ellipsoid, const Eigen::Vector3d& start, const Eigen::Vector3d& end) {
  const Eigen::Vector3d from = start - ellipsoid.centre;
  const Eigen::Vector3d way = end - start;
  const Eigen::Vector3d scaled = ellipsoid.shape * way;
  const double way2 = way.dot(scaled);
  if (!(way2 > 0.0)) return {};
  const double middle = -from.dot(scaled) / way2;
  const Eigen::Vector3d nearest = from + middle * way;
  const double miss2 = nearest.dot(ellipsoid.shape * nearest);
  if (!(miss2 <= 1.0)) return {.miss2 = miss2};
  const double half = std::sqrt((1.0 - miss2) / way2);
  return {miss2, middle - half, middle + half};
}

}  // namespace ray
