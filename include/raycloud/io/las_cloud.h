#pragma once
/// LAS 1.0–1.4 and LAZ files (COPC included) of points, and the compressed ray cloud (docs/formats.md):
/// LAS 1.4, point format 7, with the sensor position in the extra bytes BeamOriginX, BeamOriginY,
/// BeamOriginZ, the names PDAL uses, and `Bounded` and `Alpha`.
///
/// Columns of a file made elsewhere, by the standard's names: intensity (uint16), return_number,
/// number_of_returns, classification, flags, user_data (uint8), scan_angle (float32, degrees),
/// point_source_id (uint16); then nir (uint16) and the waveform packet's fields where the point format has
/// them; these are info().formal_extras. Then the extra bytes with their own names and types: as float64
/// where the file gives them a scale or offset, arrays as NAME_0, NAME_1 …, bytes nobody described as
/// extra_byte_0 …. `flags` is laid out as in LAS 1.4 for every point format: bit 0 synthetic, 1 key point, 2
/// withheld, 3 overlap, 4–5 scanner channel, 6 scan direction, 7 edge of flight line. A column that has the
/// name of an earlier one gets `_2` (or the next number that is free) behind its own. no_data values are kept
/// as they are.
///
/// Times are as stored; info().time_base says whether they are seconds of the GPS week or GPS seconds − 1e9.
/// Colours are 16 bits in the file and 8 in a ray cloud: the high byte, unless no value of the whole file
/// exceeds 255, as in old files, which then are 8-bit colours already. To be sure of that, a file whose first
/// coloured points are all below 256 is read twice. The low byte is not kept.
///
/// info().crs is the WKT, or "EPSG:n" from GeoTIFF keys.

#include <raycloud/core/ray_stream.h>
#include <raycloud/io/file_options.h>

#include <filesystem>
#include <memory>

namespace ray {

/// Opens points to import. Sensor positions are there (info().present.starts) if the file has BeamOrigin
/// extra bytes, else starts equal ends; all rays are bounded unless `Bounded`, or an `Alpha` of 0 among
/// points exported from a ray cloud, says otherwise. Whether a whole uncompressed file is there is checked
/// now. Chunks of a LAZ file follow its own division and may be longer than `options.chunk_rays`, up to 65536
/// rays; they are decompressed on as many threads as call `decode`, except where a file has no such division
/// (LASzip 1), a larger one, or a variable one that is not COPC.
///
/// Throws Error: file_not_found, file_access, file_format (not LAS, cut, damaged: "x.laz: damaged after point
/// 100000 of 531662": the points before are sure; also from decode and fetch).
[[nodiscard]] std::unique_ptr<RaySource> open_las_points(const std::filesystem::path& path,
                                                         const ReadOptions& options = {});

/// Opens a ray cloud. Throws as open_las_points does, and Error(wrong_content) where there are no
/// BeamOrigins.
[[nodiscard]] std::unique_ptr<RaySource> open_las(const std::filesystem::path& path,
                                                  const ReadOptions& options = {});

/// Stores rays; compressed if the extension of `path` is `.laz` in either case, or if WriteOptions::format
/// is.
///
/// Scale and offset of each axis are chosen when all rays are known, from a temporary file beside the target
/// that has no name (61 bytes a ray plus extras): the scale is the source's own step if all coordinates lie
/// on such a grid, else 0.0001 or the step where that is finer, and coarser in steps of 1, 2, 5 only where 32
/// bits cannot span the cloud. Nothing is clamped. Times keep every bit. A column that has the name and type
/// of a standard field goes there if all its values survive, else into extra bytes, as all others do; names,
/// types and order are stated in a VLR of user id "raycloud", with the CRS, history and comments, so that
/// open_las gives back every column exactly. A CRS in WKT is stored as the standard says, "EPSG:n" as GeoTIFF
/// keys. The file is the same for every chunking and every thread count. Memory: the chunks. Cost of
/// `finish`: about 0.4 µs a ray for LAZ.
///
/// Throws Error: file_access, out_of_range (a NaN or infinite coordinate or time; more columns than LAS can
/// hold).
[[nodiscard]] std::unique_ptr<RaySink> create_las(const std::filesystem::path& path, const CloudInfo& info,
                                                  const WriteOptions& options = {});

/// Stores points: as create_las, without starts and `Bounded`, without `Alpha` unless info.present.intensity,
/// and in point format 6 where there are no colours.
[[nodiscard]] std::unique_ptr<RaySink> create_las_points(const std::filesystem::path& path,
                                                         const CloudInfo& info,
                                                         const WriteOptions& options = {});

}  // namespace ray
