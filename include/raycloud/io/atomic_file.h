#pragma once
/// Output that appears under its name only when it is complete.

#include <raycloud/io/file_options.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace ray {

/// Writes to a new hidden file `.NAME.XXXXXX.partial` beside the target and renames it onto the target in
/// `commit`. Until then a file of that name is as it was, and the destructor removes what was written; only a
/// killed process leaves its hidden file behind, which harms nothing.
///
/// An existing target keeps its permissions (and its owner, where the process may set it) and must be
/// writable; a symbolic link stays and the file it points to is replaced; further hard links keep the old
/// content. A device or a pipe is written directly. Every failure, a full disk included, is an
/// Error(file_access) "PATH: cannot write: …". Nothing is buffered here: write pieces of 64 KiB or more. Not
/// thread-safe.
class AtomicFile {
 public:
  /// Throws if the folder is missing or cannot be written, or the target is a folder or write-protected.
  explicit AtomicFile(std::filesystem::path target, const WriteOptions& options = {});
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Adds to the end.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);

  /// Overwrites (or extends) from the byte `offset`; the end that `write` adds to becomes the larger of the
  /// old end and the end of this piece. Precondition: seekable().
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);
  void write_at(std::uint64_t offset, std::string_view text);

  /// False for a pipe or a terminal, where bytes cannot be changed once written.
  [[nodiscard]] bool seekable() const { return seekable_; }
  /// Bytes from the start to the end.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// The name given to the constructor.
  [[nodiscard]] const std::filesystem::path& path() const { return target_; }

  /// Flushes if the options say so, closes, and renames onto the target. Call once, after the last write.
  void commit();

 private:
  void open_temporary(const std::filesystem::path& real);
  void start_flush();
  void reopen();
  void close();
  /// After each use: closes if the options say so.
  void rest();
  [[noreturn]] void fail(int error) const;

  std::filesystem::path target_;
  WriteOptions options_;
  std::filesystem::path real_;       ///< the target with symbolic links resolved; empty if written directly
  std::filesystem::path temporary_;  ///< empty if there is nothing to remove
  int descriptor_ = -1;
  bool seekable_ = true;
  std::uint64_t size_ = 0;
  std::uint64_t flushing_ = 0;  ///< bytes that are on their way to the disk
};

}  // namespace ray
