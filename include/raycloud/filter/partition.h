#pragma once
/// Splitting a ray cloud into any number of clouds: the cells of a grid, or one for each colour. Pieces of
/// cut rays are as in filter/split.h. Paper, section VIII-D; docs/algorithms/splitting.md.

#include <raycloud/core/cloud_info.h>
#include <raycloud/core/units.h>
#include <raycloud/exec/stream.h>

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <vector>

namespace ray {

/// Which part: the indices of a cell in x, y, z and t, 0 on axes that are not split; or red, green, blue, 0.
using PartKey = std::array<std::int64_t, 4>;

/// The parts of a chunk, one behind the other.
struct PartitionedChunk {
  struct Part {
    PartKey key;
    std::size_t end = 0;  ///< one past its last row
  };
  RayCloud rays;
  std::vector<Part> parts;
};

/// A way to split into many, chunk by chunk; as SplitRule.
class PartitionRule {
 public:
  virtual ~PartitionRule() = default;
  /// The extra columns of every part.
  [[nodiscard]] virtual std::vector<ColumnInfo> columns(std::vector<ColumnInfo> source) const = 0;
  /// Replaces what `parts` held. Rays of a part are in the order of `rays`.
  virtual void apply(const RayCloud& rays, PartitionedChunk& parts) const = 0;
};
using PartitionRulePtr = std::unique_ptr<const PartitionRule>;

struct GridOptions {
  Eigen::Vector3d widths = Eigen::Vector3d::Zero();  ///< m; 0 for an axis that is not split
  double period = 0.0;                               ///< s; 0: not split in time
  double overlap = 0.0;  ///< m; how far two neighbours reach into each other, each by half of it
  Precision stored = Precision::double_;  ///< of the source, as in filter/split.h
};

/// Cell i of an axis spans (i - 1/2) w to (i + 1/2) w, its lower border included; rays are cut there. With an
/// overlap a cell is that box grown by half the overlap on each side, times excepted, so rays and ends in the
/// strips are in every cell that has them. A ray may cross at most 4096 cells: Error(out_of_range) beyond.
/// Throws Error(usage) for values that make no sense: negative, all widths 0, an overlap larger than a width.
[[nodiscard]] PartitionRulePtr partition_by_grid(const GridOptions& options);

/// One part for each red, green and blue.
[[nodiscard]] PartitionRulePtr partition_by_colour();

/// The number of different colours. Reads `source` to its end; rewind it before the split. Memory: 2 MB.
[[nodiscard]] std::size_t count_colours(const Context& context, RaySource& source);

/// Most parts that partition_cloud makes: more files than that are a mistake in the widths more often than a
/// wish.
inline constexpr std::size_t kMostParts = 65536;

struct Partition {
  StreamCounts stream;  ///< rays_out counts pieces
  /// Every part that has rays, with its number of rays and pieces and its sink, not finished.
  struct Part {
    std::uint64_t rays = 0;
    std::unique_ptr<RaySink> sink;
  };
  std::map<PartKey, Part> parts;
};

/// Streams a cloud into a sink for each part, which `make_sink` makes when the first ray of the part comes,
/// with rule.columns(). One pass. Rays of a part are in the order of the source. Memory: half a million rays
/// that wait for company, so that sinks are written to in large pieces, and a few chunks with their pieces;
/// whatever `make_sink` makes besides. Throws Error(out_of_range) when there would be more than kMostParts.
[[nodiscard]] Partition partition_cloud(
    const Context& context, RaySource& source, const PartitionRule& rule,
    const std::function<std::unique_ptr<RaySink>(const PartKey&)>& make_sink);

}  // namespace ray
