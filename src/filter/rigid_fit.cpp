#include "rigid_fit.h"

#include <raycloud/exec/parallel.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace ray {
namespace {

/// Adds up `Sum::see(p, q)` over every point and where it went.
template <class Sum>
Sum sum_points(const Context& context, const Lines& from, const Lines& to, std::span<const RowPair> pairs,
               const Sum& zero) {
  constexpr std::size_t kGrain = 1 << 15;
  return parallel_reduce(
      context, pairs.size(), kGrain, zero,
      [&](std::size_t begin, std::size_t end) {
        Sum sum = zero;
        for (const RowPair& pair : pairs.subspan(begin, end - begin)) {
          sum.see(from.starts[pair.from], to.starts[pair.to]);
          sum.see(from.ends[pair.from], to.ends[pair.to]);
        }
        return sum;
      },
      [](Sum a, const Sum& b) {
        a.add(b);
        return a;
      });
}

/// Of points relative to one near them, which keeps digits.
struct Means {
  Eigen::Vector3d near;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d move = Eigen::Vector3d::Zero();
  void see(const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    point += p - near;
    move += q - p;
  }
  void add(const Means& other) {
    point += other.point;
    move += other.move;
  }
};

struct Covariance {
  Eigen::Vector3d centre_p;
  Eigen::Vector3d centre_q;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  void see(const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    sum += (p - centre_p) * (q - centre_q).transpose();
  }
  void add(const Covariance& other) { sum += other.sum; }
};

struct Misses {
  Pose pose;
  double missed = 0.0, missed_most = 0.0, moved = 0.0, moved_most = 0.0;  // squared
  void see(const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    const double miss = (q - pose * p).squaredNorm(), move = (q - p).squaredNorm();
    missed += miss;
    moved += move;
    missed_most = std::max(missed_most, miss);
    moved_most = std::max(moved_most, move);
  }
  void add(const Misses& other) {
    missed += other.missed;
    moved += other.moved;
    missed_most = std::max(missed_most, other.missed_most);
    moved_most = std::max(moved_most, other.moved_most);
  }
  [[nodiscard]] RigidFit fit(double points) const {
    return {pose, std::sqrt(missed / points), std::sqrt(missed_most), std::sqrt(moved / points),
            std::sqrt(moved_most)};
  }
};

Eigen::Matrix3d best_rotation(const Eigen::Matrix3d& covariance, double points) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d size = svd.singularValues();
  constexpr double kPoint = 1e-7;  // m; closer together than this is one place
  constexpr double kLine = 1e-8;   // a ten-thousandth as thick as long is a line
  if (size[0] <= kPoint * kPoint * points) return Eigen::Matrix3d::Identity();
  if (size[1] <= kLine * size[0]) {
    return Eigen::Quaterniond::FromTwoVectors(svd.matrixU().col(0), svd.matrixV().col(0)).toRotationMatrix();
  }
  const double turn = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return svd.matrixV() * Eigen::Vector3d(1.0, 1.0, turn).asDiagonal() * svd.matrixU().transpose();
}

}  // namespace

RigidFit fit_rigid(const Context& context, const Lines& from, const Lines& to,
                   std::span<const RowPair> pairs) {
  if (pairs.empty()) return {};
  const double points = 2.0 * static_cast<double>(pairs.size());
  const Means means = sum_points(context, from, to, pairs, Means{from.ends[pairs[0].from]});
  const Eigen::Vector3d move = means.move / points;
  const Eigen::Vector3d centre = means.near + means.point / points;
  const Covariance covariance = sum_points(context, from, to, pairs, Covariance{centre, centre + move});
  Pose pose;
  pose.rotation = best_rotation(covariance.sum, points);
  pose.translation = centre + move - pose.rotation * centre;
  const auto judge = [&](const Pose& candidate) {
    return sum_points(context, from, to, pairs, Misses{candidate}).fit(points);
  };
  const RigidFit motion = judge(pose), translation = judge(translation_pose(move));
  constexpr double kNoise = 1e-9;  // m
  return translation.worst <= std::max(2.0 * motion.worst, kNoise) ? translation : motion;
}

}  // namespace ray
