#include "surfel_queue.h"

#include "eigen_lanes.h"

#include <raycloud/core/lanes.h>
#include <raycloud/spatial/symmetric_eigen.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>

namespace ray {
namespace {

using FourDoubles [[gnu::vector_size(4 * sizeof(double))]] = double;
#ifdef RAY_HAS_LANES
using EightDoubles [[gnu::vector_size(8 * sizeof(double))]] = double;
#endif

/// Of so many points, those that were not added being where the point is.
template <class Value>
struct MomentLanes {
  Value count, scale;
  std::array<Value, 3> sum;
  std::array<Value, 6> products;
};
template <class Value>
struct SurfelLanes {
  std::array<Value, 3> mean;
  SymmetricLanes<Value> covariance;
  EigenLanes<Value> eigen;
};

template <class Value>
[[gnu::always_inline]] inline void make_lanes(const MomentLanes<Value>& in, SurfelLanes<Value>& out) {
  const auto& [x, y, z] = in.sum;
  const Value per_count = 1.0 / in.count, per_scale = 1.0 / in.scale;
  const Value per_mean = per_count * per_scale, per_squared = per_mean * per_scale;
  out.mean = {x * per_mean, y * per_mean, z * per_mean};
  out.covariance = {
      (in.products[0] - x * x * per_count) * per_squared, (in.products[1] - x * y * per_count) * per_squared,
      (in.products[2] - x * z * per_count) * per_squared, (in.products[3] - y * y * per_count) * per_squared,
      (in.products[4] - y * z * per_count) * per_squared, (in.products[5] - z * z * per_count) * per_squared};
  out.eigen = closed_form_eigen(out.covariance);
}

template <class Value>
void make_plain(const MomentLanes<Value>& in, SurfelLanes<Value>& out) {
  make_lanes(in, out);
}
#ifdef RAY_HAS_LANES
RAY_AVX2 void make_avx2(const MomentLanes<FourDoubles>& in, SurfelLanes<FourDoubles>& out) {
  make_lanes(in, out);
}
RAY_AVX512 void make_avx512(const MomentLanes<EightDoubles>& in, SurfelLanes<EightDoubles>& out) {
  make_lanes(in, out);
}
void make_fast(const MomentLanes<EightDoubles>& in, SurfelLanes<EightDoubles>& out) {
  make_avx512(in, out);
}
#endif
void make_fast(const MomentLanes<FourDoubles>& in, SurfelLanes<FourDoubles>& out) {
#ifdef RAY_HAS_LANES
  if (lanes_in_use != LaneSet::kPlain) return make_avx2(in, out);
#endif
  make_plain(in, out);
}

/// Of one of the lanes, by iteration if there is no other way.
template <class Value>
SymmetricEigen eigen_of(const SurfelLanes<Value>& lanes, std::size_t lane) {
  if (lanes.eigen.is_good[lane] < 1.0) {
    const SymmetricLanes<Value>& m = lanes.covariance;
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

template <class Value>
void SurfelQueue::make_some(std::span<const Waiting> some) {
  constexpr std::size_t kLanes = sizeof(Value) / sizeof(double);
  MomentLanes<Value> in;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const Waiting& waiting = some[std::min(lane, some.size() - 1)];
    in.count[lane] = waiting.surfel->count;
    in.scale[lane] = waiting.moments.scale;
    for (std::size_t i = 0; i < 3; ++i)
      in.sum[i][lane] = waiting.moments.sum[i];
    for (std::size_t i = 0; i < 6; ++i)
      in.products[i][lane] = waiting.moments.products[i];
  }
  SurfelLanes<Value> out;
  make_fast(in, out);
  for (std::size_t lane = 0; lane < some.size(); ++lane) {
    Surfel& surfel = *some[lane].surfel;
    const SymmetricEigen eigen = eigen_of(out, lane);
    surfel.centroid += Eigen::Vector3d(out.mean[0][lane], out.mean[1][lane], out.mean[2][lane]);
    surfel.variances = eigen.values.cwiseMax(0.0);
    surfel.normal = eigen.vectors.col(0);
    surfel.axis = eigen.vectors.col(2);
    finish(surfel, some[lane].to_sensor);
  }
}

void SurfelQueue::make() {
  constexpr std::size_t kFour = 4, kEight = 8;
  std::size_t first = 0;
  const auto next = [&](std::size_t lanes) {
    const std::size_t size = std::min(count_ - first, lanes);
    const std::span some(waiting_.data() + first, size);
    first += size;
    return some;
  };
#ifdef RAY_HAS_LANES
  while (lanes_in_use == LaneSet::kAvx512 && count_ - first > kFour)
    make_some<EightDoubles>(next(kEight));
#endif
  while (first < count_)
    make_some<FourDoubles>(next(kFour));
  count_ = 0;
}

void SurfelQueue::finish(Surfel& surfel, const Eigen::Vector3d& to_sensor) {
  if (!surfel.is_surface() && to_sensor.squaredNorm() > 0.0) surfel.normal = to_sensor.normalized();
  if (surfel.normal.dot(to_sensor) < 0.0) surfel.normal = -surfel.normal;
}

}  // namespace ray
