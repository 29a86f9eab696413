#include "text_file.h"

#include <raycloud/core/error.h>

#include <cerrno>
#include <cstring>

namespace ray::text {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 20;
constexpr std::size_t kLongestLine = std::size_t{64} << 20;

}  // namespace

TextFile::TextFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code error;
  const auto status = std::filesystem::status(path_, error);
  if (status.type() == std::filesystem::file_type::not_found)
    throw Error(ErrorCode::file_not_found, name() + ": no such file");
  if (std::filesystem::is_directory(status)) throw Error(ErrorCode::file_access, name() + ": is a folder");
  file_.reset(std::fopen(path_.c_str(), "rb"));
  if (!file_) throw Error(ErrorCode::file_access, name() + ": cannot read: " + std::strerror(errno));
}

std::string TextFile::read(std::size_t bytes) {
  std::string text(bytes, '\0');
  text.resize(std::fread(text.data(), 1, bytes, file_.get()));
  if (std::ferror(file_.get()) != 0)
    throw Error(ErrorCode::file_access, name() + ": cannot read: " + std::strerror(errno));
  return text;
}

bool LineReader::fill() {
  if (at_end_) return false;
  buffer_.erase(0, begin_);
  begin_ = 0;
  if (buffer_.size() > kLongestLine)
    throw Error(ErrorCode::file_format, file_.name() + ": has a line of over 64 MiB; it is not text");
  const std::string more = file_.read(kBlock);
  at_end_ = more.size() < kBlock;
  buffer_ += more;
  return true;
}

std::string_view LineReader::next(std::size_t most) {
  lines_ = 0;
  std::size_t end = begin_;
  while (lines_ < most) {
    const std::size_t feed = buffer_.find('\n', end);
    if (feed != std::string::npos) {
      end = feed + 1;
      ++lines_;
      continue;
    }
    if (lines_ > 0 && !at_end_) break;
    if (!fill()) {
      lines_ += end < buffer_.size() ? 1 : 0;
      end = buffer_.size();
      break;
    }
    end = begin_;
  }
  const std::string_view block(buffer_.data() + begin_, end - begin_);
  begin_ = end;
  return block;
}

void LineReader::rewind() {
  file_.rewind();
  buffer_.clear();
  begin_ = 0;
  at_end_ = false;
}

}  // namespace ray::text
