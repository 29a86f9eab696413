#include "text_columns.h"
#include "text_fields.h"
#include "text_file.h"

#include <raycloud/core/error.h>
#include <raycloud/io/text_points.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace ray {
namespace {

using text::Role;

constexpr std::size_t kSample = std::size_t{256} << 10;

std::string_view text_of(const RawChunk& raw) {
  return {reinterpret_cast<const char*>(raw.bytes.data()), raw.bytes.size()};
}

void set_bytes(RawChunk& raw, std::string_view text) {
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  raw.bytes.assign(bytes, bytes + text.size());
}

// Stores `value` in an integer or floating column; false if an integer column cannot hold it.
bool store(Column& column, std::size_t row, double value) {
  return visit_scalar(column.type(), [&]<class T>() {
    if constexpr (std::is_integral_v<T>) {
      if (!(value >= static_cast<double>(std::numeric_limits<T>::lowest()) &&
            value <= static_cast<double>(std::numeric_limits<T>::max()) && value == std::floor(value)))
        return false;
    }
    const T stored = static_cast<T>(value);
    std::memcpy(column.data() + row * sizeof(T), &stored, sizeof(T));
    return true;
  });
}

class TextSource final : public RaySource {
 public:
  TextSource(const std::filesystem::path& path, const ReadOptions& options)
      : file_(path), lines_(file_), chunk_rows_(options.chunk_rays) {
    std::string sample = file_.read(kSample);
    if (sample.empty()) throw Error(ErrorCode::file_format, name() + ": is empty");
    if (sample.size() == kSample) sample.resize(sample.rfind('\n') + 1);
    layout_ = text::find_layout(sample, name());
    TextSource::rewind();
  }

  const CloudInfo& info() const override { return layout_.info; }

  bool fetch(RawChunk& raw) override {
    const std::string_view block = lines_.next(chunk_rows_);
    if (block.empty()) {
      check_count();
      return false;
    }
    set_bytes(raw, block);
    raw.first_row = next_line_;
    raw.rows = lines_.lines();
    next_line_ += raw.rows;
    if (info().ray_count) count_points(block);
    return true;
  }

  std::size_t decode(const RawChunk& raw, RayCloud& rays) const override {
    rays.set_schema(info().extras);
    rays.resize(raw.rows);
    std::size_t row = 0;
    std::size_t dropped = 0;
    std::uint64_t line_number = raw.first_row;
    for (std::string_view rest = text_of(raw); !rest.empty();) {
      const std::string_view line = text::take_line(rest);
      ++line_number;
      if (text::is_blank(line) || text::is_comment(line)) continue;
      const bool kept = decode_line(line, line_number, rays, row);
      row += kept ? 1 : 0;
      dropped += kept ? 0 : 1;
    }
    rays.resize(row);
    return dropped;
  }

  void rewind() override {
    lines_.rewind();
    next_line_ = 0;
    points_ = 0;
    for (; next_line_ < layout_.lines_before; ++next_line_)
      static_cast<void>(lines_.next(1));
  }

 private:
  std::string name() const { return file_.name(); }

  [[noreturn]] void fail(std::uint64_t line, const std::string& what) const {
    throw Error(ErrorCode::file_format, name() + ": line " + std::to_string(line) + " " + what);
  }

  void count_points(std::string_view block) {
    while (!block.empty()) {
      const std::string_view line = text::take_line(block);
      points_ += text::is_blank(line) || text::is_comment(line) ? 0 : 1;
    }
  }

  void check_count() const {
    if (info().ray_count && *info().ray_count != points_)
      throw Error(ErrorCode::file_format, name() + ": says it holds " + std::to_string(*info().ray_count) +
                                              " points, but there are " + std::to_string(points_));
  }

  // Fills row `row`; false if the point is to be left out.
  bool decode_line(std::string_view line, std::uint64_t line_number, RayCloud& rays, std::size_t row) const {
    text::Fields fields(line, layout_.separator);
    Eigen::Vector3d end = Eigen::Vector3d::Zero();
    Eigen::Vector3d start = end;
    Colour colour;
    double time = 0.0;
    std::size_t count = 0;
    const auto byte_of = [&](double value, double scale) {
      const double scaled = std::round(value * scale);
      if (!(scaled >= 0.0 && scaled <= 255.0)) fail(line_number, "has a colour out of range");
      return static_cast<std::uint8_t>(scaled);
    };
    for (auto field = fields.next(); field; field = fields.next(), ++count) {
      if (count == layout_.columns.size()) fail(line_number, too_many());
      const auto& column = layout_.columns[count];
      if (column.role == Role::ignored) continue;
      const double value = number(*field, line_number);
      switch (column.role) {
        case Role::ignored:
          break;
        case Role::x:
          end.x() = value;
          break;
        case Role::y:
          end.y() = value;
          break;
        case Role::z:
          end.z() = value;
          break;
        case Role::time:
          time = value;
          break;
        case Role::red:
          colour.red = byte_of(value, layout_.colour_scale);
          break;
        case Role::green:
          colour.green = byte_of(value, layout_.colour_scale);
          break;
        case Role::blue:
          colour.blue = byte_of(value, layout_.colour_scale);
          break;
        case Role::alpha:
          colour.intensity = byte_of(value, 1.0);
          break;
        case Role::start_x:
          start.x() = value;
          break;
        case Role::start_y:
          start.y() = value;
          break;
        case Role::start_z:
          start.z() = value;
          break;
        case Role::extra:
          if (!store(rays.extras[column.extra], row, value))
            fail(line_number, "has " + text::quoted(*field) + " for " + info().extras[column.extra].name +
                                  ", which is " + std::string(name_of(info().extras[column.extra].type)));
          break;
      }
    }
    if (count < layout_.columns.size())
      fail(line_number,
           "has " + std::to_string(count) + " of " + std::to_string(layout_.columns.size()) + " numbers");
    rays.ends[row] = end;
    rays.starts[row] = info().present.starts ? start : end;
    rays.times[row] = time;
    rays.colours[row] = colour;
    rays.bounded[row] = colour.intensity > 0 ? 1 : 0;
    return end.allFinite() && rays.starts[row].allFinite() && std::isfinite(time);
  }

  std::string too_many() const {
    return "has more than " + std::to_string(layout_.columns.size()) + " numbers";
  }

  double number(std::string_view field, std::uint64_t line_number) const {
    if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto value = text::number(field);
    if (!value) fail(line_number, "has " + text::quoted(field) + " where a number should be");
    return *value;
  }

  text::TextFile file_;
  text::LineReader lines_;
  std::size_t chunk_rows_;
  text::TextLayout layout_;
  std::uint64_t next_line_ = 0;
  std::uint64_t points_ = 0;
};

}  // namespace

std::unique_ptr<RaySource> open_text_points(const std::filesystem::path& path, const ReadOptions& options) {
  return std::make_unique<TextSource>(path, options);
}

}  // namespace ray
