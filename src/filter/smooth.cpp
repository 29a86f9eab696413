#include "surface_points.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/filter/smooth.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ray {
namespace {

/// The plane around a point: through point + height · normal.
struct LocalPlane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // zero: there is none
  float height = 0.0F;                               // m
  float spread2 = 0.0F;  // m², variance of its points along it, both ways together
  float reach = 0.0F;    // m, of its neighbours
};

LocalPlane plane_of(const PointTree& tree, std::size_t place, const Surfel& surfel) {
  if (!surfel.is_surface()) return {};
  const double height = surfel.normal.dot(surfel.centroid - tree.point(place));
  return {
      surfel.normal.cast<float>(), static_cast<float>(height),
      static_cast<float>(surfel.variances[1] + surfel.variances[2]),
      std::nextafter(static_cast<float>(std::sqrt(surfel.reach2)), std::numeric_limits<float>::infinity())};
}

/// The surface near a point, seen from the plane through it across its normal.
struct LocalSurface {
  float height = 0.0F;     // m, along the normal, as if it were flat
  float curvature = 0.0F;  // 1/m, the mean of both
  float lever = 0.0F;      // m², by which curvature makes that height wrong
};

/// From the planes of the neighbours, seen as a sample of a surface and its slopes. Their mean height is the
/// height of the surface but for its curvature, which pulls it towards the hollow side twice: the points of
/// each plane lie on a curved surface, and so do the planes. The curvature is how much their slopes change
/// from place to place.
class SurfaceFit {
 public:
  SurfaceFit(const PointTree& tree, std::span<const LocalPlane> planes) : tree_(tree), planes_(planes) {}

  [[nodiscard]] LocalSurface at(std::size_t place, std::span<const Neighbour> neighbours) {
    take(place, neighbours);
    if (!(weight_ > 0.0)) return {};
    const Eigen::Vector3d offset = sum_offset_ / weight_;
    const Eigen::Vector3d slope = sum_slope_ / weight_;
    double change = 0.0, extent2 = 0.0;
    for (const Sample& sample : samples_) {
      change += sample.weight * (sample.slope - slope).dot(sample.offset - offset);
      extent2 += sample.weight * (sample.offset - offset).squaredNorm();
    }
    const double height = sum_height_ / weight_ - slope.dot(offset);
    if (!(extent2 > 0.0)) return {static_cast<float>(height), 0.0F, 0.0F};
    const double lever = 0.5 * ((sum_spread2_ + extent2) / weight_ - offset.squaredNorm());
    return {static_cast<float>(height), static_cast<float>(change / extent2), static_cast<float>(lever)};
  }

  /// The height of the surface at a point, by the heights at its neighbours. A curvature from 17 planes is
  /// still too noisy, so it is averaged over them, and trusted as far as it is more than their disagreement.
  [[nodiscard]] double height(std::size_t place, std::span<const Neighbour> neighbours,
                              std::span<const LocalSurface> surfaces) {
    sort(place, neighbours);
    const Eigen::Vector3d point = tree_.point(place);
    const Eigen::Vector3d up = planes_[place].normal.cast<double>();
    double weight = 0.0, height = 0.0, lever = 0.0, curvature = 0.0, curvature2 = 0.0;
    Eigen::Vector3d offset = Eigen::Vector3d::Zero(), slope = Eigen::Vector3d::Zero();
    for (const std::uint64_t entry : order_) {
      const std::size_t other = entry & 0xffffffff;
      const Eigen::Vector3d normal = planes_[other].normal.cast<double>();
      const double alike = normal.dot(up);
      if (!(alike > kLeastAlike)) continue;
      const LocalSurface& surface = surfaces[other];
      const double w = alike * alike * alike * alike;
      const Eigen::Vector3d away = tree_.point(other) + static_cast<double>(surface.height) * normal - point;
      const double up_there = away.dot(up);
      const Eigen::Vector3d across = away - up_there * up;
      weight += w;
      height += w * up_there;
      offset += w * across;
      slope += w * (up - normal / alike);
      lever += w * (static_cast<double>(surface.lever) + 0.5 * across.squaredNorm());
      curvature += w * static_cast<double>(surface.curvature);
      curvature2 += w * static_cast<double>(surface.curvature) * static_cast<double>(surface.curvature);
    }
    if (!(weight > 0.0)) return 0.0;
    offset /= weight;
    const double mean = curvature / weight;
    const double doubt2 = kCaution * std::max(curvature2 / weight - mean * mean, 0.0) / weight;
    const double sure2 = mean * mean * mean * mean;
    const double trust = sure2 > 0.0 ? sure2 / (sure2 + doubt2 * doubt2) : 0.0;
    return height / weight - slope.dot(offset) / weight -
           trust * mean * (lever / weight - offset.squaredNorm());
  }

 private:
  struct Sample {
    double weight;
    Eigen::Vector3d offset;  // from the point, across its normal
    Eigen::Vector3d slope;
  };

  /// In the order of the rays, whatever that of the tree is.
  void sort(std::size_t place, std::span<const Neighbour> neighbours) {
    order_.clear();
    order_.push_back(std::uint64_t{tree_.index(place)} << 32 | place);
    for (const Neighbour& neighbour : neighbours)
      order_.push_back(std::uint64_t{tree_.index(neighbour.place)} << 32 | neighbour.place);
    std::sort(order_.begin(), order_.end());
  }

