#include "mesh_formats.h"

#include <raycloud/core/error.h>
#include <raycloud/io/mesh_file.h>

namespace ray {
namespace {

enum class Kind { ply, obj };

Kind kind_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (extension == ".ply") return Kind::ply;
  if (extension == ".obj") return Kind::obj;
  throw Error(ErrorCode::usage, path.string() + ": a mesh is a .ply or .obj file");
}

}  // namespace

std::size_t add_fan(Mesh& mesh, const std::vector<std::uint32_t>& polygon) {
  for (std::size_t i = 2; i < polygon.size(); ++i)
    mesh.faces.push_back({polygon[0], polygon[i - 1], polygon[i]});
  return polygon.size() - 2;
}

Mesh read_mesh(const std::filesystem::path& path) {
  return kind_of(path) == Kind::ply ? read_ply_mesh(path) : read_obj_mesh(path);
}

void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const WriteOptions& options) {
  return kind_of(path) == Kind::ply ? write_ply_mesh(path, mesh, options)
                                    : write_obj_mesh(path, mesh, options);
}

}  // namespace ray
