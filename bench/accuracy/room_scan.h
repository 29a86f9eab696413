#pragma once
/// A scan of a room with thin things in it, and the noise that denoising is for.

#include "sampled.h"

#include <cstdint>
#include <string>
#include <vector>

namespace bench {

/// What a ray of the room ended on, as Truth::part.
enum RoomPart : int { kSolid, kWire, kUniform, kMixed, kDust, kNothing };

constexpr int kScans = 3;  // pooled

struct NoiseKinds {
  bool uniform = false;
  bool mixed = false;
  bool dust = false;
};

struct RoomScanner {
  int beams = 32;
  double noise = 0.01;           ///< m, sigma of a range
  double aside = 0.0;            ///< m, by which its way lies elsewhere
  std::uint64_t rays = 314'000;  ///< at 314 thousand a second
};

/// 6 m by 5 m by 2.6 m without a ceiling; a floor, four walls, a box, a table top, poles of r = 4 cm, a
/// railing and wires of 6 mm across. One second of a spinning scanner (with 32 beams, 1024 steps a
/// turn) that walks 0.8 m; where a ray meets nothing it is unbounded. Of each kind of noise 1 % of the
/// rays, in place of what they met:
///   uniform - anywhere in the room, evenly by volume, along the ray
///   mixed   - between the two surfaces of a range edge (apart by 0.3 m or more from one step to the next)
///   dust    - 0.3 to 3 m from the sensor, in front of the surface
/// Rays that met a wire stay as they are, and so does every other step of an edge: that leaves about 0.3 %
/// for mixed ones.
[[nodiscard]] Sampled room_scan(std::uint64_t seed, const NoiseKinds& kinds, const RoomScanner& scanner = {});

}  // namespace bench
