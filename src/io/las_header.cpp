#include "las_header.h"

#include "las_crs.h"

#include <raycloud/core/error.h>

#include <cmath>
#include <string_view>

namespace ray {
namespace {

constexpr std::array<std::size_t, 11> kFormatLength{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::uint64_t kMaxRecord = 1 << 24;  ///< bytes of a record that is kept

[[noreturn]] void fail(const InputFile& input, const std::string& why) {
  throw Error(ErrorCode::file_format, input.path().string() + ": " + why);
}

std::size_t block_length(int minor) {
  return minor <= 2 ? 227 : minor == 3 ? 235 : 375;
}

std::string_view text_at(const std::byte* bytes, std::size_t most) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), most);
  return text.substr(0, text.find('\0'));
}

/// A variable length record, extended or not.
struct Record {
  std::string user;
  int id = 0;
  std::uint64_t at = 0;
  std::uint64_t length = 0;
};

/// The records between two places of the file, as far as they make sense.
std::vector<Record> list_records(const InputFile& input, std::uint64_t at, std::uint64_t end,
                                 std::uint64_t count, bool extended) {
  std::vector<Record> records;
  std::array<std::byte, 60> head;
  const std::size_t head_length = extended ? 60 : 54;
  while (count-- > 0 && at < end && end - at >= head_length) {
    if (input.read_at(at, std::span(head).first(head_length)) < head_length) break;
    Record record;
    record.user = text_at(head.data() + 2, 16);
    record.id = load<std::uint16_t>(head.data() + 18);
    record.at = at + head_length;
    record.length = extended ? load<std::uint64_t>(head.data() + 20) : load<std::uint16_t>(head.data() + 20);
    if (record.length > end - record.at) break;
    at = record.at + record.length;
    records.push_back(std::move(record));
  }
  return records;
}

std::vector<std::byte> read_record(const InputFile& input, const Record& record) {
  if (record.length > kMaxRecord) return {};
  std::vector<std::byte> bytes(record.length);
  bytes.resize(input.read_at(record.at, bytes));
  return bytes;
}

/// Everything in front of the records.
LasHeader parse_block(const InputFile& input) {
  LasHeader header;
  header.block.resize(375);
  header.block.resize(input.read_at(0, header.block));
  const std::byte* block = header.block.data();
  if (header.block.size() < 4 || text_at(block, 4) != "LASF")
    fail(input, "not a LAS file (it does not start with LASF)");
  if (header.block.size() < 227) fail(input, "cut short in its header");
  const int major = load<std::uint8_t>(block + 24);
  header.minor = load<std::uint8_t>(block + 25);
  if (major != 1 || header.minor > 5)
    fail(input,
         "LAS version " + std::to_string(major) + "." + std::to_string(header.minor) + " is not known");
  header.block.resize(std::min(header.block.size(), block_length(header.minor)));
  if (load<std::uint16_t>(block + 94) < block_length(header.minor) ||
      header.block.size() < block_length(header.minor))
    fail(input, "its header is shorter than LAS 1." + std::to_string(header.minor) + " demands");
  header.global_encoding = load<std::uint16_t>(block + 6);
  header.points_at = load<std::uint32_t>(block + 96);
  header.format = load<std::uint8_t>(block + 104) & 0x3f;
  header.record_length = load<std::uint16_t>(block + 105);
  header.point_count = load<std::uint32_t>(block + 107);
  if (header.minor >= 4) {
    const auto count = load<std::uint64_t>(block + 247);
    if (count != 0) header.point_count = count;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    header.scale[axis] = load<double>(block + 131 + 8 * axis);
    header.offset[axis] = load<double>(block + 155 + 8 * axis);
  }
  return header;
}

void check_block(const InputFile& input, const LasHeader& header) {
  if (header.format > 10) fail(input, "point format " + std::to_string(header.format) + " is not known");
  if (header.record_length < las_format_length(header.format))
    fail(input, "its point records of " + std::to_string(header.record_length) +
                    " bytes are too short for point format " + std::to_string(header.format));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double scale = header.scale[axis];
    const double most = std::abs(scale) * 2147483648.0 + std::abs(header.offset[axis]);
    if (scale == 0.0 || !std::isfinite(most))
      fail(input, "the scale or offset of its coordinates is no number to scale with");
  }
  if (header.point_count == 0) return;
  if (header.points_at < header.block.size()) fail(input, "its points start inside its header");
  if (header.points_at > input.size()) fail(input, "cut short before its first point");
}

void take_projection(const InputFile& input, const std::vector<Record>& records, LasHeader& header) {
  std::string keys_crs;
  for (const Record& record : records) {
    if (record.user != "LASF_Projection") continue;
    if (record.id == 2112 && header.crs.empty()) header.crs = one_line_wkt(read_record(input, record));
    if (record.id == 34735 && keys_crs.empty()) keys_crs = epsg_of_geokeys(read_record(input, record));
  }
  if (header.crs.empty()) header.crs = keys_crs;
}

/// Bit 6 (LAS 1.5): seconds are counted from another moment than 1e9.
std::string time_base_of(const LasHeader& header) {
  if (header.format == 0 || header.format == 2) return "";
  if ((header.global_encoding & 1) == 0) return "gps_week";
  return header.minor >= 5 && (header.global_encoding & 64) != 0 ? "" : "gps_adjusted";
}

