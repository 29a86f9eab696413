#include <raycloud/core/error.h>
#include <raycloud/core/ray_cloud.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

namespace ray {

namespace {

template <class T>
void select_rows(std::vector<T>& column, std::span<const std::uint8_t> mask) {
  std::size_t kept = 0;
  for (std::size_t row = 0; row < mask.size(); ++row) {
    // Without a branch: whether a ray is kept is often close to a coin toss.
    column[kept] = column[row];
    kept += mask[row] != 0 ? 1 : 0;
  }
  column.resize(kept);
}

/// Goes through chosen rows of a column.
template <class T>
struct ChosenRow {
  using iterator_category = std::random_access_iterator_tag;
  using value_type = T;
  using difference_type = std::ptrdiff_t;
  using pointer = const T*;
  using reference = const T&;

  const T* column;
  const std::uint32_t* row;

  reference operator*() const { return column[*row]; }
  ChosenRow& operator++() {
    ++row;
    return *this;
  }
  ChosenRow& operator--() {
    --row;
    return *this;
  }
  ChosenRow& operator+=(difference_type steps) {
    row += steps;
    return *this;
  }
  difference_type operator-(const ChosenRow& other) const { return row - other.row; }
  bool operator==(const ChosenRow& other) const { return row == other.row; }
};

/// Unlike resizing first, writes no row twice.
template <class T>
void gather_rows(std::vector<T>& to, const std::vector<T>& from, std::span<const std::uint32_t> rows) {
  to.assign(ChosenRow<T>{from.data(), rows.data()}, ChosenRow<T>{from.data(), rows.data() + rows.size()});
}

}  // namespace

void RayCloud::resize(std::size_t rows) {
  starts.resize(rows);
  ends.resize(rows);
  times.resize(rows);
  colours.resize(rows);
  bounded.resize(rows);
  for (Column& column : extras)
    column.resize(rows);
}

void RayCloud::reserve(std::size_t rows) {
  starts.reserve(rows);
  ends.reserve(rows);
  times.reserve(rows);
  colours.reserve(rows);
  bounded.reserve(rows);
}

void RayCloud::select(std::span<const std::uint8_t> mask) {
  assert(mask.size() == size());
  if (std::all_of(mask.begin(), mask.end(), [](std::uint8_t keep) { return keep != 0; })) return;
  select_rows(starts, mask);
  select_rows(ends, mask);
  select_rows(times, mask);
  select_rows(colours, mask);
  select_rows(bounded, mask);
  for (Column& column : extras)
    column.select(mask);
}

void RayCloud::assign_rows(const RayCloud& from, std::span<const std::uint32_t> rows) {
  gather_rows(starts, from.starts, rows);
  gather_rows(ends, from.ends, rows);
  gather_rows(times, from.times, rows);
  gather_rows(colours, from.colours, rows);
  gather_rows(bounded, from.bounded, rows);
  set_schema(schema_of(from));
  for (std::size_t c = 0; c < extras.size(); ++c) {
    visit_scalar(extras[c].type(), [&]<class T>() {
      const std::span<const T> values = from.extras[c].values<T>();
      const std::span<T> to = extras[c].values<T>();
      for (std::size_t i = 0; i < rows.size(); ++i)
        to[i] = values[rows[i]];
    });
  }
}

void RayCloud::keep_rows(std::span<const std::uint32_t> rows) {
  if (std::adjacent_find(rows.begin(), rows.end(), std::greater_equal<>()) != rows.end()) {
    RayCloud kept;
    kept.assign_rows(*this, rows);
    *this = std::move(kept);
    return;
  }
  // No row comes from before its new place, so none is overwritten that is still needed.
  const auto keep = [rows](auto* column) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      column[i] = column[rows[i]];
  };
  keep(starts.data());
  keep(ends.data());
  keep(times.data());
  keep(colours.data());
  keep(bounded.data());
  for (Column& column : extras)
    visit_scalar(column.type(), [&]<class T>() { keep(column.values<T>().data()); });
  resize(rows.size());
}

void RayCloud::append(const RayCloud& other) {
  const std::size_t old_rows = size();
  for (const Column& column : other.extras) {
    const Column* mine = extra(column.name());
    if (mine == nullptr) {
      extras.emplace_back(column.info(), old_rows);
    } else if (mine->type() != column.type()) {
      throw Error(ErrorCode::wrong_content, "column " + column.name() + " is " +
                                                std::string(name_of(mine->type())) + " in one cloud and " +
                                                std::string(name_of(column.type())) + " in another");
    }
  }
  starts.insert(starts.end(), other.starts.begin(), other.starts.end());
  ends.insert(ends.end(), other.ends.begin(), other.ends.end());
  times.insert(times.end(), other.times.begin(), other.times.end());
  colours.insert(colours.end(), other.colours.begin(), other.colours.end());
  bounded.insert(bounded.end(), other.bounded.begin(), other.bounded.end());
  for (Column& column : extras) {
    if (const Column* theirs = other.extra(column.name())) {
      column.append(*theirs);
    } else {
      column.resize(ends.size());
    }
  }
}

void RayCloud::transform(const Pose& pose) {
  if (pose.rotation == Eigen::Matrix3d::Identity()) {  // a sum instead of a product, with the same bits
    for (Eigen::Vector3d& start : starts)
      start += pose.translation;
    for (Eigen::Vector3d& end : ends)
      end += pose.translation;
    return;
  }
  for (Eigen::Vector3d& start : starts)
    start = pose * start;
  for (Eigen::Vector3d& end : ends)
    end = pose * end;
}

Column* RayCloud::extra(std::string_view name) {
  const auto found =
      std::find_if(extras.begin(), extras.end(), [&](const Column& c) { return c.name() == name; });
  return found == extras.end() ? nullptr : &*found;
}

const Column* RayCloud::extra(std::string_view name) const {
  return const_cast<RayCloud*>(this)->extra(name);
}

void RayCloud::set_schema(const std::vector<ColumnInfo>& schema) {
  if (schema_of(*this) != schema) {
    extras.clear();
    for (const ColumnInfo& info : schema)
      extras.emplace_back(info);
  }
  for (Column& column : extras)
    column.resize(size());
}

std::vector<ColumnInfo> schema_of(const RayCloud& rays) {
  std::vector<ColumnInfo> schema;
  schema.reserve(rays.extras.size());
  for (const Column& column : rays.extras)
    schema.push_back(column.info());
  return schema;
}

bool is_finite_ray(const RayCloud& rays, std::size_t i) {
  return rays.starts[i].allFinite() && rays.ends[i].allFinite() && std::isfinite(rays.times[i]);
}

std::size_t drop_not_finite(RayCloud& rays) {
  double sum = 0.0;  // 0 · x is NaN for NaN and for infinity
  for (std::size_t i = 0; i < rays.size(); ++i)
    sum += 0.0 * (rays.starts[i].sum() + rays.ends[i].sum() + rays.times[i]);
  if (sum == 0.0) return 0;
  const std::size_t before = rays.size();
  std::vector<std::uint8_t> finite(before);
  for (std::size_t i = 0; i < before; ++i)
    finite[i] = is_finite_ray(rays, i) ? 1 : 0;
  rays.select(finite);
  return before - rays.size();
}

}  // namespace ray
