#pragma once
/// What rays tell of an ellipsoid: how many ended in it, how many went through, and when (paper, section
/// VI-A).

#include <raycloud/core/ray_cloud.h>
#include <raycloud/exec/context.h>
#include <raycloud/volume/ellipsoid_tree.h>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace ray {

/// When a ray that crosses an ellipsoid proves that nothing was there. With everything at 0, every ray does.
struct PassGuard {
  double beyond = 0.05;       ///< m, a bounded ray goes on at least so far after it has left the ellipsoid
  double depth = 0.05;        ///< m, and goes so far below the surface of a flat one
  double least_sine = 0.087;  ///< of the angle between the ray and the surface of a flat one
  double most_miss2 = 0.96;   ///< Chord::miss2: the chord is a fair share of the longest
};
/// The paper's rule: whatever crosses an ellipsoid has passed it.
inline constexpr PassGuard kEveryPass{0.0, 0.0, 0.0, 1.0};

/// Rays counted by where they stand to the time in which the ellipsoid was hit. Counts end at 60 000. 48
/// bytes.
struct Evidence {
  double first_hit = std::numeric_limits<double>::infinity();  ///< s; above last_hit where there was none
  double last_hit = -std::numeric_limits<double>::infinity();  ///< s
  /// A bit for each look, by its hash: rays within `look_time` of each other, from about one direction.
  std::uint64_t looks_before = 0;
  std::uint64_t looks_after = 0;
  std::uint16_t hits = 0;       ///< bounded rays that end in it
  std::uint16_t crossings = 0;  ///< rays that begin before it and end behind it
  std::uint16_t before = 0;     ///< of these, those that prove it empty, earlier than the first hit
  std::uint16_t within = 0;     ///< between hits
  std::uint16_t after = 0;      ///< later than the last hit
  friend bool operator==(const Evidence&, const Evidence&) = default;
};

struct CountRule {
  PassGuard guard;
  double look_time = 0.5;  ///< s
};

/// Adds the rays that end in ellipsoids to `hits`, `first_hit` and `last_hit`, by slot. Any number of threads
/// may add rays at once: every step is atomic, and their order does not matter. About 0.4 µs a ray.
void add_hits(const EllipsoidTree& tree, const RayCloud& rays, std::span<Evidence> evidence);

/// Adds the rays that cross ellipsoids to `crossings` and, by their time, to the others. Called when all hits
/// are known. Threads as above. About 1 µs a ray.
void add_passes(const EllipsoidTree& tree, const RayCloud& rays, const CountRule& rule,
                std::span<Evidence> evidence);

}  // namespace ray
