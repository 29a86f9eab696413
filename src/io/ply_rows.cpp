#include "ply_rows.h"

#include "forward_reader.h"
#include "ply_text.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

namespace ray {
namespace {

constexpr std::size_t kMaxBlock = std::size_t{64} << 20;

[[noreturn]] void fail_truncated(const PlyRowNames& names, std::uint64_t whole_rows, std::uint64_t count,
                                 std::uint64_t file_size) {
  throw Error(ErrorCode::file_format, names.path + ": truncated at " + names.noun + " " +
                                          std::to_string(whole_rows + 1) + " of " + std::to_string(count) +
                                          " (byte " + std::to_string(file_size) + ")");
}

/// For files whose rows differ in length, once it is sure that they cannot all be there.
[[noreturn]] void fail_too_short(const PlyRowNames& names, std::uint64_t count, std::uint64_t file_size) {
  throw Error(ErrorCode::file_format, names.path + ": truncated: " + std::to_string(count) + " " +
                                          names.noun + "s do not fit in " + std::to_string(file_size) +
                                          " bytes");
}

[[noreturn]] void fail_before_vertices(const PlyRowNames& names, const PlyElement& element) {
  throw Error(ErrorCode::file_format, names.path + ": truncated within its " + std::to_string(element.count) +
                                          " rows of '" + element.name.substr(0, 40) + "'");
}

[[noreturn]] void fail_too_long(const PlyRowNames& names, const std::string& excess, std::uint64_t count) {
  throw Error(ErrorCode::file_format, names.path + ": holds " + excess + " more than its header says (" +
                                          std::to_string(count) + " " + names.noun +
                                          "s): the count is wrong or " + "the file is damaged");
}

/// The value of a whole number, which is negative for no valid list length.
std::int64_t read_whole(const std::byte* bytes, ScalarType type, bool big_endian) {
  std::uint64_t bits = 0;
  const std::size_t size = size_of(type);
  for (std::size_t i = 0; i < size; ++i) {
    bits |= std::to_integer<std::uint64_t>(bytes[big_endian ? size - 1 - i : i]) << (8 * i);
  }
  return visit_scalar(type, [&]<class T>() { return static_cast<std::int64_t>(static_cast<T>(bits)); });
}

/// Goes through rows that have lists, of which only the fixed parts are kept.
class RowWalker {
 public:
  RowWalker(const PlyElement& element, bool big_endian) : big_endian_(big_endian) {
    for (const PlyProperty& property : element.properties) {
      if (property.list_count) {
        steps_.push_back({0, property.list_count, size_of(property.type)});
      } else {
        if (steps_.empty() || steps_.back().list_count) steps_.push_back({});
        steps_.back().fixed_bytes += size_of(property.type);
      }
    }
  }

  /// Passes one row; appends its fixed parts to `out` if there is one. False if the file ends within it or a
  /// list has a negative length.
  [[nodiscard]] bool pass(ForwardReader& reader, std::byte* out) const {
    for (const Step& step : steps_) {
      const std::size_t bytes = step.list_count ? size_of(*step.list_count) : step.fixed_bytes;
      const auto data = reader.peek(bytes);
      if (data.size() < bytes) return false;
      std::uint64_t skipped = bytes;
      if (step.list_count) {
        const std::int64_t count = read_whole(data.data(), *step.list_count, big_endian_);
        if (count < 0 ||
            __builtin_mul_overflow(static_cast<std::uint64_t>(count), step.item_bytes, &skipped) ||
            __builtin_add_overflow(skipped, bytes, &skipped)) {
          return false;
        }
      } else if (out != nullptr) {
        std::memcpy(out, data.data(), bytes);
        out += bytes;
      }
      if (!reader.skip(skipped)) return false;
    }
    return true;
  }

