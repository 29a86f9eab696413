#pragma once
/// The formats behind io/mesh_file.h.

#include <raycloud/core/mesh.h>
#include <raycloud/io/file_options.h>

#include <filesystem>
#include <string>
#include <vector>

namespace ray {

[[nodiscard]] Mesh read_ply_mesh(const std::filesystem::path& path);
[[nodiscard]] Mesh read_obj_mesh(const std::filesystem::path& path);
void write_ply_mesh(const std::filesystem::path& path, const Mesh& mesh, const WriteOptions& options);
void write_obj_mesh(const std::filesystem::path& path, const Mesh& mesh, const WriteOptions& options);

/// Adds the fan of a polygon, whose indices are in range. Returns the number of triangles.
std::size_t add_fan(Mesh& mesh, const std::vector<std::uint32_t>& polygon);

}  // namespace ray
