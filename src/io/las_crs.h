#pragma once
/// Coordinate systems as LAS stores them: WKT, or the keys of GeoTIFF.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ray {

/// Without its final zeros, line breaks as spaces; empty if it is no WKT.
[[nodiscard]] std::string one_line_wkt(std::span<const std::byte> record);

/// "EPSG:n" from a GeoKeyDirectoryTag, or empty: a projected system before a geographic one.
[[nodiscard]] std::string epsg_of_geokeys(std::span<const std::byte> record);

/// A GeoKeyDirectoryTag for "EPSG:n"; empty if `crs` is anything else or beyond 16 bits. Which kind of system
/// a code is only a database knows; 4000–4999, where EPSG keeps the geographic ones, are taken as such.
[[nodiscard]] std::vector<std::byte> geokeys_of_epsg(std::string_view crs);

[[nodiscard]] bool is_wkt(std::string_view crs);

}  // namespace ray
