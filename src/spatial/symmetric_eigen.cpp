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
/// A polynomial is 1e-5 off, a step of Newton takes that to 1e-10. The same on every machine, which no
/// library promises of its cosines.
double twice_cosine_of_third(double c) {
  const double x =
      1.732060864 + c * 0.332823444 + c * c * (-0.091843866 + c * 0.035024377 - c * c * 0.008070797);
  return x - (x * (x * x - 3.0) - 2.0 * c) / (3.0 * (x * x - 1.0));
}

/// Six numbers of a symmetric matrix: in registers, which a matrix that is asked for rows is not.
struct Symmetric {
  double xx, xy, xz, yy, yz, zz;

  [[nodiscard]] Eigen::Vector3d times(const Eigen::Vector3d& v) const {
    return {xx * v.x() + xy * v.y() + xz * v.z(), xy * v.x() + yy * v.y() + yz * v.z(),
            xz * v.x() + yz * v.y() + zz * v.z()};
  }
  [[nodiscard]] Symmetric less(double diagonal) const {
    return {xx - diagonal, xy, xz, yy - diagonal, yz, zz - diagonal};
  }
  [[nodiscard]] double determinant() const {
    return xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  }
  [[nodiscard]] double squared_norm() const {
    return xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + xz * xz + yz * yz);
  }
};

/// The longest of the products of rows, all of which are along the vector that the matrix takes to zero.
Eigen::Vector3d null_vector(const Symmetric& m) {
  const Eigen::Vector3d a(m.xy * m.yz - m.xz * m.yy, m.xz * m.xy - m.xx * m.yz, m.xx * m.yy - m.xy * m.xy);
  const Eigen::Vector3d b(m.xy * m.zz - m.xz * m.yz, m.xz * m.xz - m.xx * m.zz, m.xx * m.yz - m.xy * m.xz);
  const Eigen::Vector3d c(m.yy * m.zz - m.yz * m.yz, m.yz * m.xz - m.xy * m.zz, m.xy * m.yz - m.yy * m.xz);
  const double aa = a.squaredNorm(), bb = b.squaredNorm(), cc = c.squaredNorm();
  const bool is_a = aa >= bb && aa >= cc, is_b = !is_a && bb >= cc;
  const double per_length = 1.0 / std::sqrt(std::max({aa, bb, cc}));
  return (is_a ? a : is_b ? b : c) * per_length;
}

}  // namespace

SymmetricEigen symmetric_eigen(const Eigen::Matrix3d& matrix) {
  const Symmetric a{matrix(0, 0), matrix(1, 0), matrix(2, 0), matrix(1, 1), matrix(2, 1), matrix(2, 2)};
  const double mean = (a.xx + a.yy + a.zz) / 3.0;
  const Symmetric b = a.less(mean);
  const double spread2 = b.squared_norm() / 6.0;
  // Of a ball, or where fourth powers would be no doubles.
  if (!(spread2 > 1e-12 * mean * mean && spread2 > 1e-70 && spread2 < 1e70)) return by_iteration(matrix);
  const double spread = std::sqrt(spread2);
  const double half_determinant = std::clamp(b.determinant() / (2.0 * spread2 * spread), -1.0, 1.0);
  // The eigenvalue that is further from the middle one than the other: the largest where the determinant is
  // positive.
  const double furthest = spread * twice_cosine_of_third(std::abs(half_determinant));
  const Eigen::Vector3d first = null_vector(b.less(half_determinant >= 0.0 ? furthest : -furthest));
  if (!first.allFinite()) return by_iteration(matrix);

  // The others are those of the matrix across it, by one rotation. Of these two axes across it, as long as
  // each other, one has a zero, so that what lies along the axes of space stays there.
  const Eigen::Vector3d u = std::abs(first.x()) < 0.6 ? Eigen::Vector3d(0.0, -first.z(), first.y())
                                                      : Eigen::Vector3d(first.z(), 0.0, -first.x());
  const Eigen::Vector3d w = first.cross(u);
  const double length2 = u.squaredNorm(), per_length2 = 1.0 / length2;
  const Eigen::Vector3d au = a.times(u), aw = a.times(w);
  const double uu = u.dot(au) * per_length2, uw = u.dot(aw) * per_length2, ww = w.dot(aw) * per_length2;
  const double half_difference = 0.5 * (uu - ww);
  const double radius = std::sqrt(half_difference * half_difference + uw * uw);
  // The direction of the larger one, computed without cancellation.
  double along_u = 1.0, along_w = 0.0;
  if (radius > 0.0) {
    const double sum = std::abs(half_difference) + radius;
    along_u = half_difference >= 0.0 ? sum : uw;
    along_w = half_difference >= 0.0 ? uw : sum;
  }
  const double per_length = 1.0 / std::sqrt((along_u * along_u + along_w * along_w) * length2);
  along_u *= per_length, along_w *= per_length;
  const Eigen::Vector3d large = along_u * u + along_w * w;
  const Eigen::Vector3d small = along_u * w - along_w * u;
  const double middle = 0.5 * (uu + ww);
  SymmetricEigen result;
  const double first_value = first.dot(a.times(first));
  if (half_determinant >= 0.0) {
    result.values = {middle - radius, middle + radius, first_value};
    result.vectors << small, large, first;
  } else {
    result.values = {first_value, middle - radius, middle + radius};
    result.vectors << first, small, large;
  }
  return result;
}

}  // namespace ray
