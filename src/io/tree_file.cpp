#include "text_fields.h"
#include "text_file.h"

#include <raycloud/core/error.h>
#include <raycloud/io/atomic_file.h>
#include <raycloud/io/tree_file.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>
#include <string_view>

namespace ray {
namespace {

constexpr std::string_view kParent = "parent_id";
constexpr std::array<std::string_view, 4> kPlace{"x", "y", "z", "radius"};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : file_(path) {}

  Forest run() {
    text::LineReader reader(file_);
    for (auto lines = reader.next(kLines); !lines.empty(); lines = reader.next(kLines)) {
      while (!lines.empty()) {
        ++line_;
        read_line(text::trimmed(text::take_line(lines)));
      }
    }
    if (segment_fields_ == 0) {
      throw Error(ErrorCode::file_format,
                  file_.name() + (line_ == 0 ? ": empty file" : ": has no heading such as x,y,z,radius"));
    }
    return std::move(forest_);
  }

 private:
  static constexpr std::size_t kLines = 256;
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::file_format, file_.name() + ": line " + std::to_string(line_) + " " + what);
  }

  void read_line(std::string_view line) {
    if (line.empty()) return;
    if (line.front() == '#')
      forest_.comments.emplace_back(text::trimmed(line.substr(1)));
    else if (segment_fields_ == 0)
      read_heading(line);
    else
      read_tree(line);
  }

  void read_heading(std::string_view line) {
    auto names = text::all_fields(line, ',');
    if (!names.empty() && names.back().empty()) names.pop_back();
    const auto place = std::search(names.begin(), names.end(), kPlace.begin(), kPlace.end());
    if (place == names.end()) fail("is not a heading such as x,y,z,radius,parent_id");
    if (std::any_of(names.begin(), names.end(), [](auto name) { return name.empty(); }))
      fail("has a field without a name");
    forest_.tree_attributes.assign(names.begin(), place);
    segment_fields_ = static_cast<std::size_t>(names.end() - place);
    for (std::size_t field = kPlace.size(); field < segment_fields_; ++field) {
      const std::string_view name = place[static_cast<std::ptrdiff_t>(field)];
      if (name == kParent && parent_field_ == kNone)
        parent_field_ = field;
      else
        forest_.segment_attributes.emplace_back(name);
    }
  }

  void read_tree(std::string_view line) {
    text::Fields fields(line, ',');
    Tree tree;
    values_.clear();
    while (const auto field = fields.next()) {
      const auto value = text::number(*field);
      // A comma at the end of the line leaves an empty field behind it.
      if (!value && field->empty() && !fields.next()) break;
      if (!value) fail("has " + text::quoted(*field) + " where a number should be");
      values_.push_back(*value);
    }
    const std::size_t own = forest_.tree_attributes.size();
    if (values_.size() < own + segment_fields_ || (values_.size() - own) % segment_fields_ != 0) {
      fail("has " + std::to_string(values_.size()) + " fields, but a tree needs " +
           (own > 0 ? std::to_string(own) + " and then " : "") + std::to_string(segment_fields_) +
           " a segment: is it cut?");
    }
    tree.attributes.assign(values_.begin(), values_.begin() + static_cast<std::ptrdiff_t>(own));
    tree.segments.reserve((values_.size() - own) / segment_fields_);
    for (std::size_t at = own; at < values_.size(); at += segment_fields_)
      tree.segments.push_back(segment(values_.data() + at, tree.segments.size()));
    forest_.trees.push_back(std::move(tree));
  }

  [[nodiscard]] TreeSegment segment(const double* values, std::size_t index) const {
    TreeSegment segment;
    segment.position = {values[0], values[1], values[2]};
    segment.radius = values[3];
    const std::string which = "segment " + std::to_string(index + 1);
    if (!segment.position.allFinite()) fail("has a position that is not finite (" + which + ")");
    if (!(segment.radius >= 0.0 && std::isfinite(segment.radius)))
      fail("has a radius that is negative or not finite (" + which + ")");
    for (std::size_t field = kPlace.size(); field < segment_fields_; ++field) {
      if (field != parent_field_) segment.attributes.push_back(values[field]);
    }
    if (parent_field_ != kNone) {
      segment.parent = parent(values[parent_field_], index, which);
    } else if (index > 0) {
      fail("has several segments, but the heading has no parent_id");
    }
    return segment;
  }

  [[nodiscard]] std::size_t parent(double value, std::size_t index, const std::string& which) const {
    if (index == 0 && value == -1.0) return TreeSegment::kNoParent;
    if (!(value >= 0.0 && value < static_cast<double>(index) && std::floor(value) == value)) {
      std::string shown;
      text::append_number(shown, value);
      fail("has the parent_id " + shown + ", but the first segment has -1 and others one before their own (" +
           which + ")");
    }
    return static_cast<std::size_t>(value);
  }

  text::TextFile file_;
  Forest forest_;
  std::size_t segment_fields_ = 0;
  std::size_t parent_field_ = kNone;
  std::vector<double> values_;
  std::size_t line_ = 0;
};

std::string field_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return (c >= '\0' && c <= ' ') || c == ','; }, '_');
  return name;
}

std::string heading_of(const Forest& forest, bool with_parents) {
  std::string text;
  for (std::string comment : forest.comments) {
    std::replace_if(
        comment.begin(), comment.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    text += "# " + comment + "\n";
  }
  for (const std::string& name : forest.tree_attributes)
    text += field_name(name) + ",";
  if (!forest.tree_attributes.empty()) text += ' ';
  text += "x,y,z,radius";
  if (with_parents) text += "," + std::string(kParent);
  for (const std::string& name : forest.segment_attributes)
    text += "," + field_name(name);
  return text + "\n";
}

void append_segment(std::string& text, const TreeSegment& segment, bool with_parents) {
  for (const double coordinate : segment.position) {
    text::append_number(text, coordinate);
    text += ',';
  }
  text::append_number(text, segment.radius);
  if (with_parents)
    text += "," + (segment.parent == TreeSegment::kNoParent ? "-1" : std::to_string(segment.parent));
  for (const double value : segment.attributes)
    text::append_number(text += ',', value);
}

}  // namespace

Forest read_trees(const std::filesystem::path& path) {
  return Reader(path).run();
}

void write_trees(const std::filesystem::path& path, const Forest& forest, const WriteOptions& options) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  const bool with_parents = std::any_of(forest.trees.begin(), forest.trees.end(),
                                        [](const Tree& tree) { return tree.segments.size() > 1; });
  AtomicFile file(path, options);
  std::string text = heading_of(forest, with_parents);
  for (const Tree& tree : forest.trees) {
    assert(!tree.segments.empty() && tree.attributes.size() == forest.tree_attributes.size());
    for (const double value : tree.attributes)
      text::append_number(text, value), text += ',';
    if (!tree.attributes.empty()) text += ' ';
    for (const TreeSegment& segment : tree.segments) {
      assert(segment.attributes.size() == forest.segment_attributes.size());
      if (&segment != &tree.segments.front()) text += ", ";
      append_segment(text, segment, with_parents);
    }
    text += '\n';
    if (text.size() < kPiece) continue;
    file.write(text);
    text.clear();
  }
  file.write(text);
  file.commit();
}

}  // namespace ray
