#include "laz_reader.h"

#include "las_columns.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <cstdint>
#include <istream>
#include <string_view>
#include <utility>

namespace ray {
namespace {

constexpr std::size_t kVlrHead = 54;
constexpr std::size_t kCompressorAt = 0;
constexpr std::size_t kCoderAt = 2;
constexpr std::size_t kChunkRowsAt = 12;
constexpr std::size_t kItemCountAt = 32;
constexpr std::size_t kItemsAt = 34;

void append_record(std::vector<std::byte>& out, std::string_view user, std::uint16_t id,
                   std::span<const std::byte> data) {
  const std::size_t at = out.size();
  out.resize(at + kVlrHead);
  std::memcpy(out.data() + at + 2, user.data(), user.size());
  store(out.data() + at + 18, id);
  store(out.data() + at + 20, static_cast<std::uint16_t>(data.size()));
  out.insert(out.end(), data.begin(), data.end());
}

/// The file's header with nothing behind it but the records that LASzip needs.
std::vector<std::byte> header_for_laszip(const LasHeader& header) {
  std::vector<std::byte> bytes = header.block;
  const bool newest = header.minor >= 4;
  if (newest) {
    bytes.resize(375);
    store<std::uint8_t>(bytes.data() + 25, 4);
    store<std::uint64_t>(bytes.data() + 235, 0);
    store<std::uint32_t>(bytes.data() + 243, 0);
    store<std::uint64_t>(bytes.data() + 247, header.point_count);
  }
  const bool few = header.point_count <= 0xffffffff && header.format < 6;
  store(bytes.data() + 94, static_cast<std::uint16_t>(bytes.size()));
  store(bytes.data() + 107, few ? static_cast<std::uint32_t>(header.point_count) : 0);
  append_record(bytes, "laszip encoded", 22204, header.laszip_record);
  std::uint32_t records = 1;
  if (!header.compatibility_record.empty()) {
    append_record(bytes, "lascompatible", 22204, header.compatibility_record);
    append_record(bytes, "LASF_Spec", 4, header.extra_bytes_record);
    records += 2;
  }
  store(bytes.data() + 100, records);
  return bytes;
}

}  // namespace

/// The file behind a header of ours. Positions are those of the file.
class LazReader::Stream : private std::streambuf {
 public:
  Stream(const InputFile& input, const LasHeader& header)
      : input_(input),
        head_(header_for_laszip(header)),
        points_at_(header.points_at),
        window_(header.format < 6 ? kWindow : kBuffer),
        layered_chunks_(header.layered_chunks) {
    if (header.chunk_table_lost) {
      // A table at its own address is LASzip's sign for one that was never written.
      head_.resize(points_at_ + 8);
      store(head_.data() + points_at_, points_at_);
    }
    setg(buffer_.data(), buffer_.data(), buffer_.data());
  }

  /// LASzip is about to read from here on.
  void enter() { stack_ = here(); }

  [[nodiscard]] std::istream& stream() { return stream_; }
  /// LASzip wanted more than there is.
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  // LASzip reads times by calling itself, once for each of a run of marks, of which a byte holds up to 36
  // 000: a file may have more of them than the stack has room, 48 bytes each. It comes here for every few
  // bytes, for each where it is deep already, and then no further.
  static constexpr std::size_t kBuffer = 1 << 16;
  static constexpr std::size_t kWindow = 4;
  static constexpr std::uintptr_t kDeep = 1 << 12, kTooDeep = 1 << 19;

