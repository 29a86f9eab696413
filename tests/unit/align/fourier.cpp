/// Fourier transforms against the sum that defines them.

#include "align/fourier.h"

#include <raycloud/exec/random.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ray::align {
namespace {

Image random_image(std::size_t side) {
  const RandomStream random(1, "image");
  Image image(side * side);
  for (std::size_t i = 0; i < image.size(); ++i)
    image[i] = {static_cast<float>(random.uniform(i, 0) - 0.5),
                static_cast<float>(random.uniform(i, 1) - 0.5)};
  return image;
}

std::complex<double> frequency_of(const Image& image, std::size_t side, std::size_t u, std::size_t v) {
  std::complex<double> sum = 0.0;
  for (std::size_t y = 0; y < side; ++y)
    for (std::size_t x = 0; x < side; ++x) {
      const double turns = static_cast<double>((u * x + v * y) % side) / static_cast<double>(side);
      sum += std::complex<double>(image[y * side + x]) * std::polar(1.0, -2.0 * std::numbers::pi * turns);
    }
  return sum;
}

TEST(Fourier, IsTheSumOfWaves) {
  for (const std::size_t side : {2U, 4U, 8U, 32U}) {
    const Image image = random_image(side);
    Image spectrum = image, scratch;
    Fourier(side).forward(spectrum, scratch);
    for (std::size_t u = 0; u < side; ++u)
      for (std::size_t v = 0; v < side; v += 3)
        EXPECT_LT(std::abs(std::complex<double>(spectrum[u * side + v]) - frequency_of(image, side, u, v)),
                  1e-4)
            << side << " " << u << " " << v;
  }
}

TEST(Fourier, ComesBack) {
  constexpr std::size_t kSide = 64;
  const Image image = random_image(kSide);
  Image there = image, scratch;
  const Fourier fourier(kSide);
  fourier.forward(there, scratch);
  fourier.backward(there, scratch);
  for (std::size_t i = 0; i < image.size(); ++i)
    ASSERT_LT(std::abs(there[i] / static_cast<float>(kSide * kSide) - image[i]), 1e-5F);
}

TEST(Fourier, FindsAShift) {
  constexpr std::size_t kSide = 32, kRight = 5, kDown = 29;
  const Image image = random_image(kSide);
  Image moved(image.size());
  for (std::size_t y = 0; y < kSide; ++y)
    for (std::size_t x = 0; x < kSide; ++x)
      moved[(y + kDown) % kSide * kSide + (x + kRight) % kSide] = image[y * kSide + x];
  Image first = image, scratch;
  const Fourier fourier(kSide);
  fourier.forward(first, scratch);
  fourier.forward(moved, scratch);
  for (std::size_t i = 0; i < first.size(); ++i)
    moved[i] *= std::conj(first[i]);
  fourier.backward(moved, scratch);
  const auto highest =
      std::max_element(moved.begin(), moved.end(), [](auto a, auto b) { return a.real() < b.real(); });
  EXPECT_EQ(static_cast<std::size_t>(highest - moved.begin()), kDown * kSide + kRight);
}

}  // namespace
}  // namespace ray::align
