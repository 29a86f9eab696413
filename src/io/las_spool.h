#pragma once
/// Pieces of data put aside on disk until all of them are known.

#include <raycloud/io/file_options.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace ray {

/// A file without a name beside `target`, which vanishes with this object whatever happens; or, where the
/// options ask to close it between writes, a hidden one that a killed process leaves behind. Memory: 16 bytes
/// a piece.
class LasSpool {
 public:
  /// Throws Error(file_access).
  LasSpool(const std::filesystem::path& target, const WriteOptions& options);
  ~LasSpool();
  LasSpool(const LasSpool&) = delete;
  LasSpool& operator=(const LasSpool&) = delete;

  void add(std::span<const std::byte> piece);
  [[nodiscard]] std::size_t size() const { return ends_.size(); }
  /// Replaces `piece` by the one of that number.
  void read(std::size_t number, std::vector<std::byte>& piece) const;

 private:
  [[noreturn]] void fail(const char* what, int error) const;
  /// Calls `use(descriptor)`.
  template <class Use>
  void with_descriptor(const char* what, const Use& use) const;

  std::string target_;
  std::string name_;     ///< empty if it has none
  int descriptor_ = -1;  ///< open if it has no name
  std::vector<std::uint64_t> ends_;
};

}  // namespace ray
