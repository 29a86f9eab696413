#include "mesh_formats.h"
#include "text_fields.h"
#include "text_file.h"

#include <raycloud/core/error.h>
#include <raycloud/io/atomic_file.h>

#include <charconv>
#include <limits>

namespace ray {
namespace {

class ObjReader {
 public:
  explicit ObjReader(const std::filesystem::path& path) : file_(path) {}

  Mesh run() {
    text::LineReader reader(file_);
    for (auto lines = reader.next(kLines); !lines.empty(); lines = reader.next(kLines)) {
      while (!lines.empty()) {
        ++line_;
        read_line(text::take_line(lines));
      }
    }
    if (line_ == 0) throw Error(ErrorCode::file_format, file_.name() + ": empty file");
    if (mesh_.faces.empty())
      throw Error(ErrorCode::wrong_content, file_.name() + ": has no faces, so it is not a mesh");
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      for (const std::uint32_t index : mesh_.faces[f])
        if (index >= mesh_.vertices.size())
          throw Error(ErrorCode::file_format, file_.name() + ": a face has vertex " +
                                                  std::to_string(std::size_t{index} + 1) + " of " +
                                                  std::to_string(mesh_.vertices.size()));
    }
    return std::move(mesh_);
  }

 private:
  static constexpr std::size_t kLines = 4096;

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::file_format, file_.name() + ": line " + std::to_string(line_) + " " + what);
  }

  void read_line(std::string_view line) {
    text::Fields fields(line, ' ');
    const auto word = fields.next();
    if (word == "v") {
      read_vertex(fields);
    } else if (word == "f") {
      read_face(fields);
    }
  }

  void read_vertex(text::Fields& fields) {
    Eigen::Vector3d vertex;
    for (double& coordinate : vertex) {
      const auto field = fields.next();
      const auto value = field ? text::number(*field) : std::nullopt;
      if (!value)
        fail(field ? "has " + text::quoted(*field) + " where a number should be" : "lacks a number");
      coordinate = *value;
    }
    if (!vertex.allFinite()) fail("has a coordinate that is not a finite number");
    if (mesh_.vertices.size() >= std::numeric_limits<std::uint32_t>::max()) fail("is vertex 2^32");
    mesh_.vertices.push_back(vertex);
  }

  void read_face(text::Fields& fields) {
    polygon_.clear();
    while (const auto field = fields.next()) {
      const std::string_view index_text = field->substr(0, field->find('/'));
      std::int64_t index = 0;
      const char* const end = index_text.data() + index_text.size();
      const auto [rest, error] = std::from_chars(index_text.data(), end, index);
      const auto there = static_cast<std::int64_t>(mesh_.vertices.size());
      const std::int64_t number = index < 0 ? there + index : index - 1;
      if (error != std::errc() || rest != end || index == 0 || number < 0 ||
          number >= std::int64_t{std::numeric_limits<std::uint32_t>::max()}) {
        fail("has " + text::quoted(*field) + " where the number of a vertex should be");
      }
      polygon_.push_back(static_cast<std::uint32_t>(number));
    }
    if (polygon_.size() < 3) fail("has a face of " + std::to_string(polygon_.size()) + " corners");
    add_fan(mesh_, polygon_);
  }

  text::TextFile file_;
  Mesh mesh_;
  std::vector<std::uint32_t> polygon_;
  std::size_t line_ = 0;
};

}  // namespace

Mesh read_obj_mesh(const std::filesystem::path& path) {
  return ObjReader(path).run();
}

void write_obj_mesh(const std::filesystem::path& path, const Mesh& mesh, const WriteOptions& options) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  AtomicFile file(path, options);
  std::string piece;
  const auto end_line = [&] {
    piece += '\n';
    if (piece.size() < kPiece) return;
    file.write(piece);
    piece.clear();
  };
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    piece += 'v';
    for (const double coordinate : vertex)
      text::append_number(piece += ' ', coordinate);
    end_line();
  }
  for (const Mesh::Face& face : mesh.faces) {
    piece += 'f';
    for (const std::uint32_t index : face)
      piece += ' ' + std::to_string(std::size_t{index} + 1);
    end_line();
  }
  file.write(piece);
  file.commit();
}

}  // namespace ray
