#pragma once
/// What a stream of rays says about itself before the first ray: the header of a file, without the file.

#include <raycloud/core/column.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace ray {

/// How coordinates are stored. In memory they are always double.
enum class Precision { single, double_ };

/// Which standard columns the source really had. A ray cloud has all of them; points to import may lack some,
/// and a missing column then holds the default in every row.
struct Present {
  bool starts = true;     ///< sensor positions; else starts equal ends
  bool times = true;      ///< else 0
  bool colours = true;    ///< red, green, blue; else white
  bool intensity = true;  ///< 8-bit alpha; else 255 and bounded
};

struct CloudInfo {
  std::optional<std::uint64_t> ray_count;  ///< rows the source states, invalid ones included
  Precision precision = Precision::single;
  double coordinate_step = 0.0;    ///< m; the source's own resolution (the scale of a LAS file), 0 if unknown
  std::vector<ColumnInfo> extras;  ///< schema of RayCloud::extras in every chunk
  /// Names of extras that the source's format has whether they were recorded or not; zeros throughout mean
  /// not.
  std::vector<std::string> formal_extras;
  std::string crs;                    ///< WKT or "EPSG:n", on one line; empty if unknown
  std::string time_base;              ///< "gps_week", "gps_adjusted", "made_up"; empty if unknown
  std::vector<std::string> history;   ///< one line a command, oldest first, without file names
  std::vector<std::string> comments;  ///< every other comment of the source, kept as it is
  Present present;
};

}  // namespace ray