  static std::uintptr_t here() { return reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0)); }
  [[nodiscard]] std::uintptr_t depth() const {
    const std::uintptr_t at = here();
    return std::max(at, stack_) - std::min(at, stack_);
  }

  int_type underflow() override {
    const std::uintptr_t deep = depth();
    if (deep > kTooDeep) return traits_type::eof();
    if (gptr() == buffer_.data() + filled_) {
      at_ += filled_;
      filled_ = fill();
      setg(buffer_.data(), buffer_.data(), buffer_.data());
    }
    ended_ = filled_ == 0;
    if (ended_) return traits_type::eof();
    show_window(gptr(), deep > kDeep ? 1 : window_);
    return traits_type::to_int_type(*gptr());
  }

  void show_window(char* from, std::size_t bytes) {
    char* end = buffer_.data() + filled_;
    setg(buffer_.data(), from, static_cast<std::size_t>(end - from) > bytes ? from + bytes : end);
  }

  [[nodiscard]] std::uint64_t position() const { return at_ + static_cast<std::uint64_t>(gptr() - eback()); }

  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode mode) override {
    if (from == std::ios_base::beg) return seekpos(offset, mode);
    if (from == std::ios_base::end) return move_to(static_cast<off_type>(input_.size()) + offset);
    if (offset == 0) told_ = position();
    return move_to(static_cast<off_type>(position()) + offset);
  }

  /// To a chunk, to the table of chunks, or, as LASzip skips layers, on from the place it has just asked for;
  /// but to no place that only the table takes for a chunk.
  pos_type seekpos(pos_type place, std::ios_base::openmode) override {
    const auto to = static_cast<std::uint64_t>(off_type(place));
    const bool skips = told_ == position() && to >= told_;
    if (!layered_chunks_.empty() && !skips && to > points_at_ + 8 &&
        !std::binary_search(layered_chunks_.begin(), layered_chunks_.end(), to) &&
        std::exchange(table_seen_, true))
      return pos_type(off_type(-1));
    return move_to(place);
  }

  pos_type move_to(off_type to) {
    const pos_type position = to;
    if (to < 0) return pos_type(off_type(-1));
    const off_type inside = to - static_cast<off_type>(at_);
    if (inside >= 0 && inside <= static_cast<off_type>(filled_)) {
      show_window(buffer_.data() + inside, window_);
    } else {
      at_ = static_cast<std::uint64_t>(to);
      filled_ = 0;
      setg(buffer_.data(), buffer_.data(), buffer_.data());
    }
    return position;
  }

  /// Bytes from at_ on; zeros between the header and the points.
  std::size_t fill() {
    const auto bytes = std::as_writable_bytes(std::span(buffer_));
    const std::uint64_t made = std::max<std::uint64_t>(points_at_, head_.size());
    if (at_ >= made) return input_.read_at(at_, bytes);
    const std::size_t count = std::min<std::uint64_t>(bytes.size(), made - at_);
    std::fill_n(bytes.begin(), count, std::byte{0});
    if (at_ < head_.size())
      std::copy_n(head_.begin() + static_cast<std::ptrdiff_t>(at_), std::min(count, head_.size() - at_),
                  bytes.begin());
    return count;
  }

  const InputFile& input_;
  std::vector<std::byte> head_;
  std::uint64_t points_at_;
  std::size_t window_;  ///< bytes that LASzip takes without asking
  std::uintptr_t stack_ = here();
  const std::vector<std::uint64_t> layered_chunks_;
  bool table_seen_ = false;
  std::uint64_t told_ = 0;  ///< the last position that was asked for
  std::uint64_t at_ = 0;    ///< position of the buffer
  std::size_t filled_ = 0;  ///< bytes of the buffer
  bool ended_ = false;
  std::vector<char> buffer_ = std::vector<char>(kBuffer);
  std::istream stream_{this};
};

std::uint32_t laz_chunk_rows(const LasHeader& header) {
  const std::byte* record = header.laszip_record.data();
  if (header.laszip_record.size() < kItemsAt || load<std::uint16_t>(record + kCompressorAt) < 2) return 0;
  const auto rows = load<std::uint32_t>(record + kChunkRowsAt);
  return rows == 0 ? kVariableChunk : rows;
}

std::vector<std::size_t> laszip_layers(const LasHeader& header) {
  const std::vector<std::byte>& record = header.laszip_record;
  std::vector<std::size_t> layers;
  if (load<std::uint16_t>(record.data() + kCompressorAt) != 3) return layers;
  const std::size_t items = load<std::uint16_t>(record.data() + kItemCountAt);
  for (std::size_t i = 0; i < items; ++i) {
    const std::byte* item = record.data() + kItemsAt + 6 * i;
    switch (load<std::uint16_t>(item)) {
      case 10:
        layers.push_back(9);
        break;  // the standard fields
      case 12:
        layers.push_back(2);
        break;  // colour and near infrared
      case 14:
        layers.push_back(load<std::uint16_t>(item + 2));
        break;  // extra bytes, one by one
      default:
        layers.push_back(1);  // colour, wave packet
    }
  }
  return layers;
}

