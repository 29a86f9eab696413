#pragma once
/// How one ray crosses ellipsoids.

#include <raycloud/core/ray_cloud.h>
#include <raycloud/volume/free_space.h>

namespace ray {

enum class Crossing {
  none,          ///< misses it, or begins or ends in it
  doubtful,      ///< goes through
  proves_empty,  ///< and nothing can have been there: see PassGuard
};

class RayPath {
 public:
  RayPath(const RayCloud& rays, std::size_t i)
      : start_(rays.starts[i]),
        end_(rays.ends[i]),
        length_((rays.ends[i] - rays.starts[i]).norm()),
        bounded_(rays.bounded[i] != 0) {}

  [[nodiscard]] Eigen::Vector3d way() const { return end_ - start_; }
  [[nodiscard]] Crossing cross(const Ellipsoid& ellipsoid, const PassGuard& guard) const {
    const Chord chord = chord_of(ellipsoid, start_, end_);
    if (chord.miss2 > 1.0 || !(chord.enters > 0.0 && chord.leaves < 1.0)) return Crossing::none;
    return proves_empty(ellipsoid, chord, guard) ? Crossing::proves_empty : Crossing::doubtful;
  }

 private:
  [[nodiscard]] bool proves_empty(const Ellipsoid& ellipsoid, const Chord& chord,
                                  const PassGuard& guard) const {
    if (chord.miss2 > guard.most_miss2) return false;
    const double beyond = (1.0 - chord.leaves) * length_;
    if (bounded_ && beyond < guard.beyond) return false;
    if (!ellipsoid.is_flat()) return true;
    const double sine = std::abs(ellipsoid.normal.dot(way())) / length_;
    return sine >= guard.least_sine && (!bounded_ || beyond * sine >= guard.depth);
  }

  Eigen::Vector3d start_, end_;
  double length_;
  bool bounded_;
};

}  // namespace ray
