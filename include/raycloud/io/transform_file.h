#pragma once
/// Transforms as files: a small YAML that other programs read too.

#include <raycloud/core/bend.h>
#include <raycloud/core/pose.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ray {

/// Further lines `name: value` of the file, for people.
using TransformNotes = std::vector<std::pair<std::string, std::string>>;

/// Writes `matrix` (four rows of four numbers, p' = matrix · p in m), `rotation_vector` (degrees),
/// `translation` (m) and the notes. Numbers are the shortest that read back to the same bits. The file
/// appears only when complete. Where there is a bend, also `bend_centre` (m) and `bend` (three rows of
/// Bend::shifts, 1/m): it follows the matrix. Throws Error(file_access).
void write_transform(const std::filesystem::path& path, const Pose& pose, const TransformNotes& notes = {},
                     const Bend& bend = {});

/// Reads the `matrix` of a file as above; also sixteen numbers alone, row by row, as other programs write
/// them. Throws Error(file_not_found, file_access), and Error(file_format) if there is no such matrix, or it
/// is not rigid to 1e-4.
[[nodiscard]] Pose read_transform(const std::filesystem::path& path);

/// As read_transform, from memory; `name` is what errors call it.
[[nodiscard]] Pose parse_transform(std::string_view text, const std::string& name);

/// Reads the bend of a file as above; none where it has none. Throws as read_transform does.
[[nodiscard]] Bend read_bend(const std::filesystem::path& path);

/// As read_bend, from memory; `name` is what errors call it.
[[nodiscard]] Bend parse_bend(std::string_view text, const std::string& name);

/// The rotation vector of a pose in degrees: the inverse of rotation_pose.
[[nodiscard]] Eigen::Vector3d rotation_vector_deg(const Pose& pose);

}  // namespace ray
