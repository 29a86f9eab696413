#include "cloud_ellipsoids.h"

#include "mix_bits.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/spatial/surfel.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>

namespace ray {
namespace {

bool is_in_sample(const Eigen::Vector3d& point, std::uint64_t stride) {
  std::uint64_t hash = 0;
  for (const double coordinate : {point.x(), point.y(), point.z()})
    hash = mix_bits(hash + std::bit_cast<std::uint64_t>(coordinate));
  return hash % stride == 0;
}

}  // namespace

Ellipsoid ellipsoid_at(NeighbourSearch& search, const PointTree& points, std::size_t place, double reach,
                       double range_noise) {
  return ellipsoid_of(surfel_at(search, place, ellipsoid_rule(reach)), points.point(place),
                      unpack_direction(points.to_sensor(place)), range_noise);
}

void RangeNoise::add(const Context& context, const PointTree& tree, std::span<const std::uint8_t> own) {
  constexpr double kFlat = 0.1;
  constexpr std::uint64_t kSample = 4096;
  const std::uint64_t stride = bounded_ / kSample + 1;
  const SurfelRule rule = ellipsoid_rule(reach_);
  std::mutex mutex;
  parallel_for(context, tree.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    NeighbourSearch search(tree);
    std::vector<double> found;
    for (std::size_t place = begin; place < end; ++place) {
      if (!own.empty() && own[tree.index(place)] == 0) continue;
      if (!is_in_sample(tree.point(place), stride)) continue;
      const Surfel surfel = surfel_at(search, place, rule);
      if (surfel.count <= rule.neighbours / 2 || surfel.variances[0] > kFlat * surfel.variances[1]) continue;
      const double count = surfel.count;
      found.push_back(std::sqrt(surfel.variances[0] * count / (count - 3.0)));
    }
    const std::lock_guard lock(mutex);
    scatter_.insert(scatter_.end(), found.begin(), found.end());
  });
}

double RangeNoise::value() const {
  constexpr double kUsual = 0.015, kLeast = 0.002, kMost = 0.1;  // m
  if (scatter_.empty()) return kUsual;
  std::vector<double> scatter = scatter_;
  const auto middle = scatter.begin() + static_cast<std::ptrdiff_t>(scatter.size() / 2);
  std::nth_element(scatter.begin(), middle, scatter.end());
  return std::clamp(*middle, kLeast, kMost);
}

EllipsoidMaker::EllipsoidMaker(const Context& context, std::vector<SeenPoint>&& points)
    : ellipsoids_(std::make_unique<EllipsoidTree>(context, points.size(),
                                                  [&](std::size_t i) { return points[i].end; })),
      points_(context, points) {
  points = std::vector<SeenPoint>();
}

std::unique_ptr<EllipsoidTree> EllipsoidMaker::make(const Context& context, double reach,
                                                    double range_noise) {
  parallel_for(context, points_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    NeighbourSearch search(points_);
    for (std::size_t place = begin; place < end; ++place)
      ellipsoids_->set(points_.index(place), ellipsoid_at(search, points_, place, reach, range_noise));
  });
  ellipsoids_->close(context);
  return std::move(ellipsoids_);
}

CloudEllipsoids cloud_ellipsoids(const Context& context, RaySource& source) {
  return cloud_ellipsoids(context, read_ends(context, source, ~std::size_t{0}));
}

CloudEllipsoids cloud_ellipsoids(const Context& context, ReadEnds&& ends) {
  EllipsoidMaker maker(context, std::move(ends.points));
  RangeNoise noise(ends.sample.bounded, ends.reach);
  noise.add(context, maker.points(), {});
  CloudEllipsoids cloud;
  cloud.range_noise = noise.value();
  cloud.tree = maker.make(context, ends.reach, cloud.range_noise);
  return cloud;
}

}  // namespace ray
