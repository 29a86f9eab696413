#include "fractal.h"

#include "turn.h"

namespace ray {
namespace {

double fade(double t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

double mixed(double a, double b, double t) {
  return a + t * (b - a);
}

}  // namespace

double gradient_noise(const RandomStream& random, double x, double y) {
  const double column = std::floor(x);
  const double row = std::floor(y);
  const double right = x - column;
  const double up = y - row;
  const auto slope = [&](double i, double j) {
    const auto key = static_cast<std::uint64_t>(static_cast<std::int64_t>(column + i));
    const auto draw = static_cast<std::uint64_t>(static_cast<std::int64_t>(row + j));
    return turned(random.uniform(key, draw)).dot(Eigen::Vector2d(right - i, up - j));
  };
  return mixed(mixed(slope(0, 0), slope(1, 0), fade(right)), mixed(slope(0, 1), slope(1, 1), fade(right)),
               fade(up));
}

double fractal(const RandomStream& random, double x, double y, const FractalOptions& options) {
  double sum = 0.0;
  double height = options.height;
  double frequency = 1 / options.wavelength;
  for (int octave = 0; octave < options.octaves; ++octave) {
    const double shift = 17.37 * octave;  // so that the octaves' zeros don't meet
    sum += height * gradient_noise(random, x * frequency + shift, y * frequency - shift);
    height *= options.roughness;
    frequency *= 2;
  }
  return sum;
}

}  // namespace ray
