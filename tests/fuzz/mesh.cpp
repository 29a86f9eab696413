// Any bytes as a .ply and as an .obj mesh: triangles whose corners exist come out or ray::Error, and nothing
// else.
#include "fuzz/input_file.h"
#include "support/scratch.h"

#include <raycloud/core/error.h>
#include <raycloud/io/mesh_file.h>

#include <cstdlib>

namespace {

/// Under a name with the extension that tells the format.
void read(const std::string& file, const std::filesystem::path& name) {
  std::filesystem::create_symlink(file, name);
  try {
    const ray::Mesh mesh = ray::read_mesh(name);
    if (mesh.empty()) std::abort();
    for (const Eigen::Vector3d& vertex : mesh.vertices)
      if (!vertex.allFinite()) std::abort();
    for (const ray::Mesh::Face& face : mesh.faces)
      for (const std::uint32_t index : face)
        if (index >= mesh.vertices.size()) std::abort();
    for (const ray::Column& column : mesh.face_columns)
      if (column.size() != mesh.faces.size()) std::abort();
  } catch (const ray::Error&) {  // the only way a reader may fail
  }
  std::filesystem::remove(name);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const ray::test::Scratch kScratch;
  const ray::fuzz::InputFile file(data, size);
  read(file.path(), kScratch.path("mesh.ply"));
  read(file.path(), kScratch.path("mesh.obj"));
  return 0;
}
