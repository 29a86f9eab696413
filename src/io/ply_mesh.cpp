#include "mesh_formats.h"
#include "ply_schema.h"
#include "ply_values.h"

#include <raycloud/core/error.h>
#include <raycloud/io/atomic_file.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

namespace ray {
namespace {

static_assert(std::endian::native == std::endian::little, "rows are written as they are in memory");

bool is_indices(const PlyProperty& property) {
  return property.list_count && (property.name == "vertex_indices" || property.name == "vertex_index");
}

class PlyMeshReader {
 public:
  explicit PlyMeshReader(const std::filesystem::path& path)
      : file_(path), header_(read_ply_header(file_)), values_(file_, header_) {
    const auto found =
        std::find_if(header_.elements.begin(), header_.elements.end(), [](const auto& element) {
          return element.name == "face" &&
                 std::count_if(element.properties.begin(), element.properties.end(), is_indices) == 1;
        });
    if (found == header_.elements.end() || found->count == 0)
      throw Error(ErrorCode::wrong_content, path.string() + ": has no faces, so it is not a mesh");
    face_ = static_cast<std::size_t>(found - header_.elements.begin());
  }

  Mesh run() {
    for (std::size_t e = 0; e < header_.elements.size(); ++e) {
      const PlyElement& element = header_.elements[e];
      if (e == header_.vertex)
        read_vertices(element);
      else if (e == face_)
        read_faces(element);
      else
        values_.skip(element);
    }
    values_.check_end();
    return std::move(mesh_);
  }

 private:
  void read_vertices(const PlyElement& element) {
    if (element.count > std::numeric_limits<std::uint32_t>::max())
      throw Error(ErrorCode::file_format, file_.path().string() + ": more than 2^32 vertices");
    std::vector<int> axes;
    for (const PlyProperty& property : element.properties) {
      const auto axis = std::string_view("xyz").find(property.name);
      axes.push_back(property.name.size() == 1 && !property.list_count && axis < 3 ? static_cast<int>(axis)
                                                                                   : -1);
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (std::count(axes.begin(), axes.end(), axis) != 1)
        throw Error(ErrorCode::wrong_content, file_.path().string() + ": its vertices have no x, y and z");
    }
    const auto offset = notes_of(header_, file_.path().string()).origin;
    mesh_.vertices.reserve(fitting(element));
    for (std::uint64_t row = 0; row < element.count; ++row) {
      values_.begin_row(element, row);
      Eigen::Vector3d position(offset[0], offset[1], offset[2]);
      for (std::size_t p = 0; p < axes.size(); ++p) {
        if (axes[p] < 0)
          values_.skip(element.properties[p]);
        else
          position[axes[p]] += values_.number(element.properties[p].type);
      }
      if (!position.allFinite()) values_.fail("a coordinate that is not a finite number");
      mesh_.vertices.push_back(position);
    }
  }

  void read_faces(const PlyElement& element) {
    for (const PlyProperty& property : element.properties) {
      if (!property.list_count) mesh_.face_columns.emplace_back(ColumnInfo{property.name, property.type});
    }
    mesh_.faces.reserve(fitting(element));
    std::vector<std::vector<std::byte>> columns(mesh_.face_columns.size());
    for (std::uint64_t row = 0; row < element.count; ++row) {
      values_.begin_row(element, row);
      read_face(element, columns);
    }
    for (std::size_t c = 0; c < columns.size(); ++c) {
      mesh_.face_columns[c].resize(mesh_.faces.size());
      std::copy(columns[c].begin(), columns[c].end(), mesh_.face_columns[c].data());
    }
  }

  void read_face(const PlyElement& element, std::vector<std::vector<std::byte>>& columns) {
    std::size_t column = 0;
    row_.clear();
    for (const PlyProperty& property : element.properties) {
      if (is_indices(property)) {
        read_polygon(property);
      } else if (property.list_count) {
        values_.skip(property);
      } else {
        row_.resize(row_.size() + size_of(property.type));
        values_.bytes(property.type, row_.data() + row_.size() - size_of(property.type));
      }
    }
    const std::size_t triangles = add_fan(mesh_, polygon_);
    const std::byte* value = row_.data();
    for (const Column& info : mesh_.face_columns) {
      for (std::size_t i = 0; i < triangles; ++i)
        columns[column].insert(columns[column].end(), value, value + info.stride());
      value += info.stride();
      ++column;
    }
  }

