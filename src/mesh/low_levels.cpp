#include "low_levels.h"

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

struct LowEnd {
  std::uint32_t cell = 0;
  std::int32_t level = 0;
  std::array<float, 3> at;
  std::array<float, 3> to_sensor;
};

void add(LowLevels& levels, const LowEnd& end) {
  std::size_t i = 0;
  while (i < kLowLevels && levels[i].number < end.level)
    ++i;
  if (i == kLowLevels) return;
  if (levels[i].number != end.level) {
    std::move_backward(levels.begin() + static_cast<std::ptrdiff_t>(i), levels.end() - 1, levels.end());
    levels[i] = {end.level, 0, {}, {}};
  }
  if (levels[i].count++ > 0 && !(end.at[2] < levels[i].lowest[2])) return;
  levels[i].lowest = end.at;
  levels[i].to_sensor = end.to_sensor;
}

std::vector<LowEnd> low_ends(const RayCloud& rays, const PlanRaster& raster, double level_height) {
  std::vector<LowEnd> ends;
  ends.reserve(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays.bounded[i] == 0) continue;
    const Eigen::Vector3d& end = rays.ends[i];
    const auto cell = raster.find(end.x(), end.y());
    const double level = std::floor(end.z() / level_height);
    if (!cell || std::abs(level) > 1e9) continue;
    const Eigen::Vector2d corner = raster.centre(*cell).array() - 0.5 * raster.width;
    const Eigen::Vector3f to_sensor = (rays.starts[i] - end).cast<float>();
    ends.push_back({static_cast<std::uint32_t>(*cell),
                    static_cast<std::int32_t>(level),
                    {static_cast<float>(end.x() - corner.x()), static_cast<float>(end.y() - corner.y()),
                     static_cast<float>(end.z() - level * level_height)},
                    {to_sensor.x(), to_sensor.y(), to_sensor.z()}});
  }
  return ends;
}

}  // namespace

LowLevels& LowestEnds::made(std::size_t cell) {
  std::uint32_t& number = numbers_[cell];
  if (counts_[cell] == 0) {
    if (occupied_ % kBlock == 0) blocks_.push_back(std::make_unique<LowLevels[]>(kBlock));
    number = occupied_++;
  }
  return blocks_[number / kBlock][number % kBlock];
}

LowestEnds::LowestEnds(const Context& context, RaySource& source, const PlanRaster& raster)
    : raster_(raster), counts_(raster.size(), 0), numbers_(raster.size(), 0) {
  stream(
      context, source, nullptr, [&](RayCloud& rays) { return low_ends(rays, raster, level_height()); },
      [&](RayCloud&, const std::vector<LowEnd>& ends) {
        for (const LowEnd& end : ends) {
          add(made(end.cell), end);
          ++counts_[end.cell];
        }
      });
}

}  // namespace ray
