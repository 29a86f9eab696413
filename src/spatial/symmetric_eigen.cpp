#include "eigen_lanes.h"

#include <raycloud/spatial/symmetric_eigen.h>

#include <Eigen/Eigenvalues>

namespace ray {

SymmetricEigen symmetric_eigen(const Eigen::Matrix3d& matrix) {
  const EigenLanes<double> eigen = closed_form_eigen<double>(
      {matrix(0, 0), matrix(1, 0), matrix(2, 0), matrix(1, 1), matrix(2, 1), matrix(2, 2)});
  if (eigen.is_good < 1.0) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
    return {solver.eigenvalues(), solver.eigenvectors()};
  }
  SymmetricEigen result;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    result.values[i] = eigen.values[at];
    result.vectors.col(i) = Eigen::Vector3d(eigen.vectors[at].data());
  }
  return result;
}

}  // namespace ray
