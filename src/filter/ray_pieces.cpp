#include "ray_pieces.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <string>

namespace ray {
namespace {

constexpr const char* kClipped = "clipped";

/// The column, added with zeros where there is none.
std::span<std::uint8_t> clipped_column(RayCloud& rays) {
  const std::vector<ColumnInfo> columns = with_clipped(schema_of(rays));
  if (columns.size() > rays.extras.size()) rays.extras.emplace_back(columns.back(), rays.size());
  return rays.extra(kClipped)->values<std::uint8_t>();
}

/// Makes a row, which is the whole ray, a piece of it.
void cut_row(RayCloud& rays, std::span<std::uint8_t> clipped, std::size_t row, const Eigen::Vector3d& start,
             const Eigen::Vector3d& end, std::uint8_t flags) {
  rays.starts[row] = start;
  rays.ends[row] = end;
  clipped[row] |= flags;
  if ((flags & kEndCut) != 0) rays.bounded[row] = 0;
}

template <class T>
void append_range(std::vector<T>& to, const std::vector<T>& from, std::size_t begin, std::size_t end) {
  to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(begin),
            from.begin() + static_cast<std::ptrdiff_t>(end));
}

}  // namespace

void RayPieces::add(std::size_t row, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                    std::uint8_t flags) {
  if (flags != 0) cuts_.push_back({rows_.size(), start, end, flags});
  add(row);
}

void RayPieces::gather(const RayCloud& rays, bool marked, RayCloud& out) const {
  out.assign_rows(rays, rows_);
  if (!marked) return;
  const std::span<std::uint8_t> clipped = clipped_column(out);
  for (const Cut& cut : cuts_)
    cut_row(out, clipped, cut.piece, cut.start, cut.end, cut.flags);
}

void append_pieces(RayCloud& rays, std::span<const CutPiece> pieces) {
  const std::size_t first = rays.size();
  rays.resize(first + pieces.size());
  const std::span<std::uint8_t> clipped = clipped_column(rays);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::size_t row = pieces[i].row, piece = first + i;
    rays.times[piece] = rays.times[row];
    rays.colours[piece] = rays.colours[row];
    rays.bounded[piece] = rays.bounded[row];
    for (Column& column : rays.extras)
      std::copy_n(column.data() + row * column.stride(), column.stride(),
                  column.data() + piece * column.stride());
    cut_row(rays, clipped, piece, pieces[i].start, pieces[i].end, pieces[i].flags);
  }
}

void append_rows(RayCloud& to, const RayCloud& from, std::size_t begin, std::size_t end) {
  append_range(to.starts, from.starts, begin, end);
  append_range(to.ends, from.ends, begin, end);
  append_range(to.times, from.times, begin, end);
  append_range(to.colours, from.colours, begin, end);
  append_range(to.bounded, from.bounded, begin, end);
  if (to.extras.size() != from.extras.size()) {
    to.extras.clear();
    for (const Column& column : from.extras)
      to.extras.emplace_back(column.info());
  }
  for (std::size_t c = 0; c < from.extras.size(); ++c) {
    const std::size_t stride = from.extras[c].stride();
    const std::size_t old_rows = to.extras[c].size();
    to.extras[c].resize(to.size());
    std::copy(from.extras[c].data() + begin * stride, from.extras[c].data() + end * stride,
              to.extras[c].data() + old_rows * stride);
  }
}

std::vector<ColumnInfo> with_clipped(std::vector<ColumnInfo> extras) {
  const auto found = std::find_if(extras.begin(), extras.end(),
                                  [](const ColumnInfo& column) { return column.name == kClipped; });
  if (found == extras.end()) {
    extras.push_back({kClipped, ScalarType::uint8});
  } else if (found->type != ScalarType::uint8) {
    throw Error(ErrorCode::wrong_content,
                "the column clipped is " + std::string(name_of(found->type)) +
                    ", not uint8: rename it, as pieces of rays are marked in a column of that name");
  }
  return extras;
}

Eigen::Vector3d cut_point(const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                          const Eigen::Vector3d& computed, Precision stored) {
  const bool single = stored == Precision::single;
  const Eigen::Vector3d point = single ? Eigen::Vector3d(computed.cast<float>().cast<double>()) : computed;
  const double largest = std::max(start.cwiseAbs().maxCoeff(), end.cwiseAbs().maxCoeff());
  const double rounding = 8.0 * largest * (single ? 0x1p-24 : 0x1p-53);
  if ((point - end).cwiseAbs().maxCoeff() <= rounding) return end;
  if ((point - start).cwiseAbs().maxCoeff() <= rounding) return start;
  return point;
}

}  // namespace ray
