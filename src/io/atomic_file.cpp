#include <raycloud/core/error.h>
#include <raycloud/io/atomic_file.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <random>
#include <string>
#include <system_error>
#include <utility>

namespace ray {
namespace {

constexpr std::size_t kMaxWrite = std::size_t{1} << 30;

std::string random_suffix() {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device device;
  std::uniform_int_distribution<std::size_t> letter(0, kLetters.size() - 1);
  std::string suffix(6, ' ');
  std::generate(suffix.begin(), suffix.end(), [&] { return kLetters[letter(device)]; });
  return suffix;
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

/// Where symbolic links lead, even if the last one leads to a file that does not exist yet.
std::filesystem::path follow_links(std::filesystem::path file) {
  for (int depth = 0; depth < 40; ++depth) {
    std::error_code error;
    const auto next = std::filesystem::read_symlink(file, error);
    if (error) break;
    file = next.is_absolute() ? next : folder_of(file) / next;
  }
  return file;
}

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path target, const WriteOptions& options)
    : target_(std::move(target)), options_(options) {
  if (!target_.has_filename()) fail(target_.empty() ? ENOENT : EISDIR);
  struct stat status {};
  const bool exists = ::stat(target_.c_str(), &status) == 0;
  if (!exists && errno != ENOENT) fail(errno);
  if (exists && S_ISDIR(status.st_mode)) fail(EISDIR);
  if (exists && !S_ISREG(status.st_mode)) {
    descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail(errno);
    seekable_ = ::lseek(descriptor_, 0, SEEK_CUR) >= 0;
    return;
  }
  // Renaming onto a write-protected file would succeed: its protection is a wish to be respected.
  if (exists && ::access(target_.c_str(), W_OK) != 0) fail(errno);
  open_temporary(follow_links(target_));
  if (exists) {
    // Only root may give a file away; everybody else keeps his own new file.
    [[maybe_unused]] const int owner_kept = ::fchown(descriptor_, status.st_uid, status.st_gid);
    [[maybe_unused]] const int mode_kept = ::fchmod(descriptor_, status.st_mode & 07777);
  }
  rest();
}

void AtomicFile::open_temporary(const std::filesystem::path& real) {
  // Room for the dots and suffix in the 255 bytes of a name.
  const std::string stem = "." + real.filename().string().substr(0, 230) + ".";
  for (int attempt = 0; descriptor_ < 0; ++attempt) {
    temporary_ = folder_of(real) / (stem + random_suffix() + ".partial");
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && (errno != EEXIST || attempt == 100)) {
      const int error = errno;
      temporary_.clear();
      fail(error);
    }
  }
  real_ = real;
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::fail(int error) const {
  const std::string start = target_.string() + ": cannot write: ";
  if (error == ENOENT && !target_.empty()) {
    throw Error(ErrorCode::file_access, start + "there is no folder " + folder_of(target_).string());
  }
  if (error == EISDIR) throw Error(ErrorCode::file_access, start + "it is a folder");
  throw Error(ErrorCode::file_access, start + std::generic_category().message(error));
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  if (seekable_) {
    write_at(size_, bytes);
    return;
  }
  while (!bytes.empty()) {
    const auto written = ::write(descriptor_, bytes.data(), std::min(bytes.size(), kMaxWrite));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    size_ += static_cast<std::uint64_t>(written);
  }
}

void AtomicFile::reopen() {
  if (descriptor_ >= 0) return;
  descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor_ < 0) fail(errno);
}

void AtomicFile::close() {
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) fail(errno);
}

void AtomicFile::rest() {
  if (options_.close_between_writes && !real_.empty()) close();
}

void AtomicFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  reopen();
  while (!bytes.empty()) {
    const auto written =
        ::pwrite(descriptor_, bytes.data(), std::min(bytes.size(), kMaxWrite), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
    size_ = std::max(size_, offset);
  }
  if (options_.flush_to_disk) start_flush();
  rest();
}

/// The disk works while the rest is computed; what commit() waits for is then short.
void AtomicFile::start_flush() {
#ifdef __linux__
  constexpr std::uint64_t kPiece = 64 << 20;  // smaller ones cost more than they save
  if (size_ < flushing_ + kPiece) return;
  ::sync_file_range(descriptor_, static_cast<off_t>(flushing_), static_cast<off_t>(size_ - flushing_),
                    SYNC_FILE_RANGE_WRITE);
  flushing_ = size_;
#endif
}

void AtomicFile::write(std::string_view text) {
  write(bytes_of(text));
}

void AtomicFile::write_at(std::uint64_t offset, std::string_view text) {
  write_at(offset, bytes_of(text));
}

void AtomicFile::commit() {
  const bool in_place = real_.empty();
  reopen();
  if (options_.flush_to_disk && !in_place && ::fsync(descriptor_) != 0) fail(errno);
  close();
  if (in_place) return;
  if (::rename(temporary_.c_str(), real_.c_str()) != 0) fail(errno);
  temporary_.clear();
  if (!options_.flush_to_disk) return;
  // The new name is safe only once the folder is. Some file systems cannot flush a folder; nothing is lost
  // then.
  const int folder = ::open(folder_of(real_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);
  ::close(folder);
}

}  // namespace ray
