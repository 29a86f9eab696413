#include "canvas.h"
#include "spread.h"

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <vector>

namespace ray {
namespace {

/// Adds up the colours of the points of a pixel, as integers: the same in any order.
class Sums final : public Canvas {
 public:
  Sums(RenderStyle style, Purpose purpose, const Frame& frame, const Survey& survey)
      : style_(style),
        painted_(style == RenderStyle::mean && purpose == Purpose::eye),
        frame_(frame),
        paint_(style, survey),
        cells_(frame.columns * frame.rows) {}

  void draw(const RayCloud& rays) override {
    if (painted_) {
      draw_as(rays, paint_);
    } else {
      draw_as(rays, [](const Eigen::Vector3d&, const Colour& colour) { return colour; });
    }
  }

  [[nodiscard]] Image image() const override {
    Image image{frame_.columns, frame_.rows, std::vector<Pixel>(cells_.size())};
    const double full = style_ == RenderStyle::sum ? brightest() : 0.0;
    for (std::size_t i = 0; i < cells_.size(); i++) {
      const Values cell = values_of(cells_[i]);
      if (cell[kCount] == 0) continue;
      const auto channel = [&](std::size_t c) {
        const auto value = style_ == RenderStyle::sum ? shown_sum(cell[c], full) : rounded_mean(cell, c);
        return static_cast<std::uint8_t>(value);
      };
      image.pixels[i] = {channel(0), channel(1), channel(2), 255};
    }
    return image;
  }

  [[nodiscard]] std::optional<ValueRange> shown() const override {
    if (style_ != RenderStyle::sum) return std::nullopt;
    return ValueRange{0.0, brightest() / 255.0};
  }

  [[nodiscard]] FloatImage values() const override {
    FloatImage image{frame_.columns, frame_.rows, std::vector<FloatPixel>(cells_.size())};
    for (std::size_t i = 0; i < cells_.size(); i++) {
      const Values cell = values_of(cells_[i]);
      if (cell[kCount] == 0) continue;
      const double scale = 255.0 * (style_ == RenderStyle::sum ? 1.0 : static_cast<double>(cell[kCount]));
      const auto channel = [&](std::size_t c) {
        return static_cast<float>(static_cast<double>(cell[c]) / scale);
      };
      image.pixels[i] = {channel(0), channel(1), channel(2)};
    }
    return image;
  }

 private:
  static constexpr std::size_t kCount = 3;  // after red, green and blue
  using Cell = std::array<std::atomic<std::uint64_t>, 4>;
  using Values = std::array<std::uint64_t, 4>;

  [[nodiscard]] static Values values_of(const Cell& cell) {
    Values values{};
    for (std::size_t i = 0; i < values.size(); i++)
      values[i] = cell[i].load(std::memory_order_relaxed);
    return values;
  }
  [[nodiscard]] static std::uint64_t rounded_mean(const Values& cell, std::size_t channel) {
    return (cell[channel] + cell[kCount] / 2) / cell[kCount];
  }
  [[nodiscard]] static long shown_sum(std::uint64_t sum, double full) {
    return full > 0.0 ? std::lround(255.0 * std::min(1.0, static_cast<double>(sum) / full)) : 0;
  }

  /// The sum of the brightest channel that 5 % of the pixels exceed.
  [[nodiscard]] double brightest() const {
    Spread spread;
    for (const Cell& cell : cells_) {
      const Values values = values_of(cell);
      const std::uint64_t largest = std::max({values[0], values[1], values[2]});
      if (largest > 0) spread.add(static_cast<double>(largest));
    }
    return spread.exceeded_by(0.05);
  }

  template <class Paint>
  void draw_as(const RayCloud& rays, const Paint& paint) {
    each_drawn_point(style_, rays, [&](const Eigen::Vector3d& point, const Colour& colour) {
      const auto painted = paint(point, colour);
      Cell& cell = cells_[frame_.pixel(point)];
      const Values added{painted.red, painted.green, painted.blue, 1};
      for (std::size_t i = 0; i < added.size(); i++)
        cell[i].fetch_add(added[i], std::memory_order_relaxed);
    });
  }

  RenderStyle style_;
  bool painted_;  // as for `ends`, rather than in the colours of the cloud
  Frame frame_;
  Painter paint_;
  std::vector<Cell> cells_;
};

}  // namespace

std::unique_ptr<Canvas> make_sums(RenderStyle style, Purpose purpose, const Frame& frame,
                                  const Survey& survey) {
  return std::make_unique<Sums>(style, purpose, frame, survey);
}

}  // namespace ray
