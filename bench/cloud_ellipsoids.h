#pragma once
// The ellipsoids around the ends of a cloud in memory, made as the commands make them, but for the noise.

#include <raycloud/core/ray_cloud.h>
#include <raycloud/exec/context.h>
#include <raycloud/volume/ellipsoid_tree.h>

namespace bench {

struct EllipsoidNeighbours {
  bool by_side = false;        // leave out those seen from the other side
  double range_noise = 0.015;  // m
};

// One for each bounded ray, in order; closed.
ray::EllipsoidTree ellipsoids_of(const ray::Context& context, const ray::RayCloud& rays,
                                 const EllipsoidNeighbours& neighbours);

}  // namespace bench
