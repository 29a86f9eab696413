#include "footprint.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ray::align {
namespace {

/// The middle of the values but one in a hundred at either side, and half their extent.
std::pair<double, double> middle_and_reach(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t aside = values.size() / 100;
  const double low = values[aside], high = values[values.size() - 1 - aside];
  return {0.5 * (low + high), 0.5 * (high - low)};
}

/// Adds a value to the four cells around a place.
void splat(Image& image, std::size_t side, float x, float y, std::complex<float> value) {
  const float left = std::floor(x), low = std::floor(y);
  const float u = x - left, v = y - low;
  const auto mask = static_cast<std::int64_t>(side) - 1;
  const auto i = static_cast<std::int64_t>(left), j = static_cast<std::int64_t>(low);
  const auto at = [&](std::int64_t column, std::int64_t row) -> std::complex<float>& {
    return image[static_cast<std::size_t>(row & mask) * side + static_cast<std::size_t>(column & mask)];
  };
  at(i, j) += value * ((1.0F - u) * (1.0F - v));
  at(i + 1, j) += value * (u * (1.0F - v));
  at(i, j + 1) += value * ((1.0F - u) * v);
  at(i + 1, j + 1) += value * (u * v);
}

}  // namespace

Footprint footprint_of(const std::vector<Patch>& patches, double width) {
  constexpr float kFull = 4.0F;  // patches above each other
  struct Column {
    Eigen::Vector2d place = Eigen::Vector2d::Zero();
    Eigen::Vector2d facing = Eigen::Vector2d::Zero();
    double uprights = 0.0, patches = 0.0;
  };
  std::map<std::pair<int, int>, Column> columns;
  for (const Patch& patch : patches) {
    if (patch.is_level()) continue;
    const Eigen::Array2d cell = (patch.mean.head<2>().array() / width).floor();
    Column& column = columns[{static_cast<int>(cell.x()), static_cast<int>(cell.y())}];
    column.place += patch.mean.head<2>();
    column.patches += 1.0;
    if (patch.is_flat() && patch.is_upright())
      column.facing += patch.normal.head<2>().normalized(), column.uprights += 1.0;
  }
  Footprint footprint;
  std::vector<double> x, y;
  for (auto& [cell, column] : columns) {
    column.place /= column.patches;
    x.push_back(column.place.x());
    y.push_back(column.place.y());
  }
  if (columns.empty()) return footprint;
  const auto [middle_x, reach_x] = middle_and_reach(std::move(x));
  const auto [middle_y, reach_y] = middle_and_reach(std::move(y));
  footprint.centre = {middle_x, middle_y};
  footprint.radius = std::hypot(reach_x, reach_y) + width;
  for (const auto& [cell, column] : columns) {
    Feature feature;
    feature.place = (column.place - footprint.centre).cast<float>();
    if (static_cast<double>(feature.place.norm()) > footprint.radius) continue;
    // One wall as high as four patches counts in full; one of which both sides are seen, by the difference.
    feature.facing = column.facing.cast<float>() / std::max(static_cast<float>(column.uprights), kFull);
    feature.height = std::min(static_cast<float>(column.patches) / kFull, 1.0F);
    footprint.features.push_back(feature);
  }
  return footprint;
}

void draw(const Footprint& footprint, double yaw, double cell, std::size_t side, Rasters& rasters) {
  rasters.facing.assign(side * side, {});
  rasters.height.assign(side * side, {});
  const auto c = static_cast<float>(std::cos(yaw)), s = static_cast<float>(std::sin(yaw));
  const auto scale = static_cast<float>(1.0 / cell);
  for (const Feature& feature : footprint.features) {
    const float x = (c * feature.place.x() - s * feature.place.y()) * scale;
    const float y = (s * feature.place.x() + c * feature.place.y()) * scale;
    splat(rasters.facing, side, x, y,
          {c * feature.facing.x() - s * feature.facing.y(), s * feature.facing.x() + c * feature.facing.y()});
    splat(rasters.height, side, x, y, feature.height);
  }
}

}  // namespace ray::align
