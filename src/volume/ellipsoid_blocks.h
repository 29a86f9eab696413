#pragma once
/// The ellipsoids of a cloud that does not fit the memory, in blocks of space.

#include "packed_ellipsoid.h"
#include "read_ends.h"
#include "region_cells.h"

#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/space_cuts.h>
#include <raycloud/exec/spilled_rows.h>
#include <raycloud/volume/ellipsoid_tree.h>

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <vector>

namespace ray {

/// Each block has the ellipsoids of the ends in its piece of space, on disk, in the order of the cloud.
class EllipsoidBlocks {
 public:
  /// Reads `source` once and rewinds it. So many blocks that a point of one may take `bytes_per_point`. About
  /// 2 µs of one core an end.
  EllipsoidBlocks(const Context& context, RaySource& source, const ReadEnds& ends,
                  std::size_t bytes_per_point);

  [[nodiscard]] std::size_t parts() const { return cuts_.parts(); }
  [[nodiscard]] std::size_t part_of(const Eigen::Vector3d& end) const { return cuts_.part_of(end); }
  [[nodiscard]] std::size_t size(std::size_t part) const { return ellipsoids_.size(part); }
  [[nodiscard]] double range_noise() const { return range_noise_; }
  /// By block: what holds its ellipsoids, with some room for rounding.
  [[nodiscard]] const std::vector<Eigen::AlignedBox3d>& boxes() const { return boxes_; }
  /// Those that the ellipsoids are in.
  [[nodiscard]] const RegionCells& cells() const { return cells_; }

  /// By their numbers, which are their places in the block: the ellipsoids, and the cells that they are in.
  [[nodiscard]] std::vector<PackedEllipsoid> load(std::size_t part) { return ellipsoids_.load(part); }
  [[nodiscard]] std::vector<std::uint32_t> cells_of(std::size_t part) { return cell_numbers_.load(part); }
  /// By their numbers.
  [[nodiscard]] std::unique_ptr<EllipsoidTree> tree(const Context& context, std::size_t part);

 private:
  void make(const Context& context, Block<SeenPoint>&& block, std::size_t part, double reach);

  SpaceCuts cuts_;
  SpilledRows<PackedEllipsoid> ellipsoids_;
  SpilledRows<std::uint32_t> cell_numbers_;
  std::vector<Eigen::AlignedBox3d> boxes_;
  RegionCells cells_;
  double range_noise_ = 0.0;
};

/// What holds an ellipsoid, with some room for rounding.
[[nodiscard]] Eigen::AlignedBox3d box_of(const Ellipsoid& ellipsoid);

/// Of `count` ellipsoids, `ellipsoid(i)` a reference to each; closed. The memory is that of the tree.
[[nodiscard]] std::unique_ptr<EllipsoidTree> tree_of(
    const Context& context, std::size_t count,
    const std::function<const PackedEllipsoid&(std::size_t)>& ellipsoid);

}  // namespace ray
