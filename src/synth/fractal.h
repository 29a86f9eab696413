#pragma once
/// Noise that looks like ground.

#include <raycloud/exec/random.h>

namespace ray {

/// Gradient noise over the plane: smooth, zero at whole numbers, mean 0, mostly within ±0.5, one bump a unit
/// (Perlin 2002 with hashed lattice directions).
[[nodiscard]] double gradient_noise(const RandomStream& random, double x, double y);

struct FractalOptions {
  double wavelength = 10.0;  ///< m, of the largest bumps
  double height = 1.0;       ///< m, factor on the largest bumps
  double roughness = 0.5;    ///< height of each octave over that of the one before
  int octaves = 5;           ///< each with half the wavelength
};
/// The sum of octaves of gradient noise.
[[nodiscard]] double fractal(const RandomStream& random, double x, double y, const FractalOptions& options);

}  // namespace ray
