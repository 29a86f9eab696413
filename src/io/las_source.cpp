#include "las_decoder.h"
#include "laz_layers.h"
#include "laz_pieces.h"
#include "laz_reader.h"

#include <raycloud/core/error.h>
#include <raycloud/io/las_cloud.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <mutex>
#include <optional>

namespace ray {
namespace {

using Input = std::shared_ptr<const InputFile>;

constexpr std::uint64_t kMostBytes = 64 << 20;  ///< of a chunk

/// The point records of a file, compressed or not.
class LasRecords {
 public:
  virtual ~LasRecords() = default;
  /// Rows of the chunk that starts at row `first`; 0 at the end.
  [[nodiscard]] virtual std::size_t rows_from(std::uint64_t first) const = 0;
  /// What must be read by one thread at a time, if anything.
  virtual void fetch(RawChunk& raw) = 0;
  /// Hands the records of a fetched chunk to `use`. Thread-safe.
  virtual void visit(const RawChunk& raw,
                     const std::function<void(std::span<const std::byte>)>& use) const = 0;
  /// True if a colour of the file exceeds 255. Reads until it finds one.
  [[nodiscard]] virtual bool has_wide_colours(const LasDecoder& decoder) const = 0;
};

class PlainRecords final : public LasRecords {
 public:
  PlainRecords(Input input, const LasHeader& header, std::size_t chunk_rays)
      : input_(std::move(input)),
        points_at_(header.points_at),
        point_count_(header.point_count),
        length_(header.record_length),
        chunk_rows_(std::clamp<std::uint64_t>(chunk_rays, 1, kMostBytes / header.record_length)) {
    const std::uint64_t there = point_count_ == 0 ? 0 : (input_->size() - points_at_) / length_;
    if (there < point_count_) fail(there);
  }

  [[nodiscard]] std::size_t rows_from(std::uint64_t first) const override {
    return static_cast<std::size_t>(std::min<std::uint64_t>(chunk_rows_, point_count_ - first));
  }

  void fetch(RawChunk& raw) override { read(raw); }

  void visit(const RawChunk& raw, const std::function<void(std::span<const std::byte>)>& use) const override {
    use(raw.bytes);
  }

  [[nodiscard]] bool has_wide_colours(const LasDecoder& decoder) const override {
    RawChunk raw;
    for (raw.rows = rows_from(0); raw.rows != 0; raw.rows = rows_from(raw.first_row)) {
      read(raw);
      if (decoder.colour_bits(raw.bytes) > 255) return true;
      raw.first_row += raw.rows;
    }
    return false;
  }

 private:
  void read(RawChunk& raw) const {
    raw.bytes.resize(raw.rows * length_);
    const std::size_t got = input_->read_at(points_at_ + raw.first_row * length_, raw.bytes);
    if (got < raw.bytes.size()) fail(raw.first_row + got / length_);
  }

  [[noreturn]] void fail(std::uint64_t good) const {
    throw Error(ErrorCode::file_format, input_->path().string() + ": cut short after point " +
                                            std::to_string(good) + " of " + std::to_string(point_count_));
  }

  Input input_;
  std::uint64_t points_at_;
  std::uint64_t point_count_;
  std::size_t length_;
  std::size_t chunk_rows_;
};

class CompressedRecords final : public LasRecords {
 public:
  CompressedRecords(Input input, const LasHeader& header, std::unique_ptr<LazReader> reader,
                    std::size_t chunk_rays)
      : input_(std::move(input)), header_(header), pieces_(*input_, header, chunk_rays) {
    idle_.push_back(std::make_unique<Worker>(Worker{std::move(reader), {}}));
  }

  [[nodiscard]] std::size_t rows_from(std::uint64_t first) const override { return pieces_.rows_from(first); }

  void fetch(RawChunk& raw) override {
    if (pieces_.independent()) return;  // and what a sink left in the buffer saves it clearing one
    LazReader& reader = *idle_.front()->reader;
    raw.bytes.resize(raw.rows * reader.record_length());
    reader.read(raw.first_row, raw.bytes);
  }

  void visit(const RawChunk& raw, const std::function<void(std::span<const std::byte>)>& use) const override {
    if (!pieces_.independent()) return use(raw.bytes);
    std::unique_ptr<Worker> worker = borrow(raw.first_row);
    worker->records.resize(raw.rows * worker->reader->record_length());
    worker->reader->read(raw.first_row, worker->records);
    use(worker->records);
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(worker));
  }

  [[nodiscard]] bool has_wide_colours(const LasDecoder& decoder) const override {
    LazReader reader(*input_, header_, LazFields::coordinates_and_colours);
    std::vector<std::byte> records;
    constexpr std::uint64_t kRows = 4096;
    try {
      for (std::uint64_t row = 0; row < header_.point_count; row += kRows) {
        records.resize(std::min(kRows, header_.point_count - row) * reader.record_length());
        reader.read(row, records);
        if (decoder.colour_bits(records) > 255) return true;
      }
    } catch (const Error&) {
      // The damage is reported when those points are due.
    }
    return false;
  }

 private:
  struct Worker {
    std::unique_ptr<LazReader> reader;
    std::vector<std::byte> records;
  };

  /// An idle worker, best one whose reader stands at `row`, or a new one.
  std::unique_ptr<Worker> borrow(std::uint64_t row) const {
    {
      const std::lock_guard lock(mutex_);
      auto best = std::find_if(idle_.begin(), idle_.end(),
                               [&](const auto& worker) { return worker->reader->next_row() == row; });
      if (best == idle_.end() && !idle_.empty()) best = idle_.end() - 1;
      if (best != idle_.end()) {
        std::unique_ptr<Worker> worker = std::move(*best);
        idle_.erase(best);
        return worker;
      }
    }
    return std::make_unique<Worker>(Worker{std::make_unique<LazReader>(*input_, header_), {}});
  }

