#include "fourier.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ray::align {
namespace {

void transpose(const Image& from, Image& to, std::size_t side) {
  constexpr std::size_t kBlock = 16;  // two cache lines
  for (std::size_t row = 0; row < side; row += kBlock)
    for (std::size_t column = 0; column < side; column += kBlock)
      for (std::size_t i = row; i < std::min(row + kBlock, side); ++i)
        for (std::size_t j = column; j < std::min(column + kBlock, side); ++j)
          to[j * side + i] = from[i * side + j];
}

/// sums = a + b, and differences = (a - b) · root, of `count` complex numbers given as pairs of floats.
void butterflies(const float* a, const float* b, std::complex<float> root, std::size_t count, float* sums,
                 float* differences) {
  const float real = root.real(), imaginary = root.imag();
  for (std::size_t i = 0; i < 2 * count; i += 2) {
    const float x = a[i] - b[i], y = a[i + 1] - b[i + 1];
    sums[i] = a[i] + b[i];
    sums[i + 1] = a[i + 1] + b[i + 1];
    differences[i] = x * real - y * imaginary;
    differences[i + 1] = x * imaginary + y * real;
  }
}

}  // namespace

Fourier::Fourier(std::size_t side) : side_(side), roots_(side / 2) {
  for (std::size_t i = 0; i < roots_.size(); ++i) {
    const double angle = -2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(side);
    roots_[i] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
  }
}

/// Stockham's form (Cochran and others 1967), which needs no reordering: all columns at once.
void Fourier::columns(Image& image, Image& scratch, bool inverse) const {
  scratch.resize(image.size());
  std::size_t stride = side_;  // what is done at once: `side_` columns of 1, 2, 4 … transforms
  for (std::size_t length = side_; length > 1; length /= 2, stride *= 2) {
    const auto* from = reinterpret_cast<const float*>(image.data());
    auto* to = reinterpret_cast<float*>(scratch.data());
    for (std::size_t p = 0; p < length / 2; ++p) {
      const std::complex<float> root = roots_[p * (side_ / length)];
      butterflies(from + 2 * stride * p, from + 2 * stride * (p + length / 2),
                  inverse ? std::conj(root) : root, stride, to + 2 * stride * (2 * p),
                  to + 2 * stride * (2 * p + 1));
    }
    image.swap(scratch);
  }
}

void Fourier::forward(Image& image, Image& scratch) const {
  columns(image, scratch, false);
  transpose(image, scratch, side_);
  image.swap(scratch);
  columns(image, scratch, false);
}

void Fourier::backward(Image& image, Image& scratch) const {
  columns(image, scratch, true);
  transpose(image, scratch, side_);
  image.swap(scratch);
  columns(image, scratch, true);
}

}  // namespace ray::align
