#pragma once
/// What does not fit the memory, on disk for a while.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ray {

/// Several streams of bytes in one temporary file that has no name and is gone when this is, whatever ends
/// the program. It lies in the folder that TMPDIR names, or in /var/tmp. First everything is appended, then
/// read. One thread at a time.
class Spill {
 public:
  /// Holds `page_bytes` of each stream in memory. Throws Error(file_access).
  Spill(std::size_t streams, std::size_t page_bytes);
  ~Spill();
  Spill(const Spill&) = delete;
  Spill& operator=(const Spill&) = delete;

  /// Throws Error(file_access) when the disk is full.
  void append(std::size_t stream, const void* data, std::size_t bytes);
  /// Copies the next bytes of the stream; precondition: there are as many. Throws Error(file_access).
  void read(std::size_t stream, void* data, std::size_t bytes);
  /// Bytes that were appended.
  [[nodiscard]] std::uint64_t size(std::size_t stream) const { return streams_[stream].size; }
  /// The stream is read from its beginning again. Throws Error(file_access) when the disk is full.
  void rewind(std::size_t stream);
  /// Frees the memory of a stream that has been read and will not be again.
  void drop(std::size_t stream);

 private:
  struct Stream {
    std::vector<std::byte> page;
    std::vector<std::uint64_t> pages;  ///< where the full ones are in the file
    std::uint64_t size = 0;
    std::uint64_t read = 0;
    std::uint64_t loaded = ~std::uint64_t{0};  ///< the number of the page in memory, when reading
  };
  void write_page(Stream& stream);
  void load_page(Stream& stream, std::uint64_t number);
  void read_file(std::uint64_t from, std::byte* to, std::size_t bytes) const;

  std::size_t page_bytes_;
  int file_ = -1;
  std::uint64_t end_ = 0;
  std::vector<Stream> streams_;
};

}  // namespace ray
