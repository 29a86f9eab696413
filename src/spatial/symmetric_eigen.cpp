#include <raycloud/spatial/symmetric_eigen.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace ray {
namespace {

SymmetricEigen by_iteration(const Eigen::Matrix3d& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

/// 2 cos(acos(c) / 3), for c from 0 to 1: the largest x for which x³ - 3 x = 2 c, which is flat nowhere near.
/// A polynomial is 1e-4 off, two steps of Newton take that to the last bit. The same on every machine, which
/// no library promises of its cosines.
double twice_cosine_of_third(double c) {
  double x = 1.732133 + c * (0.330661 + c * (-0.081382 + c * 0.018639));
  for (int step = 0; step < 2; ++step)
    x -= (x * (x * x - 3.0) - 2.0 * c) / (3.0 * (x * x - 1.0));
  return x;
}

/// The longest of the products of rows, all of which are along the vector that the matrix takes to zero.
Eigen::Vector3d null_vector(const Eigen::Matrix3d& matrix) {
  const Eigen::Vector3d a = matrix.row(0).cross(matrix.row(1));
  const Eigen::Vector3d b = matrix.row(0).cross(matrix.row(2));
  const Eigen::Vector3d c = matrix.row(1).cross(matrix.row(2));
  const double aa = a.squaredNorm(), bb = b.squaredNorm(), cc = c.squaredNorm();
  if (aa >= bb && aa >= cc) return a / std::sqrt(aa);
  return bb >= cc ? b / std::sqrt(bb) : c / std::sqrt(cc);
}

}  // namespace

SymmetricEigen symmetric_eigen(const Eigen::Matrix3d& matrix) {
  const double scale = matrix.cwiseAbs().maxCoeff();
  if (!(scale > 1e-290)) return {Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()};
  const Eigen::Matrix3d a = matrix * (1.0 / scale);
  const double mean = a.trace() / 3.0;
  Eigen::Matrix3d b = a;
  b.diagonal().array() -= mean;
  const double spread2 = b.squaredNorm() / 6.0;
  if (!(spread2 > 1e-12)) return by_iteration(matrix);
  const double spread = std::sqrt(spread2);
  const double half_determinant = std::clamp(b.determinant() / (2.0 * spread2 * spread), -1.0, 1.0);
  // The eigenvalue that is further from the middle one than the other: the largest where the determinant is
  // positive.
  const double furthest = spread * twice_cosine_of_third(std::abs(half_determinant));
  const double alone = half_determinant >= 0.0 ? furthest : -furthest;
  b.diagonal().array() -= alone;
  const Eigen::Vector3d first = null_vector(b);
  if (!first.allFinite()) return by_iteration(matrix);

  // The others are those of the matrix across it, by one rotation.
  Eigen::Vector3d u = std::abs(first.x()) < 0.6 ? Eigen::Vector3d(0.0, -first.z(), first.y())
                                                : Eigen::Vector3d(first.z(), 0.0, -first.x());
  u.normalize();
  const Eigen::Vector3d w = first.cross(u);
  const Eigen::Vector3d au = a * u, aw = a * w;
  const double uu = u.dot(au), uw = u.dot(aw), ww = w.dot(aw);
  const double half_difference = 0.5 * (uu - ww);
  const double radius = std::sqrt(half_difference * half_difference + uw * uw);
  // (cos, sin) of the larger one's direction; computed without cancellation.
  double cosine = 1.0, sine = 0.0;
  if (radius > 0.0) {
    if (half_difference >= 0.0) {
      cosine = half_difference + radius;
      sine = uw;
    } else {
      cosine = uw;
      sine = radius - half_difference;
    }
    const double per_length = 1.0 / std::sqrt(cosine * cosine + sine * sine);
    cosine *= per_length;
    sine *= per_length;
  }
  const Eigen::Vector3d large = cosine * u + sine * w;
  const Eigen::Vector3d small = cosine * w - sine * u;
  const double middle = 0.5 * (uu + ww);
  SymmetricEigen result;
  const double first_value = first.dot(a * first);
  if (half_determinant >= 0.0) {
    result.values = {middle - radius, middle + radius, first_value};
    result.vectors << small, large, first;
  } else {
    result.values = {first_value, middle - radius, middle + radius};
    result.vectors << first, small, large;
  }
  result.values *= scale;
  return result;
}

}  // namespace ray
