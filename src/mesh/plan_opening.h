#pragma once
/// Openings of mathematical morphology of heights over a raster: what is narrower than the window goes.

#include "plan_raster.h"

#include <raycloud/exec/context.h>

#include <vector>

namespace ray {

/// The lowest height within `radius` cells (a square), and of these the highest within as many: nowhere above
/// `heights`, equal to it on planes, and level where something narrower than the window stood. Infinite
/// heights are cells without one: they neither lower nor lift their neighbours. O(cells log radius).
[[nodiscard]] std::vector<float> plan_opening(const Context& context, std::vector<float> heights,
                                              const PlanRaster& raster, std::int64_t radius);

}  // namespace ray