  void read_polygon(const PlyProperty& property) {
    polygon_.clear();
    const std::uint64_t corners = values_.count(*property.list_count);
    if (corners < 3) values_.fail("has " + std::to_string(corners) + " corners");
    const double vertices = static_cast<double>(header_.elements[header_.vertex].count);
    for (std::uint64_t i = 0; i < corners; ++i) {
      const double index = values_.number(property.type);
      if (!(index >= 0.0 && index < vertices && std::floor(index) == index)) {
        values_.fail("no vertex has the index " + shown(index) + " (there are " +
                     std::to_string(header_.elements[header_.vertex].count) + ")");
      }
      polygon_.push_back(static_cast<std::uint32_t>(index));
    }
  }

  static std::string shown(double index) {
    const bool whole = std::floor(index) == index && std::abs(index) < 1e15;
    return whole ? std::to_string(static_cast<std::int64_t>(index)) : std::to_string(index);
  }

  /// Rows that the file can have, whatever its header says.
  [[nodiscard]] std::size_t fitting(const PlyElement& element) const {
    const std::size_t least =
        header_.format == PlyFormat::ascii ? 2 * element.properties.size() : element.least_row_bytes();
    return static_cast<std::size_t>(std::min<std::uint64_t>(element.count, file_.size() / least));
  }

  InputFile file_;
  PlyHeader header_;
  PlyValues values_;
  std::size_t face_ = 0;
  Mesh mesh_;
  std::vector<std::uint32_t> polygon_;
  std::vector<std::byte> row_;
};

/// Collects small pieces for an AtomicFile.
class Buffer {
 public:
  explicit Buffer(AtomicFile& file) : file_(file) { bytes_.reserve(kSize + 4096); }
  template <class T>
  void put(const T& value) {
    put(&value, sizeof value);
  }
  void put(const void* data, std::size_t size) {
    const auto* begin = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), begin, begin + size);
    if (bytes_.size() >= kSize) flush();
  }
  void flush() {
    file_.write(bytes_);
    bytes_.clear();
  }

 private:
  static constexpr std::size_t kSize = std::size_t{1} << 20;
  AtomicFile& file_;
  std::vector<std::byte> bytes_;
};

bool is_exact_in_float(const Mesh& mesh) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [](const Eigen::Vector3d& v) {
    return (v.cast<float>().cast<double>().array() == v.array()).all();
  });
}

std::string header_of(const Mesh& mesh, const std::filesystem::path& path, std::string_view real) {
  constexpr std::string_view kTypes[] = {"char", "uchar", "short", "ushort", "int",
                                         "uint", "",      "",      "float",  "double"};
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) + "\n";
  for (const char* axis : {"x", "y", "z"})
    text += "property " + std::string(real) + " " + axis + "\n";
  text += "element face " + std::to_string(mesh.faces.size()) + "\n";
  const bool small = mesh.vertices.size() <= std::size_t{std::numeric_limits<std::int32_t>::max()};
  text += std::string("property list uchar ") + (small ? "int" : "uint") + " vertex_indices\n";
  for (const Column& column : mesh.face_columns) {
    const auto type = kTypes[static_cast<std::size_t>(column.type())];
    if (type.empty()) {
      throw Error(ErrorCode::usage,
                  path.string() + ": PLY has no 64-bit integers for the face column '" + column.name() + "'");
    }
    text += "property " + std::string(type) + " " + column.name() + "\n";
  }
  return text + "end_header\n";
}

}  // namespace

Mesh read_ply_mesh(const std::filesystem::path& path) {
  return PlyMeshReader(path).run();
}

void write_ply_mesh(const std::filesystem::path& path, const Mesh& mesh, const WriteOptions& options) {
  const bool exact = is_exact_in_float(mesh);
  const std::string header = header_of(mesh, path, exact ? "float" : "double");
  AtomicFile file(path, options);
  Buffer buffer(file);
  buffer.put(header.data(), header.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    if (exact) {
      const Eigen::Vector3f single = vertex.cast<float>();
      buffer.put(single.data(), 12);
    } else {
      buffer.put(vertex.data(), 24);
    }
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    buffer.put(std::uint8_t{3});
    buffer.put(mesh.faces[f].data(), 12);
    for (const Column& column : mesh.face_columns)
      buffer.put(column.data() + f * column.stride(), column.stride());
  }
  buffer.flush();
  file.commit();
}

}  // namespace ray
