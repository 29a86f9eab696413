#pragma once
/// Points as text: `.xyz .txt .csv .asc .pts`, one point a line.
///
/// Separators are commas, semicolons, tabs or spaces; lines end in LF or CRLF; empty lines and those that
/// start with
/// `#`, `%` or `//` are skipped. Columns are named by a heading line (also one in a comment or in quotes), as
/// `x y z`, `time|timestamp|gps_time|gpstime|t`, `red green blue` or `r g b`, `intensity`, `alpha` (the 8-bit
/// intensity of a ray cloud, 0 for an unbounded ray), `origin_x …`, `beamoriginx …`, `sensor_x …` or `start_x
/// …` (the sensor's position); capitals do not matter. Without a heading the first three are x y z and a
/// fourth is time if it never decreases in the sample read on opening, takes several values and is not a
/// whole number below 65536 throughout, else intensity; then three whole numbers from 0 to 255 are a colour.
/// Any other column becomes an extra: `intensity` and what no one names as float64; the integer fields of LAS
/// (classification, return_number …) as the types LAS gives them. A coordinate of more than 9
/// significant digits makes info().precision double. info().comments says what was decided where
/// no heading told.

#include <raycloud/core/ray_stream.h>
#include <raycloud/io/file_options.h>

#include <filesystem>
#include <memory>

namespace ray {

/// Opens and reads the first 256 KiB to learn the columns. A row with NaN, infinity or (with commas) nothing
/// in a coordinate or time is left out and counted; a row that is not numbers, or has too many or too few,
/// makes decode throw Error(file_format) with its line. Colours are 0 to 255, or 0 to 65535 where the sample
/// has one above 255, or fractions where no value of the sample is above 1 and one is not whole. A lone whole
/// number before the points
/// (`.pts`) is their count, and has to be right. Memory: one chunk, or the longest line.
[[nodiscard]] std::unique_ptr<RaySource> open_text_points(const std::filesystem::path& path,
                                                          const ReadOptions& options = {});

/// Writes `x y z time red green blue alpha` and the extras under a heading, with commas for `.csv`, else
/// spaces. `starts` are not written. Each number is the shortest that reads back to the same bits, except
/// that coordinates which are exactly floats are written as floats if info.precision is single. The file
/// appears on finish. Throws Error(file_access).
[[nodiscard]] std::unique_ptr<RaySink> create_text_points(const std::filesystem::path& path,
                                                          const CloudInfo& info,
                                                          const WriteOptions& options = {});

}  // namespace ray
