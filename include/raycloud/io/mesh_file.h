#pragma once
/// Triangle meshes as files, by the extension in either case: .ply and .obj.
///
/// PLY is read in every spelling (ascii and both byte orders, any scalar type, `vertex_indices` or
/// `vertex_index`); `comment origin x y z` is added to the coordinates. Polygons become fans of triangles.
/// Every other number of a face, such as `object_id`, is a face column with its name and type; further lists,
/// further elements and what else a vertex has, such as colours, are left out. Of OBJ the positions and faces
/// are read, of which indices may be negative and have texture and normal indices beside them.

#include <raycloud/core/mesh.h>
#include <raycloud/io/file_options.h>

#include <filesystem>

namespace ray {

/// Every coordinate is finite and every index has its vertex. Memory: the mesh and a buffer of 1 MiB.
///
/// Throws Error: file_not_found, file_access; file_format where the file is empty, cut short, damaged, has an
/// index out of range or a NaN; wrong_content for a PLY file without faces (a cloud); usage for another
/// extension.
[[nodiscard]] Mesh read_mesh(const std::filesystem::path& path);

/// Coordinates come back with every bit: a PLY file is little endian, with float coordinates where all are
/// exactly floats, else double; OBJ has the shortest decimals that read back the same. Face columns go into a
/// PLY file; OBJ cannot hold them. The file appears, complete, on return. Throws Error(usage) for another
/// extension or for a 64-bit integer column, which PLY lacks, and Error(file_access).
void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const WriteOptions& options = {});

}  // namespace ray