 private:
  struct Step {
    std::size_t fixed_bytes = 0;
    std::optional<ScalarType> list_count;
    std::uint64_t item_bytes = 0;
  };
  std::vector<Step> steps_;
  bool big_endian_;
};

/// Where the vertices of a binary file begin.
std::uint64_t find_vertices(const InputFile& file, const PlyHeader& header, const PlyRowNames& names) {
  ForwardReader reader(file, header.bytes);
  for (std::size_t e = 0; e < header.vertex; ++e) {
    const PlyElement& element = header.elements[e];
    if (element.has_lists()) {
      const RowWalker walker(element, header.format == PlyFormat::big_endian);
      for (std::uint64_t row = 0; row < element.count; ++row) {
        if (!walker.pass(reader, nullptr)) fail_before_vertices(names, element);
      }
    } else {
      std::uint64_t bytes = 0;
      if (__builtin_mul_overflow(element.count, std::uint64_t{element.least_row_bytes()}, &bytes) ||
          !reader.skip(bytes)) {
        fail_before_vertices(names, element);
      }
    }
  }
  return reader.position();
}

/// Binary rows without lists: blocks of the file as they are.
class FixedRows final : public PlyRows {
 public:
  FixedRows(const InputFile& file, const PlyHeader& header, PlyRowNames names)
      : file_(file),
        names_(std::move(names)),
        count_(header.elements[header.vertex].count),
        row_bytes_(layout_of(header).row_bytes),
        begin_(find_vertices(file, header, names_)) {
    const std::uint64_t there = file.size() - begin_;
    if (there / row_bytes_ < count_) fail_truncated(names_, there / row_bytes_, count_, file.size());
    const std::uint64_t excess = there - count_ * row_bytes_;
    if (header.elements.size() == 1 && excess > 0) {
      fail_too_long(names_, std::to_string(excess) + " byte" + (excess > 1 ? "s" : ""), count_);
    }
  }

  bool fetch(RawChunk& raw, std::size_t most_rows) override {
    const std::uint64_t most = std::clamp<std::uint64_t>(kMaxBlock / row_bytes_, 1, most_rows);
    raw.first_row = next_;
    raw.rows = static_cast<std::size_t>(std::min(most, count_ - next_));
    if (raw.rows == 0) return false;
    raw.bytes.resize(raw.rows * row_bytes_);
    const std::size_t got = file_.read_at(begin_ + next_ * row_bytes_, raw.bytes);
    if (got < raw.bytes.size()) {
      // Somebody cut the file after it was opened.
      const std::uint64_t whole = next_ + got / row_bytes_;
      fail_truncated(names_, whole, count_, begin_ + next_ * row_bytes_ + got);
    }
    next_ += raw.rows;
    return true;
  }

  void jump(std::uint64_t row) override { next_ = std::min(row, count_); }

  std::span<const std::byte> unpack(const RawChunk& raw, std::vector<std::byte>&) const override {
    return raw.bytes;
  }

 private:
  const InputFile& file_;
  PlyRowNames names_;
  std::uint64_t count_;
  std::size_t row_bytes_;
  std::uint64_t begin_;
  std::uint64_t next_ = 0;
};

/// Binary rows with lists, which are left out of the block while reading.
class ListRows final : public PlyRows {
 public:
  ListRows(const InputFile& file, const PlyHeader& header, PlyRowNames names)
      : file_(file),
        names_(std::move(names)),
        count_(header.elements[header.vertex].count),
        row_bytes_(layout_of(header).row_bytes),
        begin_(find_vertices(file, header, names_)),
        reader_(file, begin_),
        walker_(header.elements[header.vertex], header.format == PlyFormat::big_endian) {
    const std::uint64_t most = (file.size() - begin_) / header.elements[header.vertex].least_row_bytes();
    if (most < count_) fail_too_short(names_, count_, file.size());
  }

  bool fetch(RawChunk& raw, std::size_t most_rows) override {
    const std::uint64_t most = std::clamp<std::uint64_t>(kMaxBlock / row_bytes_, 1, most_rows);
    raw.first_row = next_;
    raw.rows = static_cast<std::size_t>(std::min(most, count_ - next_));
    if (raw.rows == 0) return false;
    raw.bytes.resize(raw.rows * row_bytes_);
    for (std::size_t i = 0; i < raw.rows; ++i, ++next_) {
      if (!walker_.pass(reader_, raw.bytes.data() + i * row_bytes_)) {
        fail_truncated(names_, next_, count_, file_.size());
      }
    }
    return true;
  }

  void jump(std::uint64_t) override {
    next_ = 0;
    reader_.seek(begin_);
  }

  std::span<const std::byte> unpack(const RawChunk& raw, std::vector<std::byte>&) const override {
    return raw.bytes;
  }

