#include "input_file.h"

#include <raycloud/core/error.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace ray {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
  if (error == ENOENT || error == ENOTDIR) {
    throw Error(ErrorCode::file_not_found, path.string() + ": no such file");
  }
  throw Error(ErrorCode::file_access,
              path.string() + ": cannot read: " + std::generic_category().message(error));
}

}  // namespace

InputFile::InputFile(const std::filesystem::path& path, const ReadOptions& options)
    // Not to hang on a pipe that nobody writes to.
    : path_(path),
      descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)),
      will_be_replaced_(options.will_be_replaced) {
  if (descriptor_ < 0) fail(path, errno);
  struct stat status {};
  const int error = ::fstat(descriptor_, &status) == 0 ? 0 : errno;
  if (error == 0 && S_ISREG(status.st_mode)) {
    size_ = static_cast<std::uint64_t>(status.st_size);
    ::posix_fadvise(descriptor_, 0, 0, POSIX_FADV_SEQUENTIAL);
    return;
  }
  ::close(descriptor_);
  if (error != 0) fail(path, error);
  throw Error(ErrorCode::file_access,
              path.string() + (S_ISDIR(status.st_mode) ? ": a folder, not a file"
                                                       : ": a pipe or a device, which cannot be read: "
                                                         "store it in a file first"));
}

InputFile::~InputFile() {
  ::close(descriptor_);
}

std::size_t InputFile::read_at(std::uint64_t offset, std::span<std::byte> bytes) const {
  constexpr std::uint64_t kForgotten = 32 << 20;  // at a time
  if (will_be_replaced_ && offset / kForgotten != (offset + bytes.size()) / kForgotten)
    ::posix_fadvise(descriptor_, 0, static_cast<off_t>(offset), POSIX_FADV_DONTNEED);
  constexpr std::size_t kMaxRead = std::size_t{1} << 30;
  std::size_t total = 0;
  while (total < bytes.size()) {
    const auto got = ::pread(descriptor_, bytes.data() + total, std::min(bytes.size() - total, kMaxRead),
                             static_cast<off_t>(offset + total));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(path_, errno);
    if (got == 0) break;
    total += static_cast<std::size_t>(got);
  }
  return total;
}

}  // namespace ray
