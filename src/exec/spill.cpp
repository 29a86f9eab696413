#include <raycloud/core/error.h>
#include <raycloud/exec/spill.h>

#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

namespace ray {
namespace {

std::string spill_folder() {
  const char* given = std::getenv("TMPDIR");
  return given != nullptr && *given != '\0' ? given : "/var/tmp";
}

[[noreturn]] void throw_spill_error(const char* what) {
  throw Error(ErrorCode::file_access,
              spill_folder() + ": cannot " + what + " a temporary file: " + std::strerror(errno) +
                  "; allow more --memory, or let TMPDIR name a folder with more room");
}

}  // namespace

Spill::Spill(std::size_t streams, std::size_t page_bytes) : page_bytes_(page_bytes), streams_(streams) {
  std::string name = spill_folder() + "/raycloud-XXXXXX";
  file_ = mkstemp(name.data());
  if (file_ < 0) throw_spill_error("make");
  unlink(name.c_str());
}

Spill::~Spill() {
  close(file_);
}

void Spill::append(std::size_t stream, const void* data, std::size_t bytes) {
  Stream& to = streams_[stream];
  const auto* from = static_cast<const std::byte*>(data);
  to.size += bytes;
  if (to.page.capacity() == 0) to.page.reserve(page_bytes_);
  while (bytes > 0) {
    const std::size_t part = std::min(bytes, page_bytes_ - to.page.size());
    to.page.insert(to.page.end(), from, from + part);
    from += part;
    bytes -= part;
    if (to.page.size() == page_bytes_) write_page(to);
  }
}

void Spill::write_page(Stream& stream) {
  const std::byte* from = stream.page.data();
  std::size_t left = stream.page.size();
  stream.pages.push_back(end_);
  while (left > 0) {
    const ssize_t written = pwrite(file_, from, left, static_cast<off_t>(end_));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw_spill_error("write");
    from += written;
    left -= static_cast<std::size_t>(written);
    end_ += static_cast<std::uint64_t>(written);
  }
  stream.page.clear();
}

void Spill::read(std::size_t stream, void* data, std::size_t bytes) {
  Stream& from = streams_[stream];
  assert(from.read + bytes <= from.size);
  auto* to = static_cast<std::byte*>(data);
  while (bytes > 0) {
    const std::uint64_t number = from.read / page_bytes_;
    const std::size_t at = from.read % page_bytes_;
    const std::size_t part = std::min(bytes, page_bytes_ - at);
    if (part == page_bytes_ && number < from.pages.size() && from.loaded != number) {
      read_file(from.pages[number], to, part);  // a whole page needs no copy
    } else {
      if (from.loaded != number) load_page(from, number);
      std::memcpy(to, from.page.data() + at, part);
    }
    to += part;
    bytes -= part;
    from.read += part;
  }
}

/// The last page was never written where it is not full: it is in memory until another takes its place.
void Spill::load_page(Stream& stream, std::uint64_t number) {
  if (stream.loaded == ~std::uint64_t{0} && !stream.page.empty()) {
    if (number == stream.pages.size()) {
      stream.loaded = number;
      return;
    }
    write_page(stream);
  }
  stream.page.resize(page_bytes_);
  const std::size_t wanted = std::min<std::uint64_t>(page_bytes_, stream.size - number * page_bytes_);
  read_file(stream.pages[number], stream.page.data(), wanted);
  stream.loaded = number;
}

void Spill::read_file(std::uint64_t from, std::byte* to, std::size_t bytes) const {
  for (std::size_t got = 0; got < bytes;) {
    const ssize_t part = pread(file_, to + got, bytes - got, static_cast<off_t>(from + got));
    if (part < 0 && errno == EINTR) continue;
    if (part <= 0) throw_spill_error("read");
    got += static_cast<std::size_t>(part);
  }
}

void Spill::rewind(std::size_t stream) {
  Stream& again = streams_[stream];
  again.read = 0;
  if (again.loaded != again.pages.size()) return;
  write_page(again);  // the last, which was only in memory
  again.loaded = ~std::uint64_t{0};
}

void Spill::drop(std::size_t stream) {
  streams_[stream].page = std::vector<std::byte>();
}

}  // namespace ray
