#include "cloud_ellipsoids.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/spatial/surfel.h>

namespace ray {

EllipsoidMaker::EllipsoidMaker(const Context& context, std::vector<SeenPoint>&& points)
    : points_(context, points) {
  points = std::vector<SeenPoint>();
  ellipsoids_ = std::make_unique<EllipsoidTree>(context, points_);
}

std::unique_ptr<EllipsoidTree> EllipsoidMaker::make(const Context& context, double reach, double range_noise,
                                                    OwnHits* hits) {
  parallel_for(context, points_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    NeighbourSearch search(points_);
    const auto all = [](std::size_t) { return true; };
    for_each_ellipsoid(search, begin, end, reach, range_noise, all,
                       [&](std::size_t place, const Ellipsoid& ellipsoid) {
                         const std::uint32_t i = points_.index(place);
                         ellipsoids_->set(i, ellipsoid);
                         if (hits == nullptr) return;
                         const std::uint32_t slot = ellipsoids_->slot(i);
                         hits->find(search, place, ellipsoids_->at_slot(slot), slot);
                       });
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
  noise.add(context, maker.points());
  CloudEllipsoids cloud;
  cloud.range_noise = noise.value();
  cloud.tree = maker.make(context, ends.reach, cloud.range_noise);
  return cloud;
}

}  // namespace ray
