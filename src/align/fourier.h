#pragma once
/// Two-dimensional Fourier transforms of square images whose side is a power of two.

#include <complex>
#include <cstddef>
#include <vector>

namespace ray::align {

/// `side`² values, row by row.
using Image = std::vector<std::complex<float>>;

/// Transforms images of one side. Thread-safe once made. The rows of a stage are worked on as a whole, so
/// that compilers make vector instructions of it: for 256² four times as fast as kissfft as Eigen has it.
class Fourier {
 public:
  /// Precondition: a power of two, at least 2.
  explicit Fourier(std::size_t side);

  [[nodiscard]] std::size_t side() const { return side_; }
  /// In place, through `scratch`, which becomes as large. The result is transposed: frequencies of x are
  /// along the columns.
  void forward(Image& image, Image& scratch) const;
  /// Takes a transposed spectrum to an image that is not, times side².
  void backward(Image& image, Image& scratch) const;

 private:
  void columns(Image& image, Image& scratch, bool inverse) const;

  std::size_t side_;
  std::vector<std::complex<float>> roots_;
};

}  // namespace ray::align
