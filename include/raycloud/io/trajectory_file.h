#pragma once
/// Sensor paths as files: the native text, TUM, CSV, and any point file with times (PLY, LAS, LAZ). Reading
/// decides by content what the columns are and says what it decided.

#include <raycloud/core/trajectory.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace ray {

struct TrajectoryReadOptions {
  /// What the columns of a text file are, such as "t,x,y,z,qw,qx,qy,qz" ("-" skips a column); empty: found
  /// from the heading, the extension or the content.
  std::string format;
  double time_scale = 1.0;   ///< > 0; time of a node = time in the file · scale + offset
  double time_offset = 0.0;  ///< s
};

struct TrajectoryFile {
  Trajectory trajectory;           ///< never empty, every number finite
  std::vector<std::string> notes;  ///< what was decided or put right, one line each without the file's name
};

/// Reads `.ply`, `.las`, `.laz` as points with times and everything else as text. Nodes are sorted by time,
/// nodes of one time are merged into the first of them, rows with a NaN or infinite value are left out; a
/// note tells of each. Throws Error(file_not_found, file_access), Error(file_format) naming the line that is
/// not a row of numbers, and Error(no_data) if no node remains. Memory: the file and its nodes.
[[nodiscard]] TrajectoryFile read_trajectory(const std::filesystem::path& path,
                                             const TrajectoryReadOptions& options = {});

/// The text forms of read_trajectory, from memory; `name` is what errors call it, and its extension `.tum`
/// says that quaternions end with w.
///
/// Lines are `time x y z [qw qx qy qz …]`, separated by spaces, tabs, commas or semicolons; empty lines and
/// those that start with `%`, `#` or `//` are skipped, except that one of words (`%time x y z`) before the
/// first row is the heading; one that names nanoseconds (EuRoC: `#timestamp [ns]`) is believed unless a
/// time_scale is given. Without a heading time is the first column, unless there are four of which the last
/// never decreases and the first does; the next three are the position, and four adjacent numbers of unit
/// length in every row are the orientation. Its w is the first or the last of them, whichever keeps the
/// sensor more level.
[[nodiscard]] TrajectoryFile parse_trajectory(std::string_view text, const std::string& name,
                                              const TrajectoryReadOptions& options = {});

/// Writes by extension: `.txt` (`%time x y z`), `.csv` (`time,x,y,z`), both followed by qw qx qy qz where the
/// trajectory has orientations; `.tum` (`time x y z qx qy qz qw`, the identity where it has none: the format
/// demands one); `.ply` (double x, y, z, time). Numbers are the shortest that read back to the same bits. The
/// file appears only when complete. Throws Error(usage) for another extension and Error(file_access).
void write_trajectory(const std::filesystem::path& path, const Trajectory& trajectory);

}  // namespace ray
