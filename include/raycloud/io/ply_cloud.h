#pragma once
/// PLY files of rays and of points, in every spelling the format allows (docs/formats.md): any property order
/// and scalar type, ascii and both byte orders, lists and further elements skipped.
///
/// Reading. `start = end + (nx, ny, nz)`, or `rayx rayy rayz`. Alpha 0 means unbounded; a missing alpha is
/// 255, a missing colour white. Colours of 16-bit or floating type are scaled to 8 bits by what a sample of
/// the file shows their range to be (0…1, 0…255 or 0…65535). Time may be called time, timestamp, gps_time,
/// GpsTime, t and the like. `comment origin x y z` is added to the coordinates. Every other property becomes
/// an extra column with its own name and type; `NAME__low` and `NAME__high` are joined to one 64-bit column
/// NAME.
///
/// Writing. Little endian: x y z, time, nx ny nz, red green blue alpha, then the extras. A bounded ray has
/// alpha max(1, intensity), an unbounded one 0. 64-bit integer columns, which PLY lacks, become two: `uint
/// NAME__low` and `NAME__high`, int if the column is signed, else uint.
///
/// Round trips. Ends, times, colours and extras keep every bit. The end-to-sensor vector of a
/// single-precision file comes back bit for bit, but for the sign of a zero, if it is longer than 2^-28 of
/// the start's coordinate (4 µm at 1 km); otherwise, and in double precision, it is within 2^-51 of the
/// larger coordinate (3 nm at 6900 km), and stays the same from then on.

#include <raycloud/core/ray_stream.h>
#include <raycloud/io/file_options.h>

#include <filesystem>
#include <memory>

namespace ray {

/// Opens a ray cloud. Its header, and for binary files its size, are checked now, so that a cut file is
/// refused before anything is written. Throws Error: file_not_found, file_access, file_format (not PLY, cut,
/// damaged), and wrong_content for a mesh or a point cloud, which includes files without `comment raycloud
/// version` whose vectors, in a sample of at least 4 rows, all have length 1, as surface normals do.
[[nodiscard]] std::unique_ptr<RaySource> open_ply(const std::filesystem::path& path,
                                                  const ReadOptions& options = {});

/// Opens points to import. Starts are there (info().present.starts) if the file is a ray cloud; otherwise
/// they equal the ends, and `nx ny nz`, being surface normals, are the extra columns normal_x, normal_y and
/// normal_z. An intensity by any of its usual names is the extra column `intensity`. Throws as open_ply does,
/// except for content.
[[nodiscard]] std::unique_ptr<RaySource> open_ply_points(const std::filesystem::path& path,
                                                         const ReadOptions& options = {});

/// Stores rays in `info.precision`; the single-precision sink throws PrecisionLoss from encode as RaySink
/// says. Throws Error(out_of_range) for a NaN or infinite coordinate or time, Error(usage) for an extra
/// column that has a standard column's name. Spaces in the names of extra columns become `_`.
[[nodiscard]] std::unique_ptr<RaySink> create_ply(const std::filesystem::path& path, const CloudInfo& info,
                                                  const WriteOptions& options = {});

/// Stores ends only, with those of time, colour and alpha that `info.present` names, and the extras.
[[nodiscard]] std::unique_ptr<RaySink> create_ply_points(const std::filesystem::path& path,
                                                         const CloudInfo& info,
                                                         const WriteOptions& options = {});

}  // namespace ray
