#pragma once
/// The public header block of LAS 1.0–1.4 and the variable length records that matter here.

#include "input_file.h"
#include "las_bytes.h"
#include "las_notes.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ray {

/// A value in the bytes behind the standard fields of a point record.
struct LasExtraField {
  std::string name;
  ScalarType type = ScalarType::uint8;
  std::size_t at = 0;  ///< byte in the record
  bool scaled = false;
  double scale = 1.0;
  double offset = 0.0;
};

struct LasHeader {
  int minor = 2;   ///< of version 1.x
  int format = 0;  ///< of the point records, 0–10
  std::size_t record_length = 20;
  std::uint64_t points_at = 0;  ///< byte
  std::uint64_t point_count = 0;
  std::array<double, 3> scale{0.01, 0.01, 0.01};
  std::array<double, 3> offset{};
  std::uint16_t global_encoding = 0;
  std::string time_base;  ///< as CloudInfo::time_base
  std::string crs;        ///< as CloudInfo::crs
  LasNotes notes;
  std::vector<LasExtraField> extra_fields;

  /// As stored, for LASzip.
  std::vector<std::byte> block;
  std::vector<std::byte> laszip_record;         ///< empty: not compressed
  std::vector<std::byte> compatibility_record;  ///< points of LAS 1.4 stored in an older format
  std::vector<std::byte> extra_bytes_record;
  bool chunk_table_lost = false;  ///< LASzip's, at the end of the file; its readers then do without
  std::vector<std::uint64_t> layered_chunks;  ///< where they begin (laz_layers.h), once they are checked
  /// COPC: where its root page is and how many bytes it has; else 0.
  std::uint64_t copc_pages_at = 0;
  std::uint64_t copc_pages_size = 0;

  [[nodiscard]] bool compressed() const { return !laszip_record.empty(); }
};

/// Bytes of the standard fields of point format 0–10.
[[nodiscard]] std::size_t las_format_length(int format);

/// Throws Error(file_format) for what is not LAS and for numbers that contradict each other; optional records
/// that make no sense are taken for absent. Memory: 64 KiB and the records it keeps, never more than the file
/// has.
[[nodiscard]] LasHeader parse_las_header(const InputFile& input);

/// The fields of the extra bytes VLR, and one for each byte that it leaves undescribed.
[[nodiscard]] std::vector<LasExtraField> parse_extra_fields(std::span<const std::byte> record, int format,
                                                            std::size_t record_length);

}  // namespace ray