void check_laszip_record(const InputFile& input, const LasHeader& header) {
  const auto require = [&](bool good) {
    if (!good)
      throw Error(ErrorCode::file_format,
                  input.path().string() + ": its LASzip record does not fit its points");
  };
  const std::vector<std::byte>& record = header.laszip_record;
  require(record.size() >= kItemsAt);
  const std::size_t items = load<std::uint16_t>(record.data() + kItemCountAt);
  require(items >= 1 && record.size() >= kItemsAt + 6 * items);
  constexpr std::array<std::size_t, 15> kSizes{0, 2, 4, 8, 4, 8, 20, 8, 6, 29, 30, 6, 8, 29, 0};
  std::size_t length = 0;
  for (std::size_t i = 0; i < items; ++i) {
    const std::byte* item = record.data() + kItemsAt + 6 * i;
    const auto type = load<std::uint16_t>(item);
    const auto size = load<std::uint16_t>(item + 2);
    const bool first = type == 6 || type == 10;
    require(type < kSizes.size() && (kSizes[type] == 0 || kSizes[type] == size) && first == (i == 0));
    require((type == 6) == (header.format < 6) || !first);
    // What LASzip 3 knows; refusing the rest itself, it forgets some memory.
    const auto version = load<std::uint16_t>(item + 4);
    require(type < 10 ? type >= 6 || type == 0 : version >= 2);
    require(version >= 1 && version <= (type == 9 ? 1 : type < 10 ? 2 : 4));
    length += size;
  }
  const auto compressor = load<std::uint16_t>(record.data() + kCompressorAt);
  require(length == header.record_length && compressor >= 1 && compressor <= 3);
  require(load<std::uint16_t>(record.data() + kCoderAt) == 0 && (compressor == 3) == (header.format >= 6));
  std::size_t head = header.block.size() + kVlrHead + record.size();
  if (!header.compatibility_record.empty())
    head += 2 * kVlrHead + header.compatibility_record.size() + header.extra_bytes_record.size();
  require(head <= header.points_at && header.extra_bytes_record.size() <= 0xffff);
}

LazReader::LazReader(const InputFile& input, const LasHeader& header, LazFields fields)
    : name_(input.path().string()), point_count_(header.point_count), chunk_rows_(laz_chunk_rows(header)) {
  check_laszip_record(input, header);
  stream_ = std::make_unique<Stream>(input, header);
  stream_->enter();
  if (laszip_create(&laszip_) != 0) throw Error(ErrorCode::file_format, name_ + ": LASzip cannot start");
  if (!header.compatibility_record.empty()) laszip_request_compatibility_mode(laszip_, 1);
  if (fields == LazFields::coordinates_and_colours)
    laszip_decompress_selective(laszip_, laszip_DECOMPRESS_SELECTIVE_RGB);
  laszip_BOOL compressed = 0;
  laszip_header_struct* seen = nullptr;
  if (laszip_open_reader_stream(laszip_, stream_->stream(), &compressed) != 0 ||
      laszip_get_header_pointer(laszip_, &seen) != 0 || laszip_get_point_pointer(laszip_, &point_) != 0) {
    const std::string why = message();
    laszip_destroy(laszip_);
    throw Error(ErrorCode::file_format, name_ + ": " + why);
  }
  format_ = seen->point_data_format;
  record_length_ = seen->point_data_record_length;
  if (format_ > 10 || record_length_ < las_format_length(format_)) {
    laszip_destroy(laszip_);
    throw Error(ErrorCode::file_format, name_ + ": LASzip sees points that no LAS file has");
  }
  ahead_.resize(record_length_);
  standard_length_ = las_format_length(format_);
  times_at_ = las_times_at(format_);
  colours_at_ = las_colours_at(format_);
}

LazReader::~LazReader() {
  laszip_close_reader(laszip_);
  laszip_destroy(laszip_);
}

