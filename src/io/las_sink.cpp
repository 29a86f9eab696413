#include "las_crs.h"
#include "las_encoder.h"
#include "las_header.h"
#include "las_notes.h"
#include "las_spool.h"
#include "laz_writer.h"

#include <raycloud/core/error.h>
#include <raycloud/io/atomic_file.h>
#include <raycloud/io/las_cloud.h>

#include <algorithm>
#include <cctype>
#include <string_view>

namespace ray {
namespace {

constexpr std::size_t kMostRecord = 0xffff;  ///< bytes of a variable length record

bool is_laz(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return extension == ".laz";
}

template <class T>
void put_values(std::vector<std::byte>& out, const std::vector<T>& values) {
  const auto bytes = std::as_bytes(std::span(values));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

template <class T>
const std::byte* take_values(const std::byte* in, std::vector<T>& values) {
  const std::size_t size = values.size() * sizeof(T);
  if (size != 0) std::memcpy(static_cast<void*>(values.data()), in, size);
  return in + size;
}

/// A header that grows by records; `count` is that of the records.
struct RecordList {
  std::vector<std::byte> bytes;
  std::uint32_t count = 0;

  void add(std::string_view user, std::uint16_t id, std::string_view description,
           std::span<const std::byte> data) {
    const std::size_t at = bytes.size();
    bytes.resize(at + 54);
    std::memcpy(bytes.data() + at + 2, user.data(), user.size());
    store(bytes.data() + at + 18, id);
    store(bytes.data() + at + 20, static_cast<std::uint16_t>(data.size()));
    std::memcpy(bytes.data() + at + 22, description.data(), description.size());
    bytes.insert(bytes.end(), data.begin(), data.end());
    ++count;
  }
};

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

RecordList variable_records(const CloudInfo& info, const LasEncoder& encoder) {
  RecordList records;
  if (!encoder.extra_bytes_record().empty())
    records.add("LASF_Spec", 4, "extra bytes", encoder.extra_bytes_record());
  const std::vector<std::byte> keys = geokeys_of_epsg(info.crs);
  if (!keys.empty()) records.add("LASF_Projection", 34735, "GeoTIFF keys", keys);
  // A string of the standard ends with a zero.
  const std::string wkt = info.crs + '\0';
  if (is_wkt(info.crs) && wkt.size() <= kMostRecord)
    records.add("LASF_Projection", 2112, "coordinate system", bytes_of(wkt));
  const std::string text = las_notes_text(info);
  std::uint16_t id = 1;
  for (std::size_t at = 0; at < text.size(); at += kMostRecord, ++id)
    records.add("raycloud", id, "columns, history, comments",
                bytes_of(std::string_view(text).substr(at, kMostRecord)));
  return records;
}

struct PointsSummary {
  LasSurvey survey;
  LasGrid grid;
  std::string_view time_base;
  bool geokeys = false;
};

/// The public header block of LAS 1.4. No date: the same rays give the same file on every day.
std::vector<std::byte> header_block(const PointsSummary& summary, const LasEncoder& encoder, bool compressed,
                                    const RecordList& records) {
  std::vector<std::byte> block(375);
  std::byte* out = block.data();
  std::memcpy(out, "LASF", 4);
  const unsigned wkt_bit = summary.geokeys ? 0 : 16;
  store(out + 6, static_cast<std::uint16_t>((summary.time_base == "gps_adjusted" ? 1u : 0u) | wkt_bit));
  store<std::uint8_t>(out + 24, 1);
  store<std::uint8_t>(out + 25, 4);
  std::memcpy(out + 26, "raycloud", 8);
  std::memcpy(out + 58, "raycloudtools", 13);
  store(out + 94, static_cast<std::uint16_t>(block.size()));
  store(out + 96, static_cast<std::uint32_t>(block.size() + records.bytes.size()));
  store(out + 100, records.count);
  store(out + 104, static_cast<std::uint8_t>(encoder.format() | (compressed ? 128 : 0)));
  store(out + 105, static_cast<std::uint16_t>(encoder.record_length()));
  const Bounds& bounds = summary.survey.ends;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const LasAxis& steps = summary.grid[axis];
    const auto index = static_cast<Eigen::Index>(axis);
    store(out + 131 + 8 * axis, steps.scale);
    store(out + 155 + 8 * axis, steps.offset);
    if (bounds.empty()) continue;
    store(out + 179 + 16 * axis, steps.restored(steps.stored(bounds.max[index])));
    store(out + 187 + 16 * axis, steps.restored(steps.stored(bounds.min[index])));
  }
  store(out + 247, summary.survey.rays);
  for (std::size_t i = 1; i < 16; ++i)
    store(out + 247 + 8 * i, summary.survey.by_return[i]);
  return block;
}

class LasSink final : public RaySink {
 public:
  LasSink(const std::filesystem::path& path, const CloudInfo& info, const LasContent& content,
          const WriteOptions& options)
      : file_(path, options),
        spool_(path, options),
        info_(info),
        content_(content),
        compressed_(options.format.empty() ? is_laz(path) : options.format == ".laz") {}

  void encode(const RayCloud& rays, RawChunk& raw) const override;
  void write(const RawChunk& raw) override;
  void finish() override;

