#pragma once
/// What the columns of a text trajectory are.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ray::text {

/// Indices into a row.
struct TrajectoryColumns {
  std::size_t time = 0;
  std::array<std::size_t, 3> position{};                  ///< x, y, z
  std::optional<std::array<std::size_t, 4>> orientation;  ///< w, x, y, z
  double time_scale = 1.0;                                ///< that the heading names
  std::string decided_by;                                 ///< "heading", "content" …
};

using Row = std::vector<double>;

/// Empty unless the names have a time and x, y and z.
[[nodiscard]] std::optional<TrajectoryColumns> columns_from_names(const std::vector<std::string>& names);

/// Precondition: rows are of one length of at least 4.
[[nodiscard]] TrajectoryColumns columns_from_content(const std::vector<Row>& rows, bool w_last);

/// "t,x,y,z,qw,qx,qy,qz" as the option `format` would say it.
[[nodiscard]] std::string format_of(const TrajectoryColumns& columns, std::size_t count);

/// The number of leading columns a row needs.
[[nodiscard]] std::size_t width_of(const TrajectoryColumns& columns);

}  // namespace ray::text
