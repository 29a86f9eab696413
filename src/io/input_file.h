#pragma once
/// A regular file opened for reading at any position, by any number of threads.

#include <raycloud/io/file_options.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace ray {

class InputFile {
 public:
  /// Throws Error(file_not_found) or Error(file_access), with the reason in one line.
  explicit InputFile(const std::filesystem::path& path, const ReadOptions& options = {});
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// Thread-safe. Fills `bytes` from `offset` on and returns how many there were: fewer only at the end of
  /// the file.
  std::size_t read_at(std::uint64_t offset, std::span<std::byte> bytes) const;

  /// When it was opened.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int descriptor_;
  bool will_be_replaced_;
  std::uint64_t size_ = 0;
};

}  // namespace ray
