#include "ray_pieces.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <string>

namespace ray {
namespace {

constexpr const char* kClipped = "clipped";

/// One loop for all columns: the rows stay in the nearest cache.
void gather_rows(const RayCloud& from, const std::vector<std::uint32_t>& rows, RayCloud& to) {
  to.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::uint32_t row = rows[i];
    to.starts[i] = from.starts[row];
    to.ends[i] = from.ends[row];
    to.times[i] = from.times[row];
    to.colours[i] = from.colours[row];
    to.bounded[i] = from.bounded[row];
  }
}

/// Every value is written to both sides and stays in one: a branch would be mispredicted as often as not.
/// Both have room for one value more than they get.
template <class T>
void sort_values(const T* from, std::span<const std::uint8_t> mask, T* kept, T* others) {
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const std::ptrdiff_t keep = mask[i] != 0 ? 1 : 0;
    *kept = *others = from[i];
    kept += keep;
    others += 1 - keep;
  }
}

template <class T>
void append_range(std::vector<T>& to, const std::vector<T>& from, std::size_t begin, std::size_t end) {
  to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(begin),
            from.begin() + static_cast<std::ptrdiff_t>(end));
}

}  // namespace

void RayPieces::clear() {
  rows_.clear();
  cuts_.clear();
}

void RayPieces::add(std::size_t row, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                    std::uint8_t flags) {
  if (flags != 0) cuts_.push_back({rows_.size(), start, end, flags});
  add(row);
}

void RayPieces::gather(const RayCloud& rays, bool marked, RayCloud& out) const {
  gather_rows(rays, rows_, out);
  const std::vector<ColumnInfo> columns = schema_of(rays);
  out.set_schema(marked ? with_clipped(columns) : columns);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    visit_scalar(columns[c].type, [&]<class T>() {
      const std::span<const T> from = rays.extras[c].values<T>();
      const std::span<T> to = out.extras[c].values<T>();
      for (std::size_t i = 0; i < rows_.size(); ++i)
        to[i] = from[rows_[i]];
    });
  }
  if (!marked) return;
  const std::span<std::uint8_t> clipped = out.extra(kClipped)->values<std::uint8_t>();
  // A column that was just added may hold what an earlier chunk left in it.
  if (out.extras.size() > columns.size()) std::fill(clipped.begin(), clipped.end(), std::uint8_t{0});
  for (const Cut& cut : cuts_) {
    out.starts[cut.piece] = cut.start;
    out.ends[cut.piece] = cut.end;
    clipped[cut.piece] |= cut.flags;
    if ((cut.flags & kEndCut) != 0) out.bounded[cut.piece] = 0;
  }
}

void sort_rows(const RayCloud& rays, std::span<const std::uint8_t> mask, RayCloud& kept, RayCloud& others) {
  std::size_t count = 0;
  for (const std::uint8_t keep : mask)
    count += keep != 0 ? 1 : 0;
  const std::vector<ColumnInfo> columns = schema_of(rays);
  for (RayCloud* side : {&kept, &others}) {
    side->set_schema(columns);
    side->resize((side == &kept ? count : rays.size() - count) + 1);
  }
  sort_values(rays.starts.data(), mask, kept.starts.data(), others.starts.data());
  sort_values(rays.ends.data(), mask, kept.ends.data(), others.ends.data());
  sort_values(rays.times.data(), mask, kept.times.data(), others.times.data());
  sort_values(rays.colours.data(), mask, kept.colours.data(), others.colours.data());
  sort_values(rays.bounded.data(), mask, kept.bounded.data(), others.bounded.data());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    visit_scalar(columns[c].type, [&]<class T>() {
      sort_values(rays.extras[c].values<T>().data(), mask, kept.extras[c].values<T>().data(),
                  others.extras[c].values<T>().data());
    });
  }
  kept.resize(count);
  others.resize(rays.size() - count);
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
