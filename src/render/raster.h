#pragma once
/// The picture while it is drawn: nearest wins, whoever comes first.

#include <raycloud/core/image.h>

#include <atomic>
#include <cstdint>
#include <vector>

namespace ray {

/// One word a pixel: 40 bits of nearness above 24 bits of colour, and 0 where nothing is; so drawing is
/// taking the larger word, which gives the same picture in any order.
class Raster {
 public:
  static constexpr std::uint64_t kNearest = (std::uint64_t{1} << 40) - 1;

  Raster(std::size_t width, std::size_t height) : width_(width), height_(height), words_(width * height) {}

  /// `row` counts from the bottom. Thread-safe. Precondition: 1 ≤ nearness ≤ kNearest; the pixel's alpha is
  /// ignored.
  void draw(std::size_t column, std::size_t row, std::uint64_t nearness, const Pixel& colour) {
    const std::uint64_t word = nearness << 24 | std::uint64_t{colour.red} << 16 |
                               std::uint64_t{colour.green} << 8 | std::uint64_t{colour.blue};
    std::atomic<std::uint64_t>& target = words_[(height_ - 1 - row) * width_ + column];
    std::uint64_t seen = target.load(std::memory_order_relaxed);
    while (word > seen && !target.compare_exchange_weak(seen, word, std::memory_order_relaxed)) {
    }
  }

  [[nodiscard]] Image image() const {
    Image image{width_, height_, std::vector<Pixel>(words_.size())};
    for (std::size_t i = 0; i < words_.size(); i++) {
      const std::uint64_t word = words_[i].load(std::memory_order_relaxed);
      if (word == 0) continue;
      image.pixels[i] = {static_cast<std::uint8_t>(word >> 16), static_cast<std::uint8_t>(word >> 8),
                         static_cast<std::uint8_t>(word), 255};
    }
    return image;
  }

 private:
  std::size_t width_;
  std::size_t height_;
  std::vector<std::atomic<std::uint64_t>> words_;
};

}  // namespace ray
