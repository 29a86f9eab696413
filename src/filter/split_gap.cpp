#include "connected_ends.h"
#include "whole_rays.h"

#include <raycloud/core/error.h>

#include <cmath>

namespace ray {

SplitRulePtr split_by_gap(const Context& context, RaySource& source, Metres gap) {
  if (!std::isnormal(gap.value) || !(gap.value > 0.0)) {
    throw Error(ErrorCode::usage, "the gap must be more than 0");
  }
  std::vector<Eigen::Vector3d> ends;
  stream(
      context, source, nullptr,
      [](RayCloud& rays) {
        rays.select(rays.bounded);
        return Nothing{};
      },
      [&](const RayCloud& rays, Nothing) { ends.insert(ends.end(), rays.ends.begin(), rays.ends.end()); });
  const ConnectedCells set = largest_connected_set(context, std::move(ends), gap.value);
  return whole_rays([grid = set.grid, table = CellTable(set.keys)](const RayCloud& rays, std::size_t i) {
    if (rays.bounded[i] == 0) return false;
    const auto key = grid.key(rays.ends[i]);
    return key.has_value() && table.find(*key).has_value();
  });
}

}  // namespace ray
