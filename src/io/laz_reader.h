#pragma once
/// Point records out of a LAZ file, by LASzip.

#include "las_header.h"

#include <laszip/laszip_api.h>

#include <memory>
#include <vector>

namespace ray {

enum class LazFields { all, coordinates_and_colours };

/// Gives the records as an uncompressed file of the same point format has them. One thread at a time; readers
/// of the same file do not disturb each other.
///
/// LASzip sees the file through a stream whose header this project has made from what it has checked, so that
/// odd optional records cannot confuse it and a file that is replaced stays the one that was opened.
class LazReader {
 public:
  /// `input` must outlive this. Throws Error(file_format).
  LazReader(const InputFile& input, const LasHeader& header, LazFields fields = LazFields::all);
  ~LazReader();
  LazReader(const LazReader&) = delete;
  LazReader& operator=(const LazReader&) = delete;

  /// What LASzip gives: differs from the file's own where points of LAS 1.4 were stored in an older format.
  [[nodiscard]] int format() const { return format_; }
  [[nodiscard]] std::size_t record_length() const { return record_length_; }

  /// The row that `read` gives without seeking.
  [[nodiscard]] std::uint64_t next_row() const { return next_; }

  /// Fills `records` with whole records from row `first` on. Looks one row further, because LASzip tells that
  /// a piece of the file was damaged only when the next begins. Throws Error(file_format) naming the last
  /// good point.
  void read(std::uint64_t first, std::span<std::byte> records);

 private:
  class Stream;
  void seek(std::uint64_t row);
  [[nodiscard]] bool read_point();
  void pack(std::byte* record) const;
  /// `row` could not be read, in a call that began with row `first`.
  [[noreturn]] void fail(std::uint64_t row, std::uint64_t first) const;
  [[nodiscard]] std::string message() const;

  std::string name_;
  std::uint64_t point_count_;
  std::uint32_t chunk_rows_;
  int format_ = 0;
  std::size_t record_length_ = 0;
  std::size_t standard_length_ = 0;  ///< of the record, without extra bytes
  std::size_t times_at_ = 0;         ///< byte in the record, 0 where there are none
  std::size_t colours_at_ = 0;
  std::unique_ptr<Stream> stream_;
  void* laszip_ = nullptr;
  laszip_point_struct* point_ = nullptr;
  std::uint64_t next_ = 0;        ///< row that `read` would give
  std::uint64_t decoded_ = 0;     ///< row that LASzip would give
  std::vector<std::byte> ahead_;  ///< the record of row next_, if decoded_ is one more
};

/// Rows of each of the pieces that LASzip can start at, by LASzip's own record; 0 if it can start nowhere but
/// at the first point, kVariableChunk where pieces differ.
[[nodiscard]] std::uint32_t laz_chunk_rows(const LasHeader& header);
inline constexpr std::uint32_t kVariableChunk = 0xffffffff;

/// How many layers LASzip stores for each item of a point, by its own record; empty where it stores whole
/// points.
[[nodiscard]] std::vector<std::size_t> laszip_layers(const LasHeader& header);

/// Throws Error(file_format) unless LASzip's record describes points of the header's format and length.
void check_laszip_record(const InputFile& input, const LasHeader& header);

}  // namespace ray
