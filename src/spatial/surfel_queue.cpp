#include "surfel_queue.h"

#include "eigen_lanes.h"

#include <raycloud/spatial/symmetric_eigen.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>

namespace ray {
namespace {

constexpr std::size_t kSurfelLanes = 4;
using SurfelLanes [[gnu::vector_size(kSurfelLanes * sizeof(double))]] = double;

/// Of so many points, those that were not added being where the point is.
struct MomentLanes {
  SurfelLanes count, scale;
  std::array<SurfelLanes, 3> sum;
  std::array<SurfelLanes, 6> products;
};
struct SurfelLanesOut {
  std::array<SurfelLanes, 3> mean;
  SymmetricLanes<SurfelLanes> covariance;
  EigenLanes<SurfelLanes> eigen;
};

[[gnu::always_inline]] inline void make_lanes(const MomentLanes& in, SurfelLanesOut& out) {
  const auto& [x, y, z] = in.sum;
  const SurfelLanes per_mean = in.count * in.scale, squared = in.count * in.scale * in.scale;
  out.mean = {x / per_mean, y / per_mean, z / per_mean};
  out.covariance = {
      (in.products[0] - x * x / in.count) / squared, (in.products[1] - x * y / in.count) / squared,
      (in.products[2] - x * z / in.count) / squared, (in.products[3] - y * y / in.count) / squared,
      (in.products[4] - y * z / in.count) / squared, (in.products[5] - z * z / in.count) / squared};
  out.eigen = closed_form_eigen(out.covariance);
}
void make_plain(const MomentLanes& in, SurfelLanesOut& out) {
  make_lanes(in, out);
}
#ifdef __x86_64__
[[gnu::target("avx2")]] void make_avx2(const MomentLanes& in, SurfelLanesOut& out) {
  make_lanes(in, out);
}
const auto make_fast = __builtin_cpu_supports("avx2") ? make_avx2 : make_plain;
#else
constexpr auto make_fast = make_plain;
#endif

/// Of one of the lanes, by iteration if there is no other way.
SymmetricEigen eigen_of(const SurfelLanesOut& lanes, std::size_t lane) {
  if (lanes.eigen.is_good[lane] < 1.0) {
    const SymmetricLanes<SurfelLanes>& m = lanes.covariance;
    Eigen::Matrix3d matrix;
    matrix << m.xx[lane], m.xy[lane], m.xz[lane], m.xy[lane], m.yy[lane], m.yz[lane], m.xz[lane], m.yz[lane],
        m.zz[lane];
    return symmetric_eigen(matrix);
  }
  SymmetricEigen eigen;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    eigen.values[at] = lanes.eigen.values[i][lane];
    for (std::size_t axis = 0; axis < 3; ++axis)
      eigen.vectors(static_cast<Eigen::Index>(axis), at) = lanes.eigen.vectors[i][axis][lane];
  }
  return eigen;
}

}  // namespace

void SurfelQueue::add(const Neighbourhood& around, Neighbourhood::Some some, Surfel& surfel) {
  assert(count_ < kMost);
  surfel = {};
  surfel.count = static_cast<std::uint32_t>(std::popcount(some) + 1);
  surfel.centroid = tree_.point(around.place());
  Waiting& waiting = waiting_[count_];
  waiting.to_sensor = unpack_direction(tree_.to_sensor(around.place()));
  waiting.moments = around.moments(some);
  waiting.surfel = &surfel;
  surfel.reach2 = waiting.moments.furthest2;
  if (surfel.reach2 > 0.0)
    ++count_;
  else
    finish(surfel, waiting.to_sensor);
}

void SurfelQueue::make() {
  for (std::size_t first = 0; first < count_; first += kSurfelLanes) {
    const std::size_t lanes = std::min(count_ - first, kSurfelLanes);
    MomentLanes in;
    for (std::size_t lane = 0; lane < kSurfelLanes; ++lane) {
      const Waiting& waiting = waiting_[first + std::min(lane, lanes - 1)];
      in.count[lane] = waiting.surfel->count;
      in.scale[lane] = waiting.moments.scale;
      for (std::size_t i = 0; i < 3; ++i)
        in.sum[i][lane] = waiting.moments.sum[i];
      for (std::size_t i = 0; i < 6; ++i)
        in.products[i][lane] = waiting.moments.products[i];
    }
    SurfelLanesOut out;
    make_fast(in, out);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const Waiting& waiting = waiting_[first + lane];
      Surfel& surfel = *waiting.surfel;
      const SymmetricEigen eigen = eigen_of(out, lane);
      surfel.centroid += Eigen::Vector3d(out.mean[0][lane], out.mean[1][lane], out.mean[2][lane]);
      surfel.variances = eigen.values.cwiseMax(0.0);
      surfel.normal = eigen.vectors.col(0);
      surfel.axis = eigen.vectors.col(2);
      finish(surfel, waiting.to_sensor);
    }
  }
  count_ = 0;
}

void SurfelQueue::finish(Surfel& surfel, const Eigen::Vector3d& to_sensor) {
  if (!surfel.is_surface() && to_sensor.squaredNorm() > 0.0) surfel.normal = to_sensor.normalized();
  if (surfel.normal.dot(to_sensor) < 0.0) surfel.normal = -surfel.normal;
}

}  // namespace ray
