#include "surface_points.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/spatial/point_spacing.h>

#include <cmath>
#include <limits>

namespace ray {

double neighbour_reach(const EndSample& sample) {
  // 16 neighbours on a surface are within 2.3 spacings.
  constexpr std::size_t kFew = 8;  // have no spacing
  if (sample.ends.size() < kFew) return std::numeric_limits<double>::infinity();
  const double spacing = estimate_spacing(sample.ends, sample.bounded).value;
  return kReachSpacings * spacing;
}

void for_each_place(const Context& context, const PointTree& tree,
                    const std::function<void(NeighbourSearch&, std::size_t begin, std::size_t end)>& work) {
  constexpr std::size_t kPlaces = 4096;
  parallel_for(context, tree.size(), kPlaces, [&](std::size_t begin, std::size_t end) {
    NeighbourSearch search(tree);
    work(search, begin, end);
  });
}

}  // namespace ray
