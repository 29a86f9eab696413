#pragma once
/// What a style is drawn on: the three ways to put many points or lines into one pixel.

#include "frame.h"
#include "painter.h"

#include <memory>
#include <optional>

namespace ray {

/// For whom a picture is.
enum class Purpose { eye, values };

class Canvas {
 public:
  virtual ~Canvas() = default;
  /// Thread-safe, and the same in any order.
  virtual void draw(const RayCloud& rays) = 0;
  /// Made for Purpose::eye.
  [[nodiscard]] virtual Image image() const = 0;
  [[nodiscard]] virtual std::optional<ValueRange> shown() const = 0;
  /// Made for Purpose::values.
  [[nodiscard]] virtual FloatImage values() const = 0;
};

// nearest.cpp, sums.cpp and lines.cpp have one each.
[[nodiscard]] std::unique_ptr<Canvas> make_nearest(RenderStyle style, Purpose purpose, const Frame& frame,
                                                   const Survey& survey);
[[nodiscard]] std::unique_ptr<Canvas> make_sums(RenderStyle style, Purpose purpose, const Frame& frame,
                                                const Survey& survey);
[[nodiscard]] std::unique_ptr<Canvas> make_lines(const Frame& frame);

}  // namespace ray
