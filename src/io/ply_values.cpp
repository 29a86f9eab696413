#include "ply_values.h"

#include "ply_text.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace ray {
namespace {

constexpr std::size_t kMaxLine = std::size_t{64} << 20;

}  // namespace

PlyValues::PlyValues(const InputFile& file, const PlyHeader& header)
    : file_(file), header_(header), reader_(file, header.bytes) {}

void PlyValues::begin_row(const PlyElement& element, std::uint64_t row) {
  if (is_text() && element_ != nullptr && !take_ply_token(pending_).empty())
    fail("more values than the header has properties");
  element_ = &element;
  row_ = row;
  if (!is_text()) return;
  const auto line = next_line();
  if (!line) fail_cut();
  text_ = *line;
  pending_ = text_;
}

std::optional<std::string_view> PlyValues::next_line() {
  for (std::size_t wanted = 4096; wanted <= 4 * kMaxLine;) {
    const auto bytes = reader_.peek(wanted);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const auto end = text.find(header_.line_end);
    if (end == text.npos && bytes.size() >= wanted) {
      wanted *= 4;
      continue;
    }
    const auto line = text.substr(0, end == text.npos ? text.size() : end + 1);
    if (line.empty()) return std::nullopt;
    const bool blank = is_blank_line(line);
    // A short skip leaves the buffer, and so the line, where it is.
    [[maybe_unused]] const bool within = reader_.skip(line.size());
    if (!blank) return line;
  }
  throw Error(ErrorCode::file_format, file_.path().string() + ": a line of over 64 MiB");
}

void PlyValues::bytes(ScalarType type, std::byte* out) {
  if (is_text()) {
    const auto token = take_ply_token(pending_);
    if (parse_ply_value(token, type, out)) return;
    fail(token.empty() ? "too few values"
                       : "'" + std::string(token.substr(0, 40)) + "' is not a " + std::string(name_of(type)));
  }
  const std::size_t size = size_of(type);
  const auto there = reader_.peek(size);
  if (there.size() < size) fail_cut();
  std::memcpy(out, there.data(), size);
  const bool big = header_.format == PlyFormat::big_endian;
  if (big == (std::endian::native == std::endian::little)) std::reverse(out, out + size);
  [[maybe_unused]] const bool within = reader_.skip(size);
}

double PlyValues::number(ScalarType type) {
  std::array<std::byte, 8> raw;
  bytes(type, raw.data());
  return visit_scalar(type, [&]<class T>() {
    T value;
    std::memcpy(&value, raw.data(), sizeof value);
    return static_cast<double>(value);
  });
}

std::uint64_t PlyValues::count(ScalarType type) {
  const double count = number(type);
  // Each item takes at least a byte.
  if (count < 0.0 || count > static_cast<double>(file_.size())) fail("a list that cannot be that long");
  return static_cast<std::uint64_t>(count);
}

void PlyValues::skip(const PlyProperty& property) {
  const std::uint64_t items = property.list_count ? count(*property.list_count) : 1;
  if (!is_text()) {
    if (!reader_.skip(items * size_of(property.type))) fail_cut();
    return;
  }
  for (std::uint64_t i = 0; i < items; ++i) {
    if (take_ply_token(pending_).empty()) fail("too few values");
  }
}

void PlyValues::skip(const PlyElement& element) {
  if (element.properties.empty()) return;
  for (std::uint64_t row = 0; row < element.count; ++row) {
    begin_row(element, row);
    for (const PlyProperty& property : element.properties)
      skip(property);
  }
}

void PlyValues::check_end() {
  const bool more = is_text() ? !take_ply_token(pending_).empty() || next_line().has_value()
                              : reader_.position() < file_.size();
  if (more) {
    throw Error(ErrorCode::file_format, file_.path().string() +
                                            ": holds more than its header says: a count is wrong or the file "
                                            "is damaged");
  }
}

void PlyValues::fail(const std::string& what) const {
  throw Error(ErrorCode::file_format, file_.path().string() + ": " + element_->name.substr(0, 40) + " " +
                                          std::to_string(row_ + 1) + " of " +
                                          std::to_string(element_->count) + ": " + what);
}

void PlyValues::fail_cut() const {
  throw Error(ErrorCode::file_format, file_.path().string() + ": truncated at " +
                                          element_->name.substr(0, 40) + " " + std::to_string(row_ + 1) +
                                          " of " + std::to_string(element_->count) + " (byte " +
                                          std::to_string(file_.size()) + ")");
}

}  // namespace ray
