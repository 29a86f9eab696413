#pragma once
/// Lines, fields and numbers of the text formats.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ray::text {

/// Without blanks and a carriage return at either end.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Empty (after trimming) or starting with `#`, `%` or `//`.
[[nodiscard]] bool is_blank(std::string_view line);
[[nodiscard]] bool is_comment(std::string_view line);

/// The content of a comment line, without its marks.
[[nodiscard]] std::string_view comment_text(std::string_view line);

/// Takes the next line off `text`, without its line feed.
[[nodiscard]] std::string_view take_line(std::string_view& text);

/// What stands between fields: ',' or ';' where the line has one, else ' ' for any run of blanks.
[[nodiscard]] char separator_of(std::string_view line);

/// Takes the next field off `line`, trimmed and without quotes; empty optional at the end. Between commas a
/// field may be empty.
class Fields {
 public:
  Fields(std::string_view line, char separator);
  [[nodiscard]] std::optional<std::string_view> next();

 private:
  std::string_view rest_;
  char separator_;
  bool at_end_;
};

[[nodiscard]] std::vector<std::string_view> all_fields(std::string_view line, char separator);

/// The whole field as a number ("+1", "1e-3", "nan" and "inf" are numbers); the nearest double.
[[nodiscard]] std::optional<double> number(std::string_view field);

/// Names compare without capitals, blanks, underscores and a unit in brackets: "GPS_Time [s]" → "gpstime".
[[nodiscard]] std::string plain_name(std::string_view name);

/// For an error message: printable, short, in quotes.
[[nodiscard]] std::string quoted(std::string_view field);

/// Appends the shortest decimal that reads back to the same bits.
void append_number(std::string& text, double value);
void append_number(std::string& text, float value);

}  // namespace ray::text
