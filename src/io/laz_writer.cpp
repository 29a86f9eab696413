#include "laz_writer.h"

#include "las_header.h"

#include <raycloud/core/error.h>

#include <exception>
#include <ostream>
#include <utility>

namespace ray {

/// The end of a file as a stream. LASzip goes back once, to say where its chunk table is.
class LazWriter::Stream : private std::streambuf {
 public:
  explicit Stream(AtomicFile& file) : file_(file), at_(file.size()) { reset(); }

  [[nodiscard]] std::ostream& stream() { return stream_; }
  /// Streams swallow exceptions.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

  int sync() override {
    try {
      const auto bytes = std::as_bytes(std::span(pbase(), pptr()));
      if (file_.seekable()) {
        file_.write_at(at_, bytes);
      } else {
        file_.write(bytes);
      }
      at_ += bytes.size();
    } catch (...) {
      failure_ = std::current_exception();
      return -1;
    }
    reset();
    return 0;
  }

 private:
  void reset() { setp(buffer_.data(), buffer_.data() + buffer_.size()); }

  int_type overflow(int_type letter) override {
    if (sync() != 0) return traits_type::eof();
    if (traits_type::eq_int_type(letter, traits_type::eof())) return traits_type::not_eof(letter);
    return sputc(traits_type::to_char_type(letter));
  }

  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode mode) override {
    // A pipe cannot be changed afterwards; LASzip then puts the place of its table at the very end.
    if (!file_.seekable()) return pos_type(off_type(-1));
    if (from == std::ios_base::cur && offset == 0) return static_cast<off_type>(at_) + (pptr() - pbase());
    if (sync() != 0) return pos_type(off_type(-1));
    if (from == std::ios_base::cur) offset += static_cast<off_type>(at_);
    if (from == std::ios_base::end) offset += static_cast<off_type>(file_.size());
    return seekpos(offset, mode);
  }

  pos_type seekpos(pos_type position, std::ios_base::openmode) override {
    if (!file_.seekable() || sync() != 0) return pos_type(off_type(-1));
    at_ = static_cast<std::uint64_t>(off_type(position));
    return position;
  }

  AtomicFile& file_;
  std::uint64_t at_;  ///< position of the buffer
  std::exception_ptr failure_;
  std::vector<char> buffer_ = std::vector<char>(1 << 18);
  std::ostream stream_{this};
};

LazWriter::LazWriter(AtomicFile& file, int format, std::size_t record_length)
    : file_(file), format_(format), record_length_(record_length) {
  if (laszip_create(&laszip_) != 0) throw Error(ErrorCode::file_access, "LASzip cannot start");
  check(laszip_request_native_extension(laszip_, 1));
  check(laszip_set_point_type_and_size(laszip_, static_cast<laszip_U8>(format),
                                       static_cast<laszip_U16>(record_length)));
  check(laszip_get_point_pointer(laszip_, &point_));
}

LazWriter::~LazWriter() {
  laszip_destroy(laszip_);
}

void LazWriter::check(laszip_I32 result) const {
  if (result == 0) return;
  if (stream_) stream_->rethrow();
  laszip_CHAR* text = nullptr;
  laszip_get_error(laszip_, &text);
  throw Error(ErrorCode::file_access,
              file_.path().string() + ": cannot write: " + (text == nullptr ? "LASzip failed" : text));
}

std::vector<std::byte> LazWriter::laszip_record() const {
  laszip_U8* bytes = nullptr;
  laszip_U32 size = 0;
  check(laszip_create_laszip_vlr(laszip_, &bytes, &size));
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  return {first, first + size};
}

void LazWriter::begin() {
  stream_ = std::make_unique<Stream>(file_);
  check(laszip_open_writer_stream(laszip_, stream_->stream(), 1, 1));
  point_->extended_point_type = 1;
}

void LazWriter::write(std::span<const std::byte> records) {
  for (const std::byte* record = records.data(); record != records.data() + records.size();
       record += record_length_) {
    unpack(record);
    check(laszip_write_point(laszip_));
  }
}

void LazWriter::end() {
  check(laszip_close_writer(laszip_));
  stream_->sync();
  stream_->rethrow();
}

void LazWriter::unpack(const std::byte* record) {
  laszip_point_struct& point = *point_;
  std::memcpy(&point.X, record, 14);  // X, Y, Z, intensity
  const auto returns = load<std::uint8_t>(record + 14);
  const auto flags = load<std::uint8_t>(record + 15);
  point.extended_return_number = returns & 15;
  point.extended_number_of_returns = (returns >> 4) & 15;
  point.extended_classification_flags = flags & 15;
  // LASzip insists that the older fields say the same.
  point.synthetic_flag = flags & 1;
  point.keypoint_flag = (flags >> 1) & 1;
  point.withheld_flag = (flags >> 2) & 1;
  point.extended_scanner_channel = (flags >> 4) & 3;
  point.scan_direction_flag = (flags >> 6) & 1;
  point.edge_of_flight_line = (flags >> 7) & 1;
  point.extended_classification = load<std::uint8_t>(record + 16);
  point.user_data = load<std::uint8_t>(record + 17);
  point.extended_scan_angle = load<std::int16_t>(record + 18);
  point.point_source_ID = load<std::uint16_t>(record + 20);
  point.gps_time = load<double>(record + 22);
  const std::size_t standard = las_format_length(format_);
  if (format_ == 7) std::memcpy(point.rgb, record + 30, 6);
  if (record_length_ > standard) std::memcpy(point.extra_bytes, record + standard, record_length_ - standard);
}

}  // namespace ray
