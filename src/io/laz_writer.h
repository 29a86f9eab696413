#pragma once
/// Point records of formats 6 and 7 into a LAZ file, by LASzip.

#include <raycloud/io/atomic_file.h>

#include <laszip/laszip_api.h>

#include <memory>
#include <span>
#include <vector>

namespace ray {

class LazWriter {
 public:
  LazWriter(AtomicFile& file, int format, std::size_t record_length);
  ~LazWriter();
  LazWriter(const LazWriter&) = delete;
  LazWriter& operator=(const LazWriter&) = delete;

  /// The whole variable length record that the file's header must have.
  [[nodiscard]] std::vector<std::byte> laszip_record() const;

  /// Starts the points at the end of the file, which must hold everything before them.
  void begin();
  /// Adds whole records. Throws Error(file_access).
  void write(std::span<const std::byte> records);
  /// Completes what `begin` began.
  void end();

 private:
  class Stream;
  void check(laszip_I32 result) const;
  void unpack(const std::byte* record);

  AtomicFile& file_;
  int format_;
  std::size_t record_length_;
  std::unique_ptr<Stream> stream_;
  void* laszip_ = nullptr;
  laszip_point_struct* point_ = nullptr;
};

}  // namespace ray
