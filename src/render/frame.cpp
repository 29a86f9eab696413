#include "frame.h"

#include <raycloud/core/error.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace ray {
namespace {

/// Throws unless the image can be held. The numbers come as double because they may be beyond any integer.
void check_size(const Context& context, double columns, double rows, double longest_side,
                double bytes_per_pixel) {
  constexpr double kMostPixels = 2147483647.0;
  const double bytes = columns * rows * bytes_per_pixel;
  const auto budget = static_cast<double>(memory_budget(context));
  const bool too_long = std::max(columns, rows) > longest_side;
  if (!too_long && columns * rows <= kMostPixels && bytes <= budget) return;
  std::ostringstream text;
  text.precision(4);
  text << "the image would have " << columns << " x " << rows << " pixels";
  if (too_long) {
    text << " (a side may have " << static_cast<std::size_t>(longest_side) << ")";
  } else {
    text << " and need " << bytes / 1e9 << " GB of memory ("
         << std::min(budget, kMostPixels * bytes_per_pixel) / 1e9 << " GB may be used)";
  }
  text << "; ask for fewer or wider pixels";
  throw Error(ErrorCode::out_of_range, text.str());
}

}  // namespace

void check(const RenderOptions& options) {
  if (options.pixel_width) {
    if (!(options.pixel_width->value > 0.0) || !std::isfinite(options.pixel_width->value)) {
      throw Error(ErrorCode::usage, "the width of a pixel must be more than 0");
    }
  } else if (options.resolution == 0) {
    throw Error(ErrorCode::usage, "the resolution must be at least 1 pixel");
  }
}

Frame frame_of(const Context& context, const RenderOptions& options, const Bounds& bounds,
               double bytes_per_pixel) {
  Frame frame;
  frame.camera = camera_of(options.view);
  const auto low = [&](const SignedAxis& axis) { return std::min(axis(bounds.min), axis(bounds.max)); };
  const auto extent = [&](const SignedAxis& axis) { return bounds.extent()[axis.axis]; };
  frame.left = low(frame.camera.right);
  frame.bottom = low(frame.camera.up);
  frame.farthest = low(frame.camera.nearness);
  frame.depth = extent(frame.camera.nearness);
  const double across = extent(frame.camera.right);
  const double upwards = extent(frame.camera.up);
  const double longer = std::max(across, upwards);
  const auto most = static_cast<double>(options.resolution);
  double limit = std::numeric_limits<double>::infinity();
  if (options.pixel_width) {
    frame.pixel_width = options.pixel_width->value;
  } else if (longer / most > 0.0) {
    frame.pixel_width = longer / most;
    limit = most;  // against the rounding of the quotient
  }
  const auto pixels = [&](double length) {
    return std::clamp(std::ceil(length / frame.pixel_width), 1.0, limit);
  };
  check_size(context, pixels(across), pixels(upwards), static_cast<double>(options.longest_side),
             bytes_per_pixel);
  frame.columns = static_cast<std::size_t>(pixels(across));
  frame.rows = static_cast<std::size_t>(pixels(upwards));
  return frame;
}

}  // namespace ray
