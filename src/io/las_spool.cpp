#include "las_spool.h"

#include <raycloud/core/error.h>

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace ray {
namespace {

/// A new file in `folder` whose name is gone already, or -1.
int open_nameless(const std::filesystem::path& folder) {
  std::string name = (folder / ".raycloud.XXXXXX").string();
  const int descriptor = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor >= 0) ::unlink(name.c_str());
  return descriptor;
}

}  // namespace

LasSpool::LasSpool(const std::filesystem::path& target) : target_(target.string()) {
  std::error_code ignored;
  // What is piped away has no folder of its own.
  const bool file =
      !std::filesystem::exists(target, ignored) || std::filesystem::is_regular_file(target, ignored);
  const auto folder = !file                      ? std::filesystem::temp_directory_path(ignored)
                      : target.has_parent_path() ? target.parent_path()
                                                 : std::filesystem::path(".");
  descriptor_ = open_nameless(folder);
  if (descriptor_ < 0) fail("write", errno);
}

LasSpool::~LasSpool() {
  ::close(descriptor_);
}

void LasSpool::fail(const char* what, int error) const {
  throw Error(ErrorCode::file_access, target_ + ": cannot " + what + " the temporary file beside it: " +
                                          std::generic_category().message(error));
}

void LasSpool::add(std::span<const std::byte> piece) {
  const std::uint64_t start = ends_.empty() ? 0 : ends_.back();
  ends_.push_back(start + piece.size());
  for (std::uint64_t at = start; !piece.empty();) {
    const auto written = ::pwrite(descriptor_, piece.data(), piece.size(), static_cast<off_t>(at));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("write", errno);
    piece = piece.subspan(static_cast<std::size_t>(written));
    at += static_cast<std::uint64_t>(written);
  }
}

void LasSpool::read(std::size_t number, std::vector<std::byte>& piece) const {
  std::uint64_t at = number == 0 ? 0 : ends_[number - 1];
  piece.resize(ends_[number] - at);
  for (std::size_t done = 0; done < piece.size();) {
    const auto got =
        ::pread(descriptor_, piece.data() + done, piece.size() - done, static_cast<off_t>(at + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail("read", got < 0 ? errno : EIO);
    done += static_cast<std::size_t>(got);
  }
}

}  // namespace ray