  void take(std::size_t place, std::span<const Neighbour> neighbours) {
    sort(place, neighbours);
    samples_.clear();
    weight_ = sum_height_ = sum_spread2_ = 0.0;
    sum_offset_.setZero();
    sum_slope_.setZero();
    const Eigen::Vector3d point = tree_.point(place);
    const Eigen::Vector3d up = planes_[place].normal.cast<double>();
    for (const std::uint64_t entry : order_) {
      const std::size_t other = entry & 0xffffffff;
      const LocalPlane& plane = planes_[other];
      const Eigen::Vector3d normal = plane.normal.cast<double>();
      const double alike = normal.dot(up);
      if (!(alike > kLeastAlike)) continue;
      const double weight = alike * alike * alike * alike;
      const Eigen::Vector3d away = tree_.point(other) + static_cast<double>(plane.height) * normal - point;
      const double height = away.dot(up);
      samples_.push_back({weight, away - height * up, up - normal / alike});
      weight_ += weight;
      sum_height_ += weight * height;
      sum_spread2_ += weight * static_cast<double>(plane.spread2);
      sum_offset_ += weight * samples_.back().offset;
      sum_slope_ += weight * samples_.back().slope;
    }
  }

  // The curvatures of neighbours come from much the same planes, and their mean is less sure than it looks.
  static constexpr double kCaution = 14.0;
  static constexpr double kLeastAlike = 0.3;  // cosine between normals of one surface

  const PointTree& tree_;
  std::span<const LocalPlane> planes_;
  std::vector<std::uint64_t> order_;  // index and place of the point and its neighbours
  std::vector<Sample> samples_;
  double weight_ = 0.0, sum_height_ = 0.0, sum_spread2_ = 0.0;
  Eigen::Vector3d sum_offset_, sum_slope_;
};

using Move = Eigen::Vector3f;  // m

std::span<const Neighbour> neighbours_of(NeighbourSearch& search, std::size_t place,
                                         const LocalPlane& plane) {
  return search.nearest_facing(place, kSurfaceNeighbours, plane.reach, plane.normal.cast<double>());
}

/// By the plane's height: along the ray where that is not too much aslant, else along the normal.
Move move_of(const LocalPlane& plane, const PackedDirection& to_sensor) {
  constexpr double kFacing = 0.3;  // cosine from which on the ray is better than the normal
  if (plane.normal.isZero()) return Move::Zero();
  const Eigen::Vector3d normal = plane.normal.cast<double>();
  const Eigen::Vector3d ray = unpack_direction(to_sensor).normalized();
  const double facing = ray.dot(normal);
  const bool along_ray = facing > kFacing;
  const double height = plane.height, most = plane.reach;
  const double distance = std::clamp(along_ray ? height / facing : height, -most, most);
  return (distance * (along_ray ? ray : normal)).cast<float>();
}

std::vector<Move> smooth_block(const Context& context, Block<SeenPoint>&& block, double reach) {
  const PointTree tree(context, block.records);
  block.records = std::vector<SeenPoint>();
  std::vector<LocalPlane> planes(tree.size());
  for_each_place(context, tree, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
    for (std::size_t place = begin; place < end; ++place)
      planes[place] =
          plane_of(tree, place, surfel_at(search, place, {kSurfaceNeighbours, reach / 3.0, true}));
  });
  std::vector<LocalSurface> surfaces(tree.size());
  for_each_place(context, tree, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
    SurfaceFit fit(tree, planes);
    for (std::size_t place = begin; place < end; ++place) {
      if (planes[place].normal.isZero()) continue;
      surfaces[place] = fit.at(place, neighbours_of(search, place, planes[place]));
    }
  });
  // Only the normals of other planes matter from here on: the distance to the surface takes the place of the
  // height.
  for_each_place(context, tree, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
    SurfaceFit fit(tree, planes);
    for (std::size_t place = begin; place < end; ++place) {
      LocalPlane& plane = planes[place];
      if (!block.is_own(tree.index(place)) || plane.normal.isZero()) continue;
      plane.height = static_cast<float>(fit.height(place, neighbours_of(search, place, plane), surfaces));
    }
  });
  surfaces = std::vector<LocalSurface>();
  std::vector<Move> moves(tree.size(), Move::Zero());
  parallel_for(context, tree.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t place = begin; place < end; ++place)
      moves[tree.index(place)] = move_of(planes[place], tree.to_sensor(place));
  });
  return moves;
}

}  // namespace

StreamCounts smooth_rays(const Context& context, RaySource& source, RaySink& sink) {
  // The surface at a point depends on the curvature at its neighbours, which depends on the planes of theirs.
  const BlockNeeds needs{.bytes_per_record = 90,
                         .reach = [](const EndSample& sample) { return 3.0 * neighbour_reach(sample); }};
  return run_blocks<SeenPoint, Move>(context, source, sink, needs, seen_point, smooth_block,
                                     [](RayCloud& rays, std::span<const Move> moves) {
                                       std::size_t next = 0;
                                       for (std::size_t i = 0; i < rays.size(); ++i)
                                         if (rays.bounded[i] != 0)
                                           rays.ends[i] += moves[next++].cast<double>();
                                     });
}

}  // namespace ray
