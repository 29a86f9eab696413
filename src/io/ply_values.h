#pragma once
/// The data of a PLY file value after value, in any encoding: for files that are read whole.

#include "forward_reader.h"
#include "ply_header.h"

#include <cstdint>
#include <optional>
#include <string>

namespace ray {

class PlyValues {
 public:
  /// Both must outlive it.
  PlyValues(const InputFile& file, const PlyHeader& header);

  /// Goes to the next row, which errors will call "FACE 3 of 7".
  void begin_row(const PlyElement& element, std::uint64_t row);
  /// The next value of the row as a double (64-bit integers above 2^53 are rounded).
  [[nodiscard]] double number(ScalarType type);
  /// The next value of the row, in this machine's byte order.
  void bytes(ScalarType type, std::byte* out);
  /// The length of a list.
  [[nodiscard]] std::uint64_t count(ScalarType type);
  void skip(const PlyProperty& property);
  /// Passes all rows of an element.
  void skip(const PlyElement& element);
  /// Throws Error(file_format) if there is more than the header says.
  void check_end();

  [[noreturn]] void fail(const std::string& what) const;

 private:
  [[nodiscard]] bool is_text() const { return header_.format == PlyFormat::ascii; }
  [[noreturn]] void fail_cut() const;
  /// The next line with something on it; nothing at the end.
  [[nodiscard]] std::optional<std::string_view> next_line();

  const InputFile& file_;
  const PlyHeader& header_;
  ForwardReader reader_;
  std::string text_;          // the row, if the file is text
  std::string_view pending_;  // its rest
  const PlyElement* element_ = nullptr;
  std::uint64_t row_ = 0;
};

}  // namespace ray
