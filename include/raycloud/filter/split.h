#pragma once
/// Splitting a ray cloud in two: an inside and an outside, which together have every bounded end exactly once
/// and as much length of ray as the whole. What is a region of space cuts the rays that cross its border;
/// what is a property of a ray, or of its end, sorts the rays whole. The meaning of each rule is that of
/// raysplit (docs/algorithms/splitting.md); paper, section VIII-D.
///
/// A cut ray becomes pieces with all its columns, in order from the sensor. The piece with the ray's end
/// keeps it bit for bit; every other piece is unbounded, as it ends in free space. Pieces are marked in the
/// extra column `clipped`: 1 if the start is a cut, 2 if the end is, 3 for both, 0 for a whole ray. Two
/// pieces that meet have the same bits at the cut. A piece without length is left out, unless it holds a
/// bounded end.

#include <raycloud/core/cloud_info.h>
#include <raycloud/core/colour.h>
#include <raycloud/core/forest.h>
#include <raycloud/core/units.h>
#include <raycloud/exec/stream.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace ray {

/// A way to split, chunk by chunk. Immutable, so that any number of threads can use one; each ray is judged
/// by itself, so the result does not depend on chunks or threads.
class SplitRule {
 public:
  virtual ~SplitRule() = default;
  /// The extra columns of both sides: those of the source, and `clipped` if the rule cuts rays. Throws
  /// Error(wrong_content) if it does and the source has a column of that name that is not uint8.
  [[nodiscard]] virtual std::vector<ColumnInfo> columns(std::vector<ColumnInfo> source) const = 0;
  /// Replaces what `inside` and `outside` held by the rows of `rays` on either side, in their order. Where
  /// the rule cuts, `rays` gets the columns of columns(), and pieces of rays as further rows.
  virtual void apply(RayCloud& rays, std::vector<std::uint32_t>& inside,
                     std::vector<std::uint32_t>& outside) const = 0;
};
using SplitRulePtr = std::unique_ptr<const SplitRule>;

// All throw Error(usage) for values that make no sense: not finite, a negative radius, a zero vector.

/// Regions of space, which cut. `stored` is the precision of the source: cuts are rounded to it, so that in a
/// file both pieces still have the same point.

/// Inside is the side of the plane that has the origin, and the plane. `point` is the plane's point nearest
/// to the origin, and its normal. m.
[[nodiscard]] SplitRulePtr split_by_plane(const Eigen::Vector3d& point, Precision stored);
/// Inside is |x - centre| <= radii on every axis. m.
[[nodiscard]] SplitRulePtr split_by_box(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii,
                                        Precision stored);
/// Inside is what is at most `radius` from the line between the two points.
[[nodiscard]] SplitRulePtr split_by_capsule(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                            Metres radius, Precision stored);

/// Properties of a ray, which sort rays whole.

/// Inside are rays at most so long.
[[nodiscard]] SplitRulePtr split_by_range(Metres range);
/// Inside is dot(c, v) / dot(v, v) <= 1, where c is the direction of the ray from the sensor, of length 1, or
/// 0 for a ray without length.
[[nodiscard]] SplitRulePtr split_by_direction(const Eigen::Vector3d& v);
/// Inside are times up to `last`.
[[nodiscard]] SplitRulePtr split_by_time(Seconds last);
/// Inside is alpha <= floor(255 a), alpha being 0 for an unbounded ray and otherwise its intensity, at
/// least 1. Precondition by Error(usage): 0 <= a <= 1.
[[nodiscard]] SplitRulePtr split_by_alpha(double a);
/// Inside is dot(c, v) / dot(v, v) <= 1, where c is red, green and blue from 0 to 1.
[[nodiscard]] SplitRulePtr split_by_colour(const Eigen::Vector3d& v);
/// Inside are rays of exactly this red, green and blue.
[[nodiscard]] SplitRulePtr split_by_single_colour(const Colour& colour);

/// Inside are the bounded rays whose ends are in the largest connected set: ends nearer than `gap` to each
/// other are connected. Of sets of the same size it is the one that comes first in the source. Unbounded rays
/// are outside, as they end at nothing. Reads `source` from where it stands to its end; rewind it before the
/// split. Neighbourhood shape: memory 96 bytes a bounded ray while it is made, then 16 bytes for each
/// occupied cube of width gap / sqrt(3). Throws Error(out_of_range) for a cloud of more than 2^21 such cubes
/// along an axis (12 km at a gap of 1 cm).
[[nodiscard]] SplitRulePtr split_by_gap(const Context& context, RaySource& source, Metres gap);

/// Inside are rays whose ends are further than `distance` from the surface of every tree; inside the wood the
/// distance is negative. A segment is a cone that tapers from its parent's radius to its own, with round
/// ends; a tree of one segment is a sphere. Memory: the segments, and 4 bytes for each cube of a coarse grid
/// that one is near.
[[nodiscard]] SplitRulePtr split_by_trees(const Forest& forest, Metres distance);

/// Decides for all rays of a chunk: `inside`, one byte a ray, 0 before, gets 1 where the ray is inside.
/// Called by any number of threads at once; must judge each ray by itself.
using RayTest = std::function<void(const RayCloud& rays, std::span<std::uint8_t> inside)>;

/// Inside is what the test says: for properties that other rooms know, such as the distance from a mesh.
[[nodiscard]] SplitRulePtr split_by_test(RayTest test);

/// The time at `fraction` of the way from the earliest ray to the latest. Reads the source to its end; rewind
/// it before the split. 0 for a cloud without rays. Precondition by Error(usage): 0 <= fraction <= 1.
[[nodiscard]] Seconds time_at(const Context& context, RaySource& source, double fraction);

struct SplitCounts {
  StreamCounts stream;
  std::uint64_t inside = 0;   ///< rays and pieces
  std::uint64_t outside = 0;  ///< rays and pieces
};

/// Streams a cloud into two sinks made with rule.columns(). Does not finish them. Memory: a few chunks.
SplitCounts split_cloud(const Context& context, RaySource& source, const SplitRule& rule, RaySink& inside,
                        RaySink& outside);

}  // namespace ray
