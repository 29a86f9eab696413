#include "ply_header.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <charconv>
#include <unordered_set>
#include <utility>

namespace ray {
namespace {

constexpr std::size_t kMaxHeader = std::size_t{16} << 20;

std::optional<ScalarType> scalar_type_named(std::string_view name) {
  static constexpr std::pair<std::string_view, ScalarType> kNames[] = {
      {"char", ScalarType::int8},      {"int8", ScalarType::int8},       {"uchar", ScalarType::uint8},
      {"uint8", ScalarType::uint8},    {"short", ScalarType::int16},     {"int16", ScalarType::int16},
      {"ushort", ScalarType::uint16},  {"uint16", ScalarType::uint16},   {"int", ScalarType::int32},
      {"int32", ScalarType::int32},    {"uint", ScalarType::uint32},     {"uint32", ScalarType::uint32},
      {"long", ScalarType::int64},     {"int64", ScalarType::int64},     {"ulong", ScalarType::uint64},
      {"uint64", ScalarType::uint64},  {"float", ScalarType::float32},   {"float32", ScalarType::float32},
      {"double", ScalarType::float64}, {"float64", ScalarType::float64},
  };
  const auto* found = std::find_if(std::begin(kNames), std::end(kNames),
                                   [&](const auto& entry) { return entry.first == name; });
  if (found == std::end(kNames)) return std::nullopt;
  return found->second;
}

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front()))
    text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back()))
    text.remove_suffix(1);
  return text;
}

/// Cuts the first word off `text`.
std::string_view take_word(std::string_view& text) {
  text = trimmed(text);
  const auto end = std::find_if(text.begin(), text.end(), is_blank);
  const auto word = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(word.size());
  return word;
}

/// A piece of a foreign file that is fit for a message.
std::string in_quotes(std::string_view text) {
  std::string shown(text.substr(0, 40));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return "'" + shown + (text.size() > 40 ? "…'" : "'");
}

class Parser {
 public:
  Parser(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  std::optional<PlyHeader> run() {
    if (!read_magic()) return std::nullopt;
    while (auto line = next_line()) {
      const auto word = take_word(*line);
      if (word == "end_header") return finished();
      read_line(word, trimmed(*line));
    }
    return std::nullopt;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::file_format, path_ + ": PLY header, line " + std::to_string(line_) + ": " + what);
  }

  bool read_magic() {
    constexpr std::string_view kMagic = "ply";
    const auto start = text_.substr(0, kMagic.size());
    const auto end = text_.find_first_of("\r\n");
    // The first line shows how lines end; the byte after a lone '\r' tells it from "\r\n".
    const bool told = end != std::string_view::npos && (text_[end] == '\n' || end + 1 < text_.size());
    if (start != kMagic.substr(0, start.size()) || (told && trimmed(text_.substr(0, end)) != kMagic) ||
        (!told && text_.size() > 64)) {
      throw Error(ErrorCode::file_format, path_ + ": not a PLY file");
    }
    if (!told) return false;
    if (text_[end] == '\r' && text_[end + 1] != '\n') header_.line_end = '\r';
    return next_line().has_value();
  }

  std::optional<std::string_view> next_line() {
    const auto end = text_.find(header_.line_end, position_);
    if (end == std::string_view::npos) return std::nullopt;
    const auto line = text_.substr(position_, end - position_);
    position_ = end + 1;
    ++line_;
    return line;
  }

  void read_line(std::string_view word, std::string_view rest) {
    if (word == "comment" || word == "obj_info") {
      header_.comments.emplace_back(rest);
    } else if (word == "format") {
      read_format(rest);
    } else if (word == "element") {
      read_element(rest);
    } else if (word == "property") {
      read_property(rest);
    } else if (!word.empty()) {
      fail("unknown word " + in_quotes(word));
    }
  }

