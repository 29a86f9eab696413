#pragma once
/// The rays that cross blocks of space, on disk.

#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/spilled_rows.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace ray {

/// Boxes in a tree of boxes, each pair of neighbours under one that holds both.
class BoxTree {
 public:
  /// Their number is a power of two, and they lie as the parts of SpaceCuts do. Empty ones are met by none.
  explicit BoxTree(std::span<const Eigen::AlignedBox3d> boxes);
  [[nodiscard]] std::size_t size() const { return nodes_.size() / 2; }
  [[nodiscard]] const Eigen::AlignedBox3d& box(std::size_t i) const { return nodes_[size() + i]; }
  /// Replaces `found` by the boxes that the line between the points meets, and perhaps others that it nearly
  /// does.
  void near_line(const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                 std::vector<std::uint32_t>& found) const;

 private:
  void find(std::size_t node, const Eigen::Vector3d& start, const Eigen::Vector3d& end, double slack,
            std::vector<std::uint32_t>& found) const;
  std::vector<Eigen::AlignedBox3d> nodes_;  ///< those of number i are in 2i and 2i + 1
};

/// What is asked of a ray.
struct SpilledRay {
  Eigen::Vector3d start, end;
  double time = 0.0;
  std::uint32_t number = 0;
  std::uint8_t bounded = 0;
};

/// The numbers of rays, by chunk: `numbers(rays, raw)` may take rays out, and returns those of the others.
using NumberRays = std::function<std::vector<std::uint32_t>(RayCloud& rays, const RawChunk& raw)>;

/// Rays of one or more clouds, each in all blocks whose boxes it meets.
class CrossingRays {
 public:
  /// On disk: 64 bytes for each ray and block. About 0.2 µs of one core a ray.
  CrossingRays(std::vector<Eigen::AlignedBox3d> boxes, std::size_t memory);
  /// Reads and rewinds the source.
  void add(const Context& context, RaySource& source, const NumberRays& numbers);

  /// The rays that meet the box of a block, or those of them that are bounded and end in it, with their
  /// numbers as the column `number`, uint32. One at a time, which must not outlive this.
  [[nodiscard]] std::unique_ptr<RaySource> crossing(std::size_t part);
  [[nodiscard]] std::unique_ptr<RaySource> ending(std::size_t part);

 private:
  BoxTree boxes_;
  SpilledRows<SpilledRay> rays_;  ///< of each block first those that end in it, then the others
};

/// The numbers of the rays of CrossingRays.
[[nodiscard]] std::span<const std::uint32_t> numbers_of(const RayCloud& rays);

}  // namespace ray
