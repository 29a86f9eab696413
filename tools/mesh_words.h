#pragma once
/// Meshes that commands are given: read, and made ready with the file's name in what goes wrong.

#include <raycloud/mesh/mesh_distance.h>
#include <raycloud/mesh/mesh_height.h>

#include <string>

namespace ray::tools {

[[nodiscard]] MeshDistance mesh_distance(const std::string& file);
[[nodiscard]] MeshHeight mesh_height(const std::string& file);

}  // namespace ray::tools