  void read_format(std::string_view rest) {
    const auto name = take_word(rest);
    if (has_format_) fail("a second format");
    if (trimmed(rest) != "1.0") fail("format version " + in_quotes(trimmed(rest)) + " instead of 1.0");
    if (name == "ascii")
      header_.format = PlyFormat::ascii;
    else if (name == "binary_little_endian")
      header_.format = PlyFormat::little_endian;
    else if (name == "binary_big_endian")
      header_.format = PlyFormat::big_endian;
    else
      fail("unknown format " + in_quotes(name));
    has_format_ = true;
  }

  void read_element(std::string_view rest) {
    PlyElement element;
    element.name = take_word(rest);
    const auto count = take_word(rest);
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (error != std::errc() || end != count.data() + count.size() || !trimmed(rest).empty()) {
      fail("an element needs a name and a count, not " + in_quotes(count));
    }
    names_ = {};  // clear() would walk all the buckets of a large earlier element
    header_.elements.push_back(std::move(element));
  }

  void read_property(std::string_view rest) {
    if (header_.elements.empty()) fail("a property before any element");
    PlyProperty property;
    auto type = take_word(rest);
    if (type == "list") {
      property.list_count = type_or_fail(take_word(rest));
      if (*property.list_count >= ScalarType::float32) fail("the length of a list must be a whole number");
      type = take_word(rest);
    }
    property.type = type_or_fail(type);
    property.name = take_word(rest);
    if (property.name.empty() || !trimmed(rest).empty()) fail("a property needs a type and one name");
    PlyElement& element = header_.elements.back();
    if (!names_.insert(property.name).second && element.name == "vertex") {
      fail("a second property " + in_quotes(property.name));
    }
    element.properties.push_back(std::move(property));
  }

  ScalarType type_or_fail(std::string_view name) const {
    const auto type = scalar_type_named(name);
    if (!type) fail("unknown type " + in_quotes(name));
    return *type;
  }

  PlyHeader finished() {
    if (!has_format_) fail("no format");
    const auto is_vertex = [](const PlyElement& element) { return element.name == "vertex"; };
    const auto& elements = header_.elements;
    const auto vertex = std::find_if(elements.begin(), elements.end(), is_vertex);
    if (vertex == elements.end()) fail("no element 'vertex'");
    if (std::find_if(vertex + 1, elements.end(), is_vertex) != elements.end()) fail("two elements 'vertex'");
    if (vertex->properties.empty()) fail("element 'vertex' has no properties");
    header_.vertex = static_cast<std::size_t>(vertex - elements.begin());
    header_.bytes = position_;
    return std::move(header_);
  }

  std::string_view text_;
  const std::string& path_;
  PlyHeader header_;
  std::unordered_set<std::string> names_;  // of the current element
  std::size_t position_ = 0;
  std::size_t line_ = 0;
  bool has_format_ = false;
};

}  // namespace

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& property) { return property.list_count.has_value(); });
}

std::size_t PlyElement::least_row_bytes() const {
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties)
    bytes += size_of(property.list_count.value_or(property.type));
  return bytes;
}

std::optional<PlyHeader> parse_ply_header(std::string_view text, const std::string& path) {
  return Parser(text, path).run();
}

PlyHeader read_ply_header(const InputFile& file) {
  const std::string path = file.path().string();
  if (file.size() == 0) throw Error(ErrorCode::file_format, path + ": empty file");
  std::string text;
  for (std::size_t wanted = 16384;; wanted *= 8) {
    text.resize(std::min({wanted, kMaxHeader, static_cast<std::size_t>(file.size())}));
    text.resize(file.read_at(0, std::as_writable_bytes(std::span(text.data(), text.size()))));
    if (auto header = parse_ply_header(text, path)) return *std::move(header);
    if (text.size() == kMaxHeader) throw Error(ErrorCode::file_format, path + ": PLY header of over 16 MiB");
    if (text.size() == wanted) continue;
    // The file ends here: of a file without rows the last line may lack its end.
    if (auto header = parse_ply_header(text + '\n', path)) {
      header->bytes = text.size();
      return *std::move(header);
    }
    throw Error(ErrorCode::file_format, path + ": cut short: its PLY header has no end_header");
  }
}

}  // namespace ray