 private:
  /// The rays of a piece of the spool.
  void read_piece(std::size_t number, std::vector<std::byte>& bytes, RayCloud& rays) const;
  [[nodiscard]] LasGrid choose_grid(const Bounds& bounds, const Eigen::Vector3d& sample,
                                    bool of_starts) const;
  void write_points(const LasEncoder& encoder, LazWriter* writer);

  AtomicFile file_;
  LasSpool spool_;
  CloudInfo info_;
  LasContent content_;
  bool compressed_;
  LasSurvey survey_;
};

// A piece of the spool is the survey of its rays and then the columns, one behind the other.
static_assert(std::is_trivially_copyable_v<Colour>);

void LasSink::encode(const RayCloud& rays, RawChunk& raw) const {
  const LasSurvey survey = survey_rays(rays);
  raw.rows = rays.size();
  raw.bytes.resize(sizeof survey);
  std::memcpy(raw.bytes.data(), static_cast<const void*>(&survey), sizeof survey);
  put_values(raw.bytes, rays.ends);
  if (content_.starts) put_values(raw.bytes, rays.starts);
  put_values(raw.bytes, rays.times);
  put_values(raw.bytes, rays.colours);
  put_values(raw.bytes, rays.bounded);
  for (const Column& column : rays.extras)
    raw.bytes.insert(raw.bytes.end(), column.data(), column.data() + rays.size() * column.stride());
}

void LasSink::write(const RawChunk& raw) {
  if (raw.rows == 0) return;
  LasSurvey survey;
  std::memcpy(static_cast<void*>(&survey), raw.bytes.data(), sizeof survey);
  survey_.add(survey);
  spool_.add(raw.bytes);
}

void LasSink::read_piece(std::size_t number, std::vector<std::byte>& bytes, RayCloud& rays) const {
  spool_.read(number, bytes);
  LasSurvey survey;
  std::memcpy(static_cast<void*>(&survey), bytes.data(), sizeof survey);
  rays.set_schema(info_.extras);
  rays.resize(survey.rays);
  const std::byte* in = take_values(bytes.data() + sizeof survey, rays.ends);
  if (content_.starts) in = take_values(in, rays.starts);
  in = take_values(in, rays.times);
  in = take_values(in, rays.colours);
  in = take_values(in, rays.bounded);
  for (Column& column : rays.extras) {
    std::memcpy(column.data(), in, rays.size() * column.stride());
    in += rays.size() * column.stride();
  }
}

LasGrid LasSink::choose_grid(const Bounds& bounds, const Eigen::Vector3d& sample, bool of_starts) const {
  std::vector<std::byte> bytes;
  RayCloud rays;
  return choose_las_grid(
      bounds, info_.coordinate_step, sample, [&](std::size_t axis, const LasAxis& candidate) {
        const auto index = static_cast<Eigen::Index>(axis);
        if (!candidate.on_grid(sample[index])) return false;
        for (std::size_t piece = 0; piece < spool_.size(); ++piece) {
          read_piece(piece, bytes, rays);
          const auto& points = of_starts ? rays.starts : rays.ends;
          if (!std::all_of(points.begin(), points.end(),
                           [&](const Eigen::Vector3d& point) { return candidate.on_grid(point[index]); }))
            return false;
        }
        return true;
      });
}

void LasSink::write_points(const LasEncoder& encoder, LazWriter* writer) {
  std::vector<std::byte> bytes;
  std::vector<std::byte> records;
  RayCloud rays;
  if (writer != nullptr) writer->begin();
  for (std::size_t piece = 0; piece < spool_.size(); ++piece) {
    read_piece(piece, bytes, rays);
    encoder.encode(rays, records);
    writer != nullptr ? writer->write(records) : file_.write(records);
  }
  if (writer != nullptr) writer->end();
}

void LasSink::finish() {
  PointsSummary summary{survey_, choose_grid(survey_.ends, survey_.first_end, false), info_.time_base,
                        !geokeys_of_epsg(info_.crs).empty()};
  const LasGrid starts = content_.starts ? choose_grid(survey_.starts, survey_.first_start, true) : LasGrid{};
  const LasEncoder encoder(content_, info_.extras, survey_, summary.grid, starts);
  RecordList records = variable_records(info_, encoder);
  std::unique_ptr<LazWriter> writer;
  if (compressed_) {
    writer = std::make_unique<LazWriter>(file_, encoder.format(), encoder.record_length());
    const std::vector<std::byte> own = writer->laszip_record();
    records.bytes.insert(records.bytes.end(), own.begin(), own.end());
    ++records.count;
  }
  file_.write(header_block(summary, encoder, compressed_, records));
  file_.write(records.bytes);
  write_points(encoder, writer.get());
  writer.reset();
  file_.commit();
}

}  // namespace

std::unique_ptr<RaySink> create_las(const std::filesystem::path& path, const CloudInfo& info,
                                    const WriteOptions& options) {
  return std::make_unique<LasSink>(path, info, LasContent{true, true, true}, options);
}

std::unique_ptr<RaySink> create_las_points(const std::filesystem::path& path, const CloudInfo& info,
                                           const WriteOptions& options) {
  const LasContent content{false, info.present.colours, info.present.intensity};
  return std::make_unique<LasSink>(path, info, content, options);
}

}  // namespace ray
