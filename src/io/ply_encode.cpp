#include "ply_encode.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <unordered_set>
#include <utility>

namespace ray {
namespace {

constexpr double kTolerance = 1e-4;  // m, of a coordinate in single precision
constexpr std::size_t kBlock = 512;  // rows that stay in the nearest cache

std::string_view ply_type(ScalarType type) {
  constexpr std::string_view kNames[] = {"char", "uchar", "short", "ushort", "int",
                                         "uint", "",      "",      "float",  "double"};
  return kNames[static_cast<std::size_t>(type)];
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\0'; }, ' ');
  return text;
}

std::string one_word(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return (c >= '\0' && c <= ' ') || c == '\x7f'; }, '_');
  return text;
}

/// Where columns are in a row; kNone where there is none.
struct RowColumns {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::size_t row_bytes = 0;
  std::size_t time = kNone;
  std::size_t colour = kNone;
  std::size_t alpha = kNone;
};

std::uint8_t alpha_of(const RayCloud& rays, std::size_t i) {
  return rays.bounded[i] != 0 ? std::max<std::uint8_t>(rays.colours[i].intensity, 1) : std::uint8_t{0};
}

/// The standard columns of a ray in one go: this is what nearly all the time goes to.
template <class Real>
void encode_rays(const RayCloud& rays, std::size_t begin, std::size_t end, std::size_t stride,
                 std::byte* row) {
  for (std::size_t i = begin; i < end; ++i, row += stride) {
    const double* to = rays.ends[i].data();
    const double* from = rays.starts[i].data();
    const Real point[3] = {static_cast<Real>(to[0]), static_cast<Real>(to[1]), static_cast<Real>(to[2])};
    const Real ray[3] = {static_cast<Real>(from[0] - to[0]), static_cast<Real>(from[1] - to[1]),
                         static_cast<Real>(from[2] - to[2])};
    Colour colour = rays.colours[i];
    colour.intensity = alpha_of(rays, i);
    std::memcpy(row, point, sizeof point);
    std::memcpy(row + sizeof point, &rays.times[i], 8);
    std::memcpy(row + sizeof point + 8, ray, sizeof ray);
    std::memcpy(row + 2 * sizeof point + 8, &colour, 4);
  }
}

void encode_extra(const Column& column, std::size_t begin, std::size_t end, std::size_t stride,
                  std::byte* row) {
  // A 64-bit integer is its low half followed by its high one, as the two properties are.
  visit_scalar(column.type(), [&]<class T>() {
    const std::byte* from = column.data() + begin * sizeof(T);
    for (std::size_t i = begin; i < end; ++i, row += stride, from += sizeof(T))
      std::memcpy(row, from, sizeof(T));
  });
}

template <class Real>
void encode_points(const RayCloud& rays, std::size_t begin, std::size_t end, const RowColumns& columns,
                   std::byte* row) {
  for (std::size_t i = begin; i < end; ++i, row += columns.row_bytes) {
    const double* to = rays.ends[i].data();
    const Real point[3] = {static_cast<Real>(to[0]), static_cast<Real>(to[1]), static_cast<Real>(to[2])};
    std::memcpy(row, point, sizeof point);
    if (columns.time != RowColumns::kNone) std::memcpy(row + columns.time, &rays.times[i], 8);
    if (columns.colour != RowColumns::kNone) std::memcpy(row + columns.colour, &rays.colours[i], 3);
    if (columns.alpha != RowColumns::kNone) row[columns.alpha] = std::byte{alpha_of(rays, i)};
  }
}

}  // namespace

