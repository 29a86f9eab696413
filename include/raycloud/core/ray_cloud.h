#pragma once
/// The one noun: a table of rays, used for a whole cloud and for a chunk of one alike.

#include <raycloud/core/bounds.h>
#include <raycloud/core/colour.h>
#include <raycloud/core/column.h>
#include <raycloud/core/pose.h>

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace ray {

/// A ray goes from the sensor (`starts`) to the point it hit (`ends`). All columns, extras included, have
/// size() rows; whoever fills them directly keeps that true. 61 bytes a ray plus the extras.
///
/// Row operations act on every column at once, so a tool that keeps or drops rays by `select` cannot lose a
/// column, the order, or a bit.
struct RayCloud {
  std::vector<Eigen::Vector3d> starts;  ///< m
  std::vector<Eigen::Vector3d> ends;    ///< m
  std::vector<double> times;            ///< s
  std::vector<Colour> colours;
  std::vector<std::uint8_t>
      bounded;                 ///< 1: the end is a surface; 0: nothing was hit within range (free space only)
  std::vector<Column> extras;  ///< named columns of any scalar type

  [[nodiscard]] std::size_t size() const { return ends.size(); }
  [[nodiscard]] bool empty() const { return ends.empty(); }

  /// New rows are zero rays at the origin (vectors and times undefined until written), white and unbounded.
  void resize(std::size_t rows);
  void reserve(std::size_t rows);

  /// Keeps the rows where `mask` is not 0, in order. Precondition: one byte per ray.
  void select(std::span<const std::uint8_t> mask);

  /// Replaces all by the given rows of `from`, another cloud, in the given order, with all its columns.
  void assign_rows(const RayCloud& from, std::span<const std::uint32_t> rows);

  /// Keeps the given rows, in the given order; in place if that is the order they have.
  void keep_rows(std::span<const std::uint32_t> rows);

  /// Adds the rows of `other`. Columns are matched by name: the result has the columns of both, with zeros
  /// where one of them has none. Throws Error(wrong_content) if a column of the same name has another type.
  void append(const RayCloud& other);

  /// Moves starts and ends.
  void transform(const Pose& pose);

  /// The extra column of that name, or nullptr.
  [[nodiscard]] Column* extra(std::string_view name);
  [[nodiscard]] const Column* extra(std::string_view name) const;

  /// Makes the extra columns those of `schema`, in that order, with size() rows each; does nothing but resize
  /// where they already are.
  void set_schema(const std::vector<ColumnInfo>& schema);
};

[[nodiscard]] std::vector<ColumnInfo> schema_of(const RayCloud& rays);

/// True if every coordinate and the time of row `i` is finite.
[[nodiscard]] bool is_finite_ray(const RayCloud& rays, std::size_t i);

/// Leaves out the rays that are not finite and returns how many they were. Quick where there are none.
std::size_t drop_not_finite(RayCloud& rays);

}  // namespace ray