std::string LazReader::message() const {
  laszip_CHAR* text = nullptr;
  laszip_get_error(laszip_, &text);
  std::string line = text == nullptr ? "LASzip cannot read it" : text;
  for (char& letter : line)
    letter = letter == '\n' ? ' ' : letter;
  return line;
}

void LazReader::fail(std::uint64_t row, std::uint64_t first) const {
  // Damage shows only some way behind the place where it is. What came before its chunk is sure.
  const bool cut = stream_->ended();
  if (!cut && chunk_rows_ == kVariableChunk) row = first;
  if (!cut && chunk_rows_ != kVariableChunk && chunk_rows_ != 0 && row > 0)
    row = (row - 1) / chunk_rows_ * chunk_rows_;
  throw Error(ErrorCode::file_format, name_ + (cut ? ": cut short after point " : ": damaged after point ") +
                                          std::to_string(row) + " of " + std::to_string(point_count_));
}

void LazReader::seek(std::uint64_t row) {
  stream_->enter();
  if (laszip_seek_point(laszip_, static_cast<laszip_I64>(row)) != 0) fail(row, row);
  next_ = decoded_ = row;
}

bool LazReader::read_point() {
  stream_->enter();
  if (laszip_read_point(laszip_) != 0) return false;
  ++decoded_;
  return true;
}

void LazReader::read(std::uint64_t first, std::span<std::byte> records) {
  if (first != next_) seek(first);
  const std::size_t rows = records.size() / record_length_;
  std::byte* out = records.data();
  for (std::size_t row = 0; row < rows; ++row, out += record_length_) {
    if (next_ < decoded_) {
      std::copy(ahead_.begin(), ahead_.end(), out);
    } else {
      if (!read_point()) fail(next_, first);
      pack(out);
    }
    ++next_;
  }
  if (next_ == decoded_ && next_ < point_count_) {
    if (!read_point()) fail(next_, first);
    pack(ahead_.data());
  }
}

void LazReader::pack(std::byte* record) const {
  const laszip_point_struct& point = *point_;
  std::memcpy(record, &point.X, 14);  // X, Y, Z, intensity
  const bool newest = format_ >= 6;
  const auto bits = [](unsigned value, int shift) { return value << shift; };
  const unsigned direction = bits(point.scan_direction_flag, 6) | bits(point.edge_of_flight_line, 7);
  if (newest) {
    store(record + 14, static_cast<std::uint8_t>(point.extended_return_number |
                                                 bits(point.extended_number_of_returns, 4)));
    store(record + 15, static_cast<std::uint8_t>(point.extended_classification_flags |
                                                 bits(point.extended_scanner_channel, 4) | direction));
    store(record + 16, point.extended_classification);
    store(record + 17, point.user_data);
    store(record + 18, point.extended_scan_angle);
    store(record + 20, point.point_source_ID);
  } else {
    store(record + 14,
          static_cast<std::uint8_t>(point.return_number | bits(point.number_of_returns, 3) | direction));
    store(record + 15,
          static_cast<std::uint8_t>(point.classification | bits(point.synthetic_flag, 5) |
                                    bits(point.keypoint_flag, 6) | bits(point.withheld_flag, 7)));
    store(record + 16, point.scan_angle_rank);
    store(record + 17, point.user_data);
    store(record + 18, point.point_source_ID);
  }
  if (times_at_ != 0) store(record + times_at_, point.gps_time);
  if (colours_at_ != 0) std::memcpy(record + colours_at_, point.rgb, format_ == 8 || format_ == 10 ? 8 : 6);
  const std::size_t standard = standard_length_;
  if (format_ == 4 || format_ == 5 || format_ >= 9)
    std::memcpy(record + standard - 29, point.wave_packet, 29);
  const std::size_t extra = record_length_ - standard;
  const std::size_t given = std::min(extra, static_cast<std::size_t>(std::max(point.num_extra_bytes, 0)));
  if (given != 0) std::memcpy(record + standard, point.extra_bytes, given);
  if (given < extra) std::fill_n(record + standard + given, extra - given, std::byte{0});
}

}  // namespace ray