 private:
  const InputFile& file_;
  PlyRowNames names_;
  std::uint64_t count_;
  std::size_t row_bytes_;
  std::uint64_t begin_;
  std::uint64_t next_ = 0;
  ForwardReader reader_;
  RowWalker walker_;
};

/// Rows of text: blocks of whole lines.
class TextRows final : public PlyRows {
 public:
  TextRows(const InputFile& file, const PlyHeader& header, PlyRowNames names)
      : file_(file),
        header_(header),
        names_(std::move(names)),
        count_(header.elements[header.vertex].count),
        row_bytes_(layout_of(header).row_bytes),
        reader_(file, header.bytes) {
    for (std::size_t e = 0; e < header.vertex; ++e)
      skip_rows(header.elements[e]);
    begin_ = reader_.position();
    // A value and the space or line end after it take two bytes, but the very last may lack its line end.
    const std::uint64_t least = 2 * header.elements[header.vertex].properties.size();
    const std::uint64_t most = (file.size() - std::min(begin_, file.size()) + 1) / least;
    if (most < count_) fail_too_short(names_, count_, file.size());
  }

  bool fetch(RawChunk& raw, std::size_t most_rows) override {
    raw.first_row = next_;
    raw.rows = 0;
    raw.bytes.clear();
    while (next_ < count_ && raw.rows < most_rows && raw.bytes.size() < kMaxBlock) {
      const auto line = take_line();
      if (line.empty()) fail_truncated(names_, next_, count_, file_.size());
      if (is_blank_line(line)) continue;
      const auto bytes = std::as_bytes(std::span(line));
      raw.bytes.insert(raw.bytes.end(), bytes.begin(), bytes.end());
      ++raw.rows;
      ++next_;
    }
    if (next_ == count_) check_end();
    return raw.rows > 0;
  }

  void jump(std::uint64_t) override {
    next_ = 0;
    reader_.seek(begin_);
  }

  std::span<const std::byte> unpack(const RawChunk& raw, std::vector<std::byte>& scratch) const override {
    scratch.resize(raw.rows * row_bytes_);
    const std::string_view text(reinterpret_cast<const char*>(raw.bytes.data()), raw.bytes.size());
    parse_ply_lines(text, header_, names_, raw.first_row, scratch);
    return scratch;
  }

 private:
  /// The next line with its end; empty at the end of the file. Valid until the next call.
  std::string_view take_line() {
    for (std::size_t wanted = 4096;; wanted *= 4) {
      const auto bytes = reader_.peek(wanted);
      const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      const auto end = text.find(header_.line_end);
      const bool at_end_of_file = bytes.size() < wanted;
      if (end == text.npos && !at_end_of_file) {
        if (wanted > kMaxBlock) {
          throw Error(ErrorCode::file_format, names_.path + ": a line of over 64 MiB");
        }
        continue;
      }
      const auto line = text.substr(0, end == text.npos ? text.size() : end + 1);
      [[maybe_unused]] const bool within = reader_.skip(line.size());
      return line;
    }
  }

  void skip_rows(const PlyElement& element) {
    if (element.properties.empty()) return;
    for (std::uint64_t row = 0; row < element.count;) {
      const auto line = take_line();
      if (line.empty()) fail_before_vertices(names_, element);
      if (!is_blank_line(line)) ++row;
    }
  }

  void check_end() {
    if (header_.vertex + 1 < header_.elements.size()) return;
    for (auto line = take_line(); !line.empty(); line = take_line()) {
      if (!is_blank_line(line)) fail_too_long(names_, "lines", count_);
    }
  }

  const InputFile& file_;
  const PlyHeader& header_;
  PlyRowNames names_;
  std::uint64_t count_;
  std::size_t row_bytes_;
  std::uint64_t begin_ = 0;
  std::uint64_t next_ = 0;
  ForwardReader reader_;
};

}  // namespace

std::unique_ptr<PlyRows> open_ply_rows(const InputFile& file, const PlyHeader& header, PlyRowNames names) {
  if (header.format == PlyFormat::ascii) return std::make_unique<TextRows>(file, header, std::move(names));
  if (header.elements[header.vertex].has_lists()) {
    return std::make_unique<ListRows>(file, header, std::move(names));
  }
  return std::make_unique<FixedRows>(file, header, std::move(names));
}

}  // namespace ray
