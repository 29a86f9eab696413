#include "canvas.h"

#include <atomic>
#include <cmath>
#include <cstdint>
#include <vector>

namespace ray {
namespace {

/// Nearest wins, whoever comes first. One word a pixel: 40 bits of nearness above 24 bits of what is seen
/// (red, green and blue, or a height), and 0 where nothing is; so drawing is taking the larger word, which
/// gives the same picture in any order.
class Nearest final : public Canvas {
 public:
  Nearest(RenderStyle style, Purpose purpose, const Frame& frame, const Survey& survey)
      : style_(style),
        purpose_(purpose),
        dots_(style == RenderStyle::starts && purpose == Purpose::eye),
        frame_(frame),
        paint_(style, survey),
        words_(frame.columns * frame.rows),
        range_{survey.low, survey.high},
        lowest_(survey.bounds.min.z()),
        height_step_(survey.bounds.extent().z() / static_cast<double>(kMostSeen)) {
    const double scale = static_cast<double>(kNearest - 1) / frame.depth;
    nearness_scale_ = std::isfinite(scale) ? scale : 0.0;  // where nothing hides anything
  }

  void draw(const RayCloud& rays) override {
    if (purpose_ == Purpose::eye) {
      draw_as(rays, [&](const Eigen::Vector3d& point, const Colour& colour) {
        return packed(paint_(point, colour));
      });
    } else if (style_ == RenderStyle::height) {
      draw_as(rays, [&](const Eigen::Vector3d& point, const Colour&) { return packed_height(point.z()); });
    } else {
      draw_as(rays, [](const Eigen::Vector3d&, const Colour& colour) { return packed(colour); });
    }
  }

  [[nodiscard]] Image image() const override {
    Image image{frame_.columns, frame_.rows, std::vector<Pixel>(words_.size())};
    for (std::size_t i = 0; i < words_.size(); i++) {
      const std::uint64_t word = words_[i].load(std::memory_order_relaxed);
      if (word != 0) image.pixels[i] = {byte(word, 16), byte(word, 8), byte(word, 0), 255};
    }
    return image;
  }

  [[nodiscard]] std::optional<ValueRange> shown() const override {
    return paint_.by_height() ? std::optional(range_) : std::nullopt;
  }

  [[nodiscard]] FloatImage values() const override {
    FloatImage image{frame_.columns, frame_.rows, std::vector<FloatPixel>(words_.size())};
    for (std::size_t i = 0; i < words_.size(); i++) {
      const std::uint64_t word = words_[i].load(std::memory_order_relaxed);
      if (word == 0) continue;
      if (style_ == RenderStyle::height) {
        const auto height = static_cast<float>(static_cast<double>(word & kMostSeen) * height_step_);
        image.pixels[i] = {height, height, height};
      } else {
        const auto channel = [&](int shift) { return static_cast<float>(byte(word, shift)) / 255.0F; };
        image.pixels[i] = {channel(16), channel(8), channel(0)};
      }
    }
    return image;
  }

 private:
  static constexpr std::uint64_t kNearest = (std::uint64_t{1} << 40) - 1;
  static constexpr std::uint64_t kMostSeen = (std::uint64_t{1} << 24) - 1;

  template <class RedGreenBlue>
  [[nodiscard]] static std::uint64_t packed(const RedGreenBlue& colour) {
    return std::uint64_t{colour.red} << 16 | std::uint64_t{colour.green} << 8 | std::uint64_t{colour.blue};
  }
  [[nodiscard]] std::uint64_t packed_height(double z) const {
    if (!(height_step_ > 0.0)) return 0;
    return std::min(static_cast<std::uint64_t>((z - lowest_) / height_step_ + 0.5), kMostSeen);
  }
  [[nodiscard]] static std::uint8_t byte(std::uint64_t word, int shift) {
    return static_cast<std::uint8_t>(word >> shift);
  }

  template <class Seen>
  void draw_as(const RayCloud& rays, const Seen& seen) {
    each_drawn_point(style_, rays, [&](const Eigen::Vector3d& point, const Colour& colour) {
      const double near = (frame_.camera.nearness(point) - frame_.farthest) * nearness_scale_;
      const auto nearness = std::min(static_cast<std::uint64_t>(near) + 1, kNearest);
      const std::uint64_t word = nearness << 24 | seen(point, colour);
      if (dots_) {
        draw_dot(frame_.column(point), frame_.row(point), word);
      } else {
        draw_word(frame_.pixel(point), word);
      }
    });
  }

  void draw_dot(std::size_t column, std::size_t row, std::uint64_t word) {
    for (std::size_t y = std::max<std::size_t>(row, 1) - 1; y <= std::min(row + 1, frame_.rows - 1); y++) {
      for (std::size_t x = std::max<std::size_t>(column, 1) - 1;
           x <= std::min(column + 1, frame_.columns - 1); x++)
        draw_word(y * frame_.columns + x, word);
    }
  }

  void draw_word(std::size_t pixel, std::uint64_t word) {
    std::atomic<std::uint64_t>& target = words_[pixel];
    std::uint64_t there = target.load(std::memory_order_relaxed);
    while (word > there && !target.compare_exchange_weak(there, word, std::memory_order_relaxed)) {
    }
  }

  RenderStyle style_;
  Purpose purpose_;
  bool dots_;  // 3 x 3 pixels for each point, which may be alone
  Frame frame_;
  Painter paint_;
  std::vector<std::atomic<std::uint64_t>> words_;
  ValueRange range_;
  double lowest_;          // m
  double height_step_;     // m for 1 of what is seen
  double nearness_scale_;  // steps a metre
};

}  // namespace

std::unique_ptr<Canvas> make_nearest(RenderStyle style, Purpose purpose, const Frame& frame,
                                     const Survey& survey) {
  return std::make_unique<Nearest>(style, purpose, frame, survey);
}

}  // namespace ray
