#include "ply_decode.h"
#include "ply_header.h"
#include "ply_rows.h"
#include "ply_schema.h"

#include <raycloud/core/error.h>
#include <raycloud/io/ply_cloud.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ray {
namespace {

constexpr std::size_t kSampleRows = 1024;
/// So many vectors of length 1 are no accident; beside faces, one is not.
constexpr std::size_t kEnoughNormals = 4;

/// Some rows of a file, in the form of its layout.
struct Sample {
  PlyLayout layout;
  std::vector<std::byte> rows;

  [[nodiscard]] std::vector<double> values(const PlyField& field) const {
    return field_values(rows, layout, field);
  }
};

/// All of a small file; else from several places, where the encoding allows to jump.
Sample take_sample(PlyRows& rows, PlyLayout layout, std::uint64_t count) {
  const std::uint64_t places = count <= kSampleRows ? 1 : 4;
  Sample sample{std::move(layout), {}};
  RawChunk raw;
  std::vector<std::byte> scratch;
  for (std::uint64_t place = 0; place < places; ++place) {
    rows.jump(count / places * place);
    if (!rows.fetch(raw, kSampleRows / places)) break;
    const auto unpacked = rows.unpack(raw, scratch);
    sample.rows.insert(sample.rows.end(), unpacked.begin(), unpacked.end());
  }
  rows.jump(0);
  return sample;
}

struct VectorLengths {
  std::size_t zero = 0;
  std::size_t one = 0;
  std::size_t other = 0;

  [[nodiscard]] bool surface_normals(std::size_t enough) const { return other == 0 && one >= enough; }
};

VectorLengths measure(const Sample& sample, const std::array<PlyField, 3>& fields) {
  const auto x = sample.values(fields[0]), y = sample.values(fields[1]), z = sample.values(fields[2]);
  VectorLengths lengths;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double length = std::hypot(x[i], y[i], z[i]);
    if (!std::isfinite(length)) continue;
    if (length == 0.0)
      ++lengths.zero;
    else if (std::abs(length - 1.0) < 1e-3)
      ++lengths.one;
    else
      ++lengths.other;
  }
  return lengths;
}

double channel_scale(const Sample& sample, std::span<const PlyField> channels) {
  double scale = std::numeric_limits<double>::infinity();
  for (const PlyField& channel : channels) {
    double largest = 0.0;
    for (const double value : sample.values(channel)) {
      if (std::isfinite(value)) largest = std::max(largest, value);
    }
    const bool real = channel.type >= ScalarType::float32;
    // The same for all channels, or the hue would change.
    scale = std::min(scale, real && largest <= 1.0 ? 255.0 : largest > 255.0 ? 1.0 / 256.0 : 1.0);
  }
  return scale;
}

PlyColourScale colour_scale(const Sample& sample, const PlySchema& schema) {
  PlyColourScale scale;
  if (schema.colour) scale.colour = channel_scale(sample, *schema.colour);
  if (schema.alpha) scale.alpha = channel_scale(sample, {&*schema.alpha, 1});
  return scale;
}

std::uint64_t face_count(const PlyHeader& header) {
  std::uint64_t count = 0;
  for (const PlyElement& element : header.elements) {
    if (element.name == "face" || element.name == "tristrips") count = std::max(count, element.count);
  }
  return count;
}

/// Whether nx ny nz, of a file that does not say, are normals of surfaces and not rays. No normal is 0 0 0
/// where it is unknown, which a ray cloud of rays without length has too.
bool has_surface_normals(const PlyHeader& header, const PlySchema& schema, const Sample& sample,
                         PlyContent content) {
  if (!schema.ray_is_normal) return false;
  const VectorLengths lengths = measure(sample, *schema.ray);
  if (content == PlyContent::points && lengths.one == 0 && lengths.other == 0) return true;
  if (content == PlyContent::rays && lengths.zero > 0) return false;
  return lengths.surface_normals(face_count(header) > 0 ? 1 : kEnoughNormals);
}

/// Throws what a file of vertices is, if it is no ray cloud.
[[noreturn]] void fail_no_rays(const PlyHeader& header, bool normals, const std::string& path) {
  const std::uint64_t faces = face_count(header);
  if (faces > 0) {
    throw Error(ErrorCode::wrong_content,
                path + ": a mesh (" + std::to_string(faces) + " faces), not a ray cloud");
  }
  throw Error(
      ErrorCode::wrong_content,
      path +
          (normals ? ": a point cloud with surface normals (nx ny nz all have length 1), not a ray cloud"
                   : ": a point cloud, not a ray cloud") +
          ": make one with rayimport");
}

class PlySource final : public RaySource {
 public:
  PlySource(const std::filesystem::path& path, const ReadOptions& options, PlyContent content)
      : file_(path, options),
        header_(read_ply_header(file_)),
        chunk_rays_(std::max<std::size_t>(options.chunk_rays, 1)),
        decoder_(open(content)) {}

  const CloudInfo& info() const override { return info_; }
  bool fetch(RawChunk& raw) override { return rows_->fetch(raw, chunk_rays_); }
  void rewind() override { rows_->jump(0); }
  std::size_t decode(const RawChunk& raw, RayCloud& rays) const override {
    std::vector<std::byte> scratch;
    return decoder_.decode(rows_->unpack(raw, scratch), rays);
  }
  std::size_t decode_times(const RawChunk& raw, std::vector<double>& times) const override {
    std::vector<std::byte> scratch;
    return decoder_.decode_times(rows_->unpack(raw, scratch), times);
  }

 private:
  /// Learns all about the file; the decoder is what remains to be made of it.
  PlyDecoder open(PlyContent content) {
    const std::string path = file_.path().string();
    const PlyLayout layout = layout_of(header_);
    const std::uint64_t count = header_.elements[header_.vertex].count;
    PlySchema schema = schema_of(layout, content, PlyNormals::rays, path);
    rows_ = open_ply_rows(file_, header_, {path, content == PlyContent::rays ? "ray" : "point"});
    const PlyNotes notes = notes_of(header_, path);
    const Sample sample = take_sample(*rows_, layout, count);
    const bool normals = !notes.ours && has_surface_normals(header_, schema, sample, content);
    if (content == PlyContent::rays && (!schema.ray || normals)) fail_no_rays(header_, normals, path);
    if (normals) schema = schema_of(layout, content, PlyNormals::surface, path);
    info_ = described(notes, schema);
    info_.ray_count = count;
    return {schema, layout, notes.origin, colour_scale(sample, schema)};
  }

  InputFile file_;
  PlyHeader header_;
  std::size_t chunk_rays_;
  std::unique_ptr<PlyRows> rows_;
  CloudInfo info_;
  PlyDecoder decoder_;
};

}  // namespace

std::unique_ptr<RaySource> open_ply(const std::filesystem::path& path, const ReadOptions& options) {
  return std::make_unique<PlySource>(path, options, PlyContent::rays);
}

std::unique_ptr<RaySource> open_ply_points(const std::filesystem::path& path, const ReadOptions& options) {
  return std::make_unique<PlySource>(path, options, PlyContent::points);
}

}  // namespace ray