/// The header, and where its parts are in a row.
class PlyEncoder::Layout {
 public:
  Layout(std::string file, const CloudInfo& info, bool rays) : file_(std::move(file)) {
    begin_header(info, rays);
    const Present present = rays ? Present{} : info.present;
    const std::string_view real = info.precision == Precision::single ? "float" : "double";
    const std::size_t real_size = info.precision == Precision::single ? 4 : 8;
    for (const char* name : {"x", "y", "z"})
      add(name, real, real_size);
    columns_.time = present.times ? add("time", "double", 8) : RowColumns::kNone;
    for (const char* name : {"nx", "ny", "nz"}) {
      if (rays) add(name, real, real_size);
    }
    columns_.colour = columns_.row_bytes;
    for (const char* name : {"red", "green", "blue"}) {
      if (present.colours) add(name, "uchar", 1);
    }
    if (!present.colours) columns_.colour = RowColumns::kNone;
    columns_.alpha = present.intensity ? add("alpha", "uchar", 1) : RowColumns::kNone;
    add_extras(info.extras);
    header_ += "end_header\n";
  }

  [[nodiscard]] const std::string& header() const { return header_; }
  [[nodiscard]] std::size_t count_offset() const { return count_offset_; }
  [[nodiscard]] const RowColumns& columns() const { return columns_; }
  [[nodiscard]] std::size_t extra(std::size_t column) const { return extras_[column]; }

 private:
  void begin_header(const CloudInfo& info, bool rays) {
    header_ = "ply\nformat binary_little_endian 1.0\n";
    if (rays) comment("raycloud version 1");
    if (!info.crs.empty()) comment("crs " + info.crs);
    if (!info.time_base.empty()) comment("time_base " + info.time_base);
    for (const std::string& line : info.history)
      comment("history " + line);
    for (const std::string& line : info.comments) {
      // A stranger's remark must not be read as an instruction.
      const bool speaks = line.starts_with("origin ") || line.starts_with("raycloud version ");
      comment(speaks ? "note " + line : line);
    }
    header_ += "element vertex ";
    count_offset_ = header_.size();
    header_ += std::string(kCountDigits, '0') + "\n";
  }

  void comment(const std::string& text) { header_ += "comment " + one_line(text) + "\n"; }

  std::size_t add(const std::string& name, std::string_view type, std::size_t size) {
    if (!names_.insert(name).second) {
      throw Error(ErrorCode::usage, file_ + ": cannot store two columns named '" + name + "'");
    }
    header_ += "property " + std::string(type) + " " + name + "\n";
    return std::exchange(columns_.row_bytes, columns_.row_bytes + size);
  }

  void add_extras(const std::vector<ColumnInfo>& extras) {
    // Reserved even where not written: on reading they would mean something else.
    for (const char* name :
         {"time", "nx", "ny", "nz", "red", "green", "blue", "alpha", "rayx", "rayy", "rayz"}) {
      names_.insert(name);
    }
    for (const ColumnInfo& column : extras) {
      const std::string name = one_word(column.name);
      if (name.empty()) throw Error(ErrorCode::usage, file_ + ": cannot store a column without a name");
      if (size_of(column.type) < 8 || column.type == ScalarType::float64) {
        extras_.push_back(add(name, ply_type(column.type), size_of(column.type)));
      } else {
        extras_.push_back(add(name + "__low", "uint", 4));
        add(name + "__high", column.type == ScalarType::int64 ? "int" : "uint", 4);
      }
    }
  }

  std::string file_;
  std::string header_;
  std::size_t count_offset_ = 0;
  RowColumns columns_;
  std::vector<std::size_t> extras_;
  std::unordered_set<std::string> names_;
};

PlyEncoder::PlyEncoder(std::string name, const CloudInfo& info, bool rays)
    : name_(std::move(name)),
      layout_(std::make_unique<Layout>(name_, info, rays)),
      rays_(rays),
      single_(info.precision == Precision::single),
      safe_(std::numeric_limits<double>::max()) {
  if (!single_) return;
  tolerance_ = info.coordinate_step > 0.0 ? std::min(kTolerance, info.coordinate_step / 2.0) : kTolerance;
  // A float below 2^k is off by at most 2^(k-25).
  safe_ = std::exp2(25.0 + std::floor(std::log2(tolerance_)));
}

