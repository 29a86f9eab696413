#include "cloud_ellipsoids.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/spatial/surfel.h>

#include <vector>

namespace bench {

ray::EllipsoidTree ellipsoids_of(const ray::Context& context, const ray::RayCloud& rays,
                                 const EllipsoidNeighbours& neighbours) {
  std::vector<ray::SeenPoint> points;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (rays.bounded[i] != 0)
      points.push_back({rays.ends[i], ray::pack_direction(rays.starts[i] - rays.ends[i])});
  ray::EllipsoidTree tree(context, points.size(), [&](std::size_t i) { return points[i].end; });
  const ray::PointTree near(context, points);
  ray::parallel_for(context, near.size(), 4096, [&](std::size_t begin, std::size_t end) {
    ray::NeighbourSearch search(near);
    ray::SurfelFinder finder(search, {.by_side = neighbours.by_side});
    finder.for_each(begin, end, [&](const ray::SurfelOf& found) {
      const std::uint32_t i = near.index(found.place);
      tree.set(i, ray::ellipsoid_of(found.surfel, points[i].end, ray::unpack_direction(points[i].to_sensor),
                                    neighbours.range_noise));
    });
  });
  tree.close(context);
  return tree;
}

}  // namespace bench
