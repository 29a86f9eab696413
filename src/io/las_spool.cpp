#include "las_spool.h"

#include <raycloud/core/error.h>

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace ray {

LasSpool::LasSpool(const std::filesystem::path& target, const WriteOptions& options)
    : target_(target.string()) {
  std::error_code ignored;
  // What is piped away has no folder of its own.
  const bool file =
      !std::filesystem::exists(target, ignored) || std::filesystem::is_regular_file(target, ignored);
  const auto folder = !file                      ? std::filesystem::temp_directory_path(ignored)
                      : target.has_parent_path() ? target.parent_path()
                                                 : std::filesystem::path(".");
  name_ = (folder / ".raycloud.XXXXXX").string();
  descriptor_ = ::mkostemp(name_.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail("write", errno);
  if (options.close_between_writes) {
    ::close(std::exchange(descriptor_, -1));
  } else {
    ::unlink(name_.c_str());
    name_.clear();
  }
}

LasSpool::~LasSpool() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!name_.empty()) ::unlink(name_.c_str());
}

template <class Use>
void LasSpool::with_descriptor(const char* what, const Use& use) const {
  if (name_.empty()) return use(descriptor_);
  const int descriptor = ::open(name_.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) fail(what, errno);
  try {
    use(descriptor);
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  if (::close(descriptor) != 0 && errno != EINTR) fail(what, errno);
}

void LasSpool::fail(const char* what, int error) const {
  throw Error(ErrorCode::file_access, target_ + ": cannot " + what + " the temporary file beside it: " +
                                          std::generic_category().message(error));
}

void LasSpool::add(std::span<const std::byte> piece) {
  const std::uint64_t start = ends_.empty() ? 0 : ends_.back();
  ends_.push_back(start + piece.size());
  with_descriptor("write", [&](int descriptor) {
    for (std::uint64_t at = start; !piece.empty();) {
      const auto written = ::pwrite(descriptor, piece.data(), piece.size(), static_cast<off_t>(at));
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail("write", errno);
      piece = piece.subspan(static_cast<std::size_t>(written));
      at += static_cast<std::uint64_t>(written);
    }
  });
}

void LasSpool::read(std::size_t number, std::vector<std::byte>& piece) const {
  const std::uint64_t at = number == 0 ? 0 : ends_[number - 1];
  piece.resize(ends_[number] - at);
  with_descriptor("read", [&](int descriptor) {
    for (std::size_t done = 0; done < piece.size();) {
      const auto got =
          ::pread(descriptor, piece.data() + done, piece.size() - done, static_cast<off_t>(at + done));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) fail("read", got < 0 ? errno : EIO);
      done += static_cast<std::size_t>(got);
    }
  });
}

}  // namespace ray
