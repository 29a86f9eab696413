#include "free_space_below.h"

#include <raycloud/exec/parallel.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace ray {
namespace {

constexpr std::uint32_t kLeastEndsOfLevel = 2;
constexpr std::uint32_t kLeastRays = 2;
constexpr int kLeastNeighbours = 3;
constexpr double kLastWay = 48.0;  // cells

/// Of the chosen levels; far below everything where there is none.
std::vector<float> heights_of_chosen(const Context& context, const LowestEnds& cells,
                                     const std::vector<std::uint8_t>& chosen, double base) {
  std::vector<float> heights(chosen.size(), -std::numeric_limits<float>::infinity());
  parallel_for(context, chosen.size(), 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell)
      if (chosen[cell] != kNoLevel)
        heights[cell] = static_cast<float>(cells.place(cell, chosen[cell]).z() - base);
  });
  return heights;
}

}  // namespace

std::vector<std::uint8_t> sites_over_free_space(const Context& context, const LowestEnds& cells,
                                                const std::vector<std::uint8_t>& chosen, double margin) {
  std::vector<std::uint8_t> refuted(chosen.size(), 0);
  const auto first =
      std::find_if(chosen.begin(), chosen.end(), [](std::uint8_t level) { return level != kNoLevel; });
  if (first == chosen.end()) return refuted;
  const double base = cells.place(static_cast<std::size_t>(first - chosen.begin()), *first).z();
  const std::vector<float> heights = heights_of_chosen(context, cells, chosen, base);
  const PlanRaster& raster = cells.raster();
  std::vector<std::uint32_t> rays_below(chosen.size(), 0);
  parallel_for(context, chosen.size(), 2048, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      if (chosen[cell] == kNoLevel) continue;
      const LowLevel& level = cells.levels(cell)[chosen[cell]];
      if (level.count < kLeastEndsOfLevel) continue;
      const Eigen::Vector3d to_sensor(level.to_sensor[0], level.to_sensor[1], level.to_sensor[2]);
      const double way = to_sensor.head<2>().norm() / raster.width;
      if (!(way >= 1.0)) continue;
      Eigen::Vector3d on_ray = cells.place(cell, chosen[cell]) + Eigen::Vector3d(0.0, 0.0, margin - base);
      for (auto steps = static_cast<int>(std::min(way, kLastWay)); steps > 0; --steps) {
        on_ray += to_sensor / way;
        const auto near = raster.find(on_ray.x(), on_ray.y());
        if (!near) break;
        if (static_cast<double>(heights[*near]) > on_ray.z())
          std::atomic_ref(rays_below[*near]).fetch_add(1, std::memory_order_relaxed);
      }
    }
  });
  parallel_for(context, chosen.size(), 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      if (chosen[cell] == kNoLevel) continue;
      int like_it = 0;
      raster.around(cell, [&](std::size_t near) {
        const bool is_as_high = std::abs(heights[near] - heights[cell]) < static_cast<float>(margin);
        like_it += rays_below[near] >= kLeastRays && is_as_high ? 1 : 0;
      });
      refuted[cell] = rays_below[cell] >= kLeastRays || like_it >= kLeastNeighbours ? 1 : 0;
    }
  });
  return refuted;
}

}  // namespace ray