  Input input_;
  LasHeader header_;
  LazPieces pieces_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Worker>> idle_;
};

/// Whether colours have 16 bits: known as soon as one exceeds 255; asked of the whole file only when one is
/// neither 0 nor above 255, so that files with no colours, or 16-bit ones, are read once. A property of the
/// file, whatever chunk comes first.
class ColourDepth {
 public:
  [[nodiscard]] bool wide(const LasRecords& records, const LasDecoder& decoder, std::uint16_t bits) const {
    if (bits > 255) wide_ = true;
    if (bits != 0 && !wide_)
      std::call_once(asked_, [&] {
        if (records.has_wide_colours(decoder)) wide_ = true;
      });
    return wide_;
  }

 private:
  mutable std::atomic<bool> wide_ = false;
  mutable std::once_flag asked_;
};

class LasSource final : public RaySource {
 public:
  LasSource(const LasHeader& header, std::unique_ptr<LasRecords> records)
      : decoder_(header),
        records_(std::move(records)),
        info_(decoder_.info()),
        point_count_(header.point_count) {
    info_.ray_count = point_count_;
  }

  [[nodiscard]] const CloudInfo& info() const override { return info_; }

  [[nodiscard]] bool fetch(RawChunk& raw) override {
    raw.first_row = next_;
    raw.rows = next_ < point_count_ ? records_->rows_from(next_) : 0;
    if (raw.rows == 0) return false;
    records_->fetch(raw);
    next_ += raw.rows;
    return true;
  }

  std::size_t decode(const RawChunk& raw, RayCloud& rays) const override {
    std::size_t dropped = 0;
    records_->visit(raw, [&](std::span<const std::byte> records) {
      const std::uint16_t bits = decoder_.colour_bits(records);
      dropped = decoder_.decode(records, colour_depth_.wide(*records_, decoder_, bits), rays);
    });
    return dropped;
  }

  void rewind() override { next_ = 0; }

 private:
  LasDecoder decoder_;
  std::unique_ptr<LasRecords> records_;
  ColourDepth colour_depth_;
  CloudInfo info_;
  std::uint64_t point_count_;
  std::uint64_t next_ = 0;
};

/// The fields that remain when LASzip has turned points stored in an older format into those of LAS 1.4.
std::vector<LasExtraField> upgraded_fields(const LasHeader& header, const LazReader& reader) {
  std::vector<std::byte> record;
  for (std::size_t at = 0; at + 192 <= header.extra_bytes_record.size(); at += 192) {
    const auto entry = std::span(header.extra_bytes_record).subspan(at, 192);
    if (std::memcmp(entry.data() + 4, "LAS 1.4 ", 8) != 0)
      record.insert(record.end(), entry.begin(), entry.end());
  }
  return parse_extra_fields(record, reader.format(), reader.record_length());
}

/// Reads one point to see whether LASzip can. Sets header.chunk_table_lost where it cannot with the table but
/// could without.
std::unique_ptr<LazReader> open_reader(const InputFile& input, LasHeader& header) {
  const std::uint32_t chunk_rows = laz_chunk_rows(header);
  const bool replaceable = chunk_rows != 0 && chunk_rows != kVariableChunk;
  const bool lost = chunk_rows != 0 && !laz_tabled_chunks(input, header);
  if (lost && !replaceable)
    throw Error(ErrorCode::file_format,
                input.path().string() + ": cut short or damaged: LASzip's table of chunks is lost");
  header.chunk_table_lost = lost;
  check_laszip_record(input, header);
  header.layered_chunks = layered_chunks(input, header);
  auto reader = std::make_unique<LazReader>(input, header);
  std::vector<std::byte> record(reader->record_length());
  try {
    reader->read(0, record);
  } catch (const Error&) {
    if (!replaceable || header.chunk_table_lost) throw;
    header.chunk_table_lost = true;
    reader = std::make_unique<LazReader>(input, header);
  }
  return reader;
}

std::unique_ptr<RaySource> open_compressed(Input input, LasHeader header, const ReadOptions& options) {
  std::unique_ptr<LazReader> reader = open_reader(*input, header);
  LasHeader given = header;
  if (reader->format() != header.format || reader->record_length() != header.record_length) {
    given.format = reader->format();
    given.record_length = reader->record_length();
    given.extra_fields = upgraded_fields(header, *reader);
  }
  return std::make_unique<LasSource>(
      given, std::make_unique<CompressedRecords>(input, header, std::move(reader), options.chunk_rays));
}

}  // namespace

std::unique_ptr<RaySource> open_las_points(const std::filesystem::path& path, const ReadOptions& options) {
  auto input = std::make_shared<const InputFile>(path);
  const LasHeader header = parse_las_header(*input);
  if (header.compressed() && header.point_count != 0) return open_compressed(input, header, options);
  return std::make_unique<LasSource>(header,
                                     std::make_unique<PlainRecords>(input, header, options.chunk_rays));
}

std::unique_ptr<RaySource> open_las(const std::filesystem::path& path, const ReadOptions& options) {
  std::unique_ptr<RaySource> source = open_las_points(path, options);
  if (!source->info().present.starts)
    throw Error(ErrorCode::wrong_content,
                path.string() +
                    ": holds points, not rays (it has no BeamOriginX, BeamOriginY and "
                    "BeamOriginZ): make rays of it with rayimport");
  return source;
}

}  // namespace ray
