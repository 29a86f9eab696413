#pragma once
/// Sorting rays into parts, whole or cut to pieces, with all their columns.

#include <raycloud/core/cloud_info.h>
#include <raycloud/core/ray_cloud.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ray {

/// Flags of the column `clipped`.
inline constexpr std::uint8_t kStartCut = 1;
inline constexpr std::uint8_t kEndCut = 2;

/// A stretch of a ray's way through the parts of space: it is in `part` up to the point `to`.
struct Stretch {
  std::uint32_t part = 0;
  Eigen::Vector3d to;
};

/// Which rows of a chunk, and which pieces of them, belong to a part, in the order of the file.
class RayPieces {
 public:
  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  void add(std::size_t row) { rows_.push_back(static_cast<std::uint32_t>(row)); }
  void add(std::size_t row, const Eigen::Vector3d& start, const Eigen::Vector3d& end, std::uint8_t flags);

  /// Replaces `out` by the pieces. A piece whose end is cut is unbounded. If `marked`, its flags are joined
  /// to those the ray has in the column `clipped`, which is added where there is none.
  void gather(const RayCloud& rays, bool marked, RayCloud& out) const;

 private:
  struct Cut {
    std::size_t piece;
    Eigen::Vector3d start;
    Eigen::Vector3d end;
    std::uint8_t flags;
  };
  std::vector<std::uint32_t> rows_;
  std::vector<Cut> cuts_;
};

/// Calls `add(part, start, end, flags)` for the pieces of a ray whose way is `way`, the last stretch of which
/// ends where the ray does. A piece without length is left out, unless it holds a bounded end; so an
/// unbounded ray that ends on a border stays in the part that it came through.
template <class Add>
void each_piece(const Eigen::Vector3d& start, bool bounded, std::vector<Stretch>& way, const Add& add) {
  if (way.size() > 1 && !bounded && way.back().to == way[way.size() - 2].to) way.pop_back();
  Eigen::Vector3d from = start;
  std::uint8_t flags = 0;
  for (std::size_t i = 0; i < way.size(); ++i) {
    const bool last = i + 1 == way.size();
    if (!last && way[i].to == from) continue;
    add(way[i].part, from, way[i].to, static_cast<std::uint8_t>(flags | (last ? 0 : kEndCut)));
    from = way[i].to;
    flags = kStartCut;
  }
}

/// A piece of the ray in a row.
struct CutPiece {
  std::size_t row = 0;
  Eigen::Vector3d start;
  Eigen::Vector3d end;
  std::uint8_t flags = 0;
};

/// Adds the pieces as rows behind the others, each with all columns of its ray, as RayPieces::gather marks
/// them.
void append_pieces(RayCloud& rays, std::span<const CutPiece> pieces);

/// Adds the rows [begin, end) of `from`, which has the same columns. An empty `to` takes its columns.
void append_rows(RayCloud& to, const RayCloud& from, std::size_t begin, std::size_t end);

/// `extras` with the column `clipped`. Throws Error(wrong_content) if there is one of another type.
[[nodiscard]] std::vector<ColumnInfo> with_clipped(std::vector<ColumnInfo> extras);

/// The point where a ray is cut, rounded to what a file of this precision holds; the ray's start or end where
/// it is that to rounding, so that splitting a piece again leaves no splinters.
[[nodiscard]] Eigen::Vector3d cut_point(const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                                        const Eigen::Vector3d& computed, Precision stored);

}  // namespace ray
