#include "plan_heights.h"

#include <raycloud/core/bounds.h>
#include <raycloud/core/error.h>
#include <raycloud/mesh/height_raster.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

namespace ray {
namespace {

constexpr float kNoHeight = std::numeric_limits<float>::quiet_NaN();

/// Raises a cell to a height.
void raise(float& value, double height) {
  const auto single = static_cast<float>(height);
  if (!(value >= single)) value = single;
}

Raster empty_frame(const Bounds& bounds, double cell, std::size_t most_cells) {
  const Eigen::Vector2d low = (bounds.min.head<2>() / cell).array().floor();
  const Eigen::Vector2d high = (bounds.max.head<2>() / cell).array().ceil();
  const Eigen::Vector2d count = (high - low).cwiseMax(1.0);
  if (!(count.x() * count.y() <= static_cast<double>(most_cells))) {
    throw Error(ErrorCode::out_of_range,
                "a raster of such cells is too large: give wider ones, of " +
                    std::to_string(static_cast<std::int64_t>(std::ceil(
                        cell * std::sqrt(count.x() * count.y() / static_cast<double>(most_cells))))) +
                    " m");
  }
  Raster raster;
  raster.width = static_cast<std::size_t>(count.x());
  raster.height = static_cast<std::size_t>(count.y());
  raster.cell = cell;
  raster.corner = {low.x() * cell, (low.y() + count.y()) * cell};
  raster.values.assign(raster.width * raster.height, kNoHeight);
  return raster;
}

/// The first of the cells whose middles are from `low` to `high` from the corner, and the one after the last.
std::pair<std::size_t, std::size_t> middles(double low, double high, double cell, std::size_t count) {
  const double first = std::ceil(low / cell - 0.5 - 1e-6);
  const double last = std::floor(high / cell - 0.5 + 1e-6) + 1.0;
  const auto most = static_cast<double>(count);
  return {static_cast<std::size_t>(std::clamp(first, 0.0, most)),
          static_cast<std::size_t>(std::clamp(last, 0.0, most))};
}

}  // namespace

Raster height_raster(const Mesh& mesh, double cell, std::size_t most_cells) {
  if (!(cell > 0.0 && std::isfinite(cell)))
    throw Error(ErrorCode::usage, "the cells of a raster must be wider than 0");
  Bounds bounds;
  for (const Mesh::Face& face : mesh.faces)
    for (const std::uint32_t vertex : face)
      bounds.add(mesh.vertices[vertex]);
  if (mesh.faces.empty()) throw Error(ErrorCode::no_data, "the mesh has no faces");
  Raster raster = empty_frame(bounds, cell, most_cells);
  for (const Mesh::Face& face : mesh.faces) {
    Bounds box;
    for (const std::uint32_t vertex : face)
      box.add(mesh.vertices[vertex]);
    const auto [left, right] =
        middles(box.min.x() - raster.corner.x(), box.max.x() - raster.corner.x(), cell, raster.width);
    const auto [top, bottom] =
        middles(raster.corner.y() - box.max.y(), raster.corner.y() - box.min.y(), cell, raster.height);
    for (std::size_t row = top; row < bottom; ++row) {
      for (std::size_t column = left; column < right; ++column) {
        const auto height = height_of_face(mesh, face, raster.centre(column, row));
        if (height) raise(raster.values[row * raster.width + column], *height);
      }
    }
  }
  return raster;
}

Raster surface_raster(const Context& context, RaySource& source, const Raster& frame) {
  struct Top {
    std::size_t cell;
    double height;
  };
  Raster raster = frame;
  std::fill(raster.values.begin(), raster.values.end(), kNoHeight);
  stream(
      context, source, nullptr,
      [&](RayCloud& rays) {
        std::vector<Top> tops;
        tops.reserve(rays.size());
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (rays.bounded[i] == 0) continue;
          const double column = (rays.ends[i].x() - frame.corner.x()) / frame.cell;
          const double row = (frame.corner.y() - rays.ends[i].y()) / frame.cell;
          if (!(column >= 0.0 && column < static_cast<double>(frame.width))) continue;
          if (!(row >= 0.0 && row < static_cast<double>(frame.height))) continue;
          tops.push_back({static_cast<std::size_t>(row) * frame.width + static_cast<std::size_t>(column),
                          rays.ends[i].z()});
        }
        return tops;
      },
      [&](RayCloud&, const std::vector<Top>& tops) {
        for (const Top& top : tops)
          raise(raster.values[top.cell], top.height);
      });
  return raster;
}

Raster canopy_raster(const Raster& surface, const Raster& ground) {
  Raster canopy = surface;
  for (std::size_t i = 0; i < canopy.values.size(); ++i) {
    const float between = surface.values[i] - ground.values[i];
    canopy.values[i] = std::isnan(between) ? kNoHeight : std::max(between, 0.0F);
  }
  return canopy;
}

}  // namespace ray