void take_notes(const InputFile& input, const std::vector<Record>& records, LasHeader& header) {
  std::string text;
  for (const Record& record : records) {
    if (record.user != "raycloud") continue;
    const std::vector<std::byte> bytes = read_record(input, record);
    text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  header.notes = parse_las_notes(text);
  if (!header.notes.there) return;
  header.time_base = header.notes.time_base;
  if (header.crs.empty()) header.crs = header.notes.crs;
}

void take_records(const InputFile& input, const std::vector<Record>& records, LasHeader& header) {
  for (const Record& record : records) {
    if (record.user == "laszip encoded" && record.id == 22204)
      header.laszip_record = read_record(input, record);
    if (record.user == "lascompatible" && record.id == 22204)
      header.compatibility_record = read_record(input, record);
    if (record.user == "LASF_Spec" && record.id == 4 && header.extra_bytes_record.empty())
      header.extra_bytes_record = read_record(input, record);
    if (record.user == "copc" && record.id == 1 && record.length >= 56) {
      const std::vector<std::byte> copc = read_record(input, record);
      header.copc_pages_at = load<std::uint64_t>(copc.data() + 40);
      header.copc_pages_size = load<std::uint64_t>(copc.data() + 48);
    }
  }
}

/// The fields of the extra bytes record without those that have no bytes behind them.
std::vector<LasExtraField> expand_field(const std::byte* entry, std::size_t number, std::size_t at) {
  constexpr std::array kTypes{ScalarType::uint8,   ScalarType::int8,   ScalarType::uint16, ScalarType::int16,
                              ScalarType::uint32,  ScalarType::int32,  ScalarType::uint64, ScalarType::int64,
                              ScalarType::float32, ScalarType::float64};
  const auto code = load<std::uint8_t>(entry + 2);
  const auto options = load<std::uint8_t>(entry + 3);
  const std::size_t count = code == 0 ? options : code <= 30 ? (code - 1) / 10 + 1 : 0;
  std::string name(text_at(entry + 4, 32));
  while (!name.empty() && name.back() == ' ')
    name.pop_back();
  for (char& letter : name)
    letter = static_cast<unsigned char>(letter) < 32 ? '_' : letter;
  if (name.empty()) name = "extra_" + std::to_string(number);
  std::vector<LasExtraField> fields(count);
  for (std::size_t i = 0; i < count; ++i) {
    LasExtraField& field = fields[i];
    field.name = count == 1 ? name : name + "_" + std::to_string(i);
    field.type = code == 0 ? ScalarType::uint8 : kTypes[(code - 1u) % 10];
    field.at = at + i * size_of(field.type);
    const std::size_t axis = std::min<std::size_t>(i, 2);
    if (code != 0 && (options & 8) != 0) field.scale = load<double>(entry + 112 + 8 * axis);
    if (code != 0 && (options & 16) != 0) field.offset = load<double>(entry + 136 + 8 * axis);
    if (!std::isfinite(field.scale) || field.scale == 0.0) field.scale = 1.0;
    if (!std::isfinite(field.offset)) field.offset = 0.0;
    field.scaled = field.scale != 1.0 || field.offset != 0.0;
  }
  return fields;
}

}  // namespace

std::size_t las_format_length(int format) {
  return kFormatLength[static_cast<std::size_t>(format)];
}

std::vector<LasExtraField> parse_extra_fields(std::span<const std::byte> record, int format,
                                              std::size_t record_length) {
  std::vector<LasExtraField> fields;
  std::size_t at = las_format_length(format);
  for (std::size_t number = 0; 192 * (number + 1) <= record.size(); ++number) {
    const std::vector<LasExtraField> expanded = expand_field(record.data() + 192 * number, number, at);
    if (expanded.empty()) break;
    const std::size_t end = expanded.back().at + size_of(expanded.back().type);
    if (end > record_length) break;
    fields.insert(fields.end(), expanded.begin(), expanded.end());
    at = end;
  }
  for (std::size_t i = 0; at < record_length; ++i, ++at) {
    fields.push_back({"extra_byte_" + std::to_string(i), ScalarType::uint8, at});
  }
  return fields;
}

LasHeader parse_las_header(const InputFile& input) {
  LasHeader header = parse_block(input);
  check_block(input, header);
  const std::byte* block = header.block.data();
  const std::uint64_t end = header.point_count == 0 ? input.size() : std::min(header.points_at, input.size());
  std::vector<Record> records =
      list_records(input, load<std::uint16_t>(block + 94), end, load<std::uint32_t>(block + 100), false);
  if (header.minor >= 4) {
    const std::vector<Record> extended = list_records(input, load<std::uint64_t>(block + 235), input.size(),
                                                      load<std::uint32_t>(block + 243), true);
    records.insert(records.end(), extended.begin(), extended.end());
  }
  header.time_base = time_base_of(header);
  take_records(input, records, header);
  take_projection(input, records, header);
  take_notes(input, records, header);
  if (!header.compressed() && (load<std::uint8_t>(block + 104) & 0xc0) != 0 && header.point_count != 0)
    fail(input, "compressed, but without the record that LASzip needs");
  header.extra_fields = parse_extra_fields(header.extra_bytes_record, header.format, header.record_length);
  return header;
}

}  // namespace ray
