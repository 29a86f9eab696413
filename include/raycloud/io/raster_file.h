#pragma once
/// Rasters as files that every GIS reads: GeoTIFF.

#include <raycloud/core/raster.h>
#include <raycloud/io/file_options.h>

#include <filesystem>
#include <string>

namespace ray {

/// One band of 32 bit reals in compressed tiles, with overviews of half the size each, in the order that is
/// read well over a network ("cloud-optimised"). Cells without a value hold -9999, which the file states.
/// `crs` is as CloudInfo::crs: "EPSG:n", or WKT, of which the EPSG code is stated where it has one and the
/// text itself where it has not; empty for none. Atomic. Memory: 15 bytes a cell.
///
/// Throws Error(usage) for an extension other than .tif and .tiff, Error(out_of_range) for a raster without
/// cells or of more than kMostRasterCells, Error(file_access) where it cannot be written.
void write_raster(const std::filesystem::path& path, const Raster& raster, const std::string& crs,
                  const WriteOptions& options = {});

inline constexpr std::size_t kMostRasterCells = std::size_t{1} << 28;

}  // namespace ray
