#include <raycloud/core/bend.h>

namespace ray {

void bend_rays(const Bend& bend, RayCloud& rays) {
  if (bend.is_none()) return;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Vector3d shift = bend.shift_at(rays.bounded[i] != 0 ? rays.ends[i] : rays.starts[i]);
    rays.starts[i] += shift;
    rays.ends[i] += shift;
  }
}

}  // namespace ray
