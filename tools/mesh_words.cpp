#include "mesh_words.h"

#include <raycloud/core/error.h>
#include <raycloud/io/mesh_file.h>

namespace ray::tools {
namespace {

template <class Made>
Made made_of(const std::string& file) {
  const Mesh mesh = read_mesh(file);
  try {
    return Made(mesh);
  } catch (const Error& error) {
    throw Error(error.code(), file + ": " + error.what());
  }
}

}  // namespace

MeshDistance mesh_distance(const std::string& file) {
  return made_of<MeshDistance>(file);
}

MeshHeight mesh_height(const std::string& file) {
  return made_of<MeshHeight>(file);
}

}  // namespace ray::tools
