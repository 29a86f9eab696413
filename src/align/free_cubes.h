#pragma once
/// The space that a cloud's rays have seen to be empty.

#include "patches.h"

#include <raycloud/exec/context.h>
#include <raycloud/spatial/key_table.h>

#include <Eigen/Core>

namespace ray::align {

/// Cubes that one ray of each cube with points, or one of a sample of the unbounded rays, has crossed well
/// before it ended: so far that it had left the surface by more than a cube, however flat it came in.
class FreeCubes {
 public:
  /// `level` tells the surfaces at the ends of the rays, and the width of the cubes. About 10 ns for each
  /// cube that is crossed; 40 bytes for each 4³ cubes.
  FreeCubes(const Context& context, const Surfaces& surfaces, const PatchLevel& level);

  /// Whether the cube of a point (m, from the origin) was crossed.
  [[nodiscard]] bool is_crossed(const Eigen::Vector3d& point) const;

  [[nodiscard]] double width() const { return width_; }

 private:
  double width_;
  KeyTable<std::uint64_t> bricks_;  // of 4³ cubes, a bit each
};

}  // namespace ray::align