PlyEncoder::~PlyEncoder() = default;

const std::string& PlyEncoder::header() const {
  return layout_->header();
}

std::size_t PlyEncoder::count_offset() const {
  return layout_->count_offset();
}

void PlyEncoder::encode(const RayCloud& rays, RawChunk& raw) const {
  const std::size_t stride = layout_->columns().row_bytes;
  raw.rows = rays.size();
  raw.bytes.resize(raw.rows * stride);
  for (std::size_t begin = 0; begin < raw.rows; begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, raw.rows);
    std::byte* row = raw.bytes.data() + begin * stride;
    check(rays, begin, end);
    if (rays_) {
      single_ ? encode_rays<float>(rays, begin, end, stride, row)
              : encode_rays<double>(rays, begin, end, stride, row);
    } else {
      single_ ? encode_points<float>(rays, begin, end, layout_->columns(), row)
              : encode_points<double>(rays, begin, end, layout_->columns(), row);
    }
    for (std::size_t c = 0; c < rays.extras.size(); ++c) {
      encode_extra(rays.extras[c], begin, end, stride, row + layout_->extra(c));
    }
  }
}

/// Throws if a value cannot be stored. Nearly always a look at the magnitudes is enough.
void PlyEncoder::check(const RayCloud& rays, std::size_t begin, std::size_t end) const {
  const double* to = rays.ends.data()->data();
  const double* from = rays.starts.data()->data();
  std::size_t safe = 0;  // counted rather than compared one by one, which compilers vectorise
  for (std::size_t j = 3 * begin; j < 3 * end; ++j) {
    safe += static_cast<std::size_t>(std::abs(to[j]) < safe_) +
            static_cast<std::size_t>(std::abs(from[j] - to[j]) < safe_);
  }
  std::size_t finite = 0;
  for (std::size_t i = begin; i < end; ++i)
    finite += static_cast<std::size_t>(std::isfinite(rays.times[i]));
  if (safe == 6 * (end - begin) && finite == end - begin) return;
  for (std::size_t i = begin; i < end; ++i) {
    if (!std::isfinite(rays.times[i])) fail_not_finite();
    for (std::size_t j = 3 * i; j < 3 * i + 3; ++j) {
      check_value(to[j]);
      if (rays_) check_value(from[j] - to[j]);
    }
  }
}

void PlyEncoder::check_value(double value) const {
  if (!std::isfinite(value)) fail_not_finite();
  if (!single_) return;
  const bool fits = std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()) &&
                    std::abs(static_cast<double>(static_cast<float>(value)) - value) <= tolerance_;
  if (!fits) {
    throw PrecisionLoss(name_ + ": the coordinate " + std::to_string(value) + " needs double precision");
  }
}

void PlyEncoder::fail_not_finite() const {
  throw Error(ErrorCode::out_of_range, name_ + ": a coordinate or time that is not finite cannot be stored");
}

void PlyEncoder::reflect(RayCloud& rays) const {
  for (std::size_t begin = 0; begin < rays.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, rays.size());
    check(rays, begin, end);
    double* to = rays.ends.data()->data();
    double* from = rays.starts.data()->data();
    const auto round = [&]<class Real>(Real) {
      for (std::size_t j = 3 * begin; j < 3 * end; ++j) {
        const auto stored_end = static_cast<Real>(to[j]);
        const auto stored_ray = static_cast<Real>(from[j] - to[j]);
        to[j] = static_cast<double>(stored_end);
        from[j] = static_cast<double>(stored_end) + static_cast<double>(stored_ray);
      }
    };
    single_ ? round(float{}) : round(double{});
    for (std::size_t i = begin; i < end; ++i)
      rays.colours[i].intensity = alpha_of(rays, i);
  }
}

}  // namespace ray
