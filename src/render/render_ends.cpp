#include "raster.h"
#include "survey.h"

#include <raycloud/core/error.h>
#include <raycloud/render/render_ends.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace ray {
namespace {

/// Where a point is in the image.
struct Frame {
  Camera camera;
  double left = 0.0;  // m, of the left and bottom edges and of the farthest end
  double bottom = 0.0;
  double farthest = 0.0;
  double pixel_width = 1.0;
  double nearness_scale = 0.0;  // steps a metre
  std::size_t columns = 1;
  std::size_t rows = 1;
};

void check(const RenderOptions& options) {
  if (options.pixel_width) {
    if (!(options.pixel_width->value > 0.0) || !std::isfinite(options.pixel_width->value)) {
      throw Error(ErrorCode::usage, "the width of a pixel must be more than 0");
    }
  } else if (options.resolution == 0) {
    throw Error(ErrorCode::usage, "the resolution must be at least 1 pixel");
  }
}

/// Throws unless the image can be held. The numbers come as double because they may be beyond any integer.
void check_size(const Context& context, double columns, double rows) {
  constexpr double kBytesPerPixel = 12.0;
  constexpr double kMostPixels = 2147483647.0;
  const double bytes = columns * rows * kBytesPerPixel;
  const auto budget = static_cast<double>(memory_budget(context));
  if (columns * rows <= kMostPixels && bytes <= budget) return;
  std::ostringstream text;
  text.precision(4);
  text << "the image would have " << columns << " x " << rows << " pixels and need " << bytes / 1e9
       << " GB of memory (" << std::min(budget, kMostPixels * kBytesPerPixel) / 1e9
       << " GB may be used); ask for fewer or wider pixels";
  throw Error(ErrorCode::out_of_range, text.str());
}

Frame frame_of(const Context& context, const RenderOptions& options, const Bounds& bounds) {
  Frame frame;
  frame.camera = camera_of(options.view);
  const auto low = [&](const SignedAxis& axis) { return std::min(axis(bounds.min), axis(bounds.max)); };
  const auto extent = [&](const SignedAxis& axis) { return bounds.extent()[axis.axis]; };
  frame.left = low(frame.camera.right);
  frame.bottom = low(frame.camera.up);
  frame.farthest = low(frame.camera.nearness);
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
  check_size(context, pixels(across), pixels(upwards));
  frame.columns = static_cast<std::size_t>(pixels(across));
  frame.rows = static_cast<std::size_t>(pixels(upwards));
  const double scale = static_cast<double>(Raster::kNearest - 1) / extent(frame.camera.nearness);
  frame.nearness_scale = std::isfinite(scale) ? scale : 0.0;  // where nothing hides anything
  return frame;
}

/// The pixel `metres` from the edge; the far edge itself belongs to the last pixel.
std::size_t pixel_at(double metres, double pixel_width, std::size_t count) {
  return std::min(static_cast<std::size_t>(metres / pixel_width), count - 1);
}

void draw_chunk(const RayCloud& rays, const Frame& frame, const Painter& painter, Raster& raster) {
  for (std::size_t i = 0; i < rays.size(); i++) {
    if (rays.bounded[i] == 0) continue;
    const Eigen::Vector3d& end = rays.ends[i];
    const double near = (frame.camera.nearness(end) - frame.farthest) * frame.nearness_scale;
    const auto nearness = std::min(static_cast<std::uint64_t>(near) + 1, Raster::kNearest);
    raster.draw(pixel_at(frame.camera.right(end) - frame.left, frame.pixel_width, frame.columns),
                pixel_at(frame.camera.up(end) - frame.bottom, frame.pixel_width, frame.rows), nearness,
                painter.colour(end, rays.colours[i]));
  }
}

}  // namespace

Rendering render_ends(const Context& context, RaySource& source, const RenderOptions& options) {
  check(options);
  const Survey survey = survey_ends(context, source);
  if (survey.bounds.empty())
    throw Error(ErrorCode::no_data, "there is nothing to render, as no ray is bounded");
  const Frame frame = frame_of(context, options, survey.bounds);
  const Painter painter(options.style, survey);
  Raster raster(frame.columns, frame.rows);
  source.rewind();
  static_cast<void>(stream(
      context, source, nullptr,
      [&](const RayCloud& rays) {
        draw_chunk(rays, frame, painter, raster);
        return Nothing{};
      },
      [](const RayCloud&, Nothing) {}));
  StreamCounts counts = survey.counts;
  counts.rays_out = survey.bounded;
  return {raster.image(), {frame.pixel_width}, survey.bounds, counts};
}

}  // namespace ray
