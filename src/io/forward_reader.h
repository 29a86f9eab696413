#pragma once
/// A file read from front to back, a few bytes at a time.

#include "input_file.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ray {

/// Through a buffer of 1 MiB, or of what `peek` asks for.
class ForwardReader {
 public:
  ForwardReader(const InputFile& file, std::uint64_t offset) : file_(file), offset_(offset) {}

  [[nodiscard]] std::uint64_t position() const { return offset_ + used_; }
  void seek(std::uint64_t position) {
    offset_ = position;
    used_ = 0;
    buffer_.clear();
  }

  /// The bytes from here on: at least `wanted` if the file has them. Valid until the next call.
  [[nodiscard]] std::span<const std::byte> peek(std::size_t wanted) {
    if (buffer_.size() - used_ < wanted && offset_ + buffer_.size() < file_.size()) {
      buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(used_));
      offset_ += used_;
      used_ = 0;
      const std::size_t kept = buffer_.size();
      buffer_.resize(static_cast<std::size_t>(
          std::min<std::uint64_t>(std::max(wanted, kBuffer), file_.size() - offset_)));
      buffer_.resize(kept + file_.read_at(offset_ + kept, std::span(buffer_).subspan(kept)));
    }
    return std::span<const std::byte>(buffer_).subspan(used_);
  }

  /// Forwards by a number of bytes that may lie beyond the buffer. False if the file has fewer.
  [[nodiscard]] bool skip(std::uint64_t bytes) {
    const std::uint64_t here = position();
    if (bytes > file_.size() - std::min(here, file_.size())) return false;
    if (bytes <= buffer_.size() - used_)
      used_ += static_cast<std::size_t>(bytes);
    else
      seek(here + bytes);
    return true;
  }

 private:
  static constexpr std::size_t kBuffer = std::size_t{1} << 20;

  const InputFile& file_;
  std::uint64_t offset_;  // of the buffer in the file
  std::size_t used_ = 0;  // bytes of the buffer
  std::vector<std::byte> buffer_;
};

}  // namespace ray
