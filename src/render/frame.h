#pragma once
/// Where a point is in the image.

#include <raycloud/core/bounds.h>
#include <raycloud/exec/context.h>
#include <raycloud/render/render.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

namespace ray {

struct Frame {
  Camera camera;
  double left = 0.0;  ///< m, of the left and bottom edges and of the farthest point
  double bottom = 0.0;
  double farthest = 0.0;
  double depth = 0.0;  ///< m, from the farthest to the nearest point
  double pixel_width = 1.0;
  std::size_t columns = 1;
  std::size_t rows = 1;

  /// In pixels from the left and from the bottom. Precondition for all: the point is within the bounds.
  [[nodiscard]] double across(const Eigen::Vector3d& point) const {
    return (camera.right(point) - left) / pixel_width;
  }
  [[nodiscard]] double upwards(const Eigen::Vector3d& point) const {
    return (camera.up(point) - bottom) / pixel_width;
  }
  /// The far edges themselves belong to the last pixels; `row` counts from the top.
  [[nodiscard]] std::size_t column(const Eigen::Vector3d& point) const {
    return std::min(static_cast<std::size_t>(across(point)), columns - 1);
  }
  [[nodiscard]] std::size_t row(const Eigen::Vector3d& point) const {
    return rows - 1 - std::min(static_cast<std::size_t>(upwards(point)), rows - 1);
  }
  /// In the image, row by row from the top left.
  [[nodiscard]] std::size_t pixel(const Eigen::Vector3d& point) const {
    return row(point) * columns + column(point);
  }
};

/// Throws Error(usage) for options out of range.
void check(const RenderOptions& options);

/// Throws Error(out_of_range) where the image would need more memory than the context may use. Precondition:
/// the bounds are not empty.
[[nodiscard]] Frame frame_of(const Context& context, const RenderOptions& options, const Bounds& bounds,
                             double bytes_per_pixel);

}  // namespace ray
