#include "ply_encode.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
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

/// Whether all values are certainly stored well enough, without branches: the sign of |value| - limit is set
/// where the value is below, and not for NaN.
class Safety {
 public:
  explicit Safety(double limit) : limit_(limit) {}
  void add(double value) { signs_ &= std::bit_cast<std::uint64_t>(std::abs(value) - limit_); }
  void add_time(double time) {
    signs_ &= std::bit_cast<std::uint64_t>(std::abs(time) - std::numeric_limits<double>::max());
  }
  [[nodiscard]] bool is_safe() const { return signs_ >> 63 != 0; }

 private:
  double limit_;
  std::uint64_t signs_ = ~std::uint64_t{0};
};

/// The standard columns of rays in one go: this is what nearly all the time goes to. `row_at(i)` is the row
/// of the i-th. Returns whether all values are safe.
template <class Real, class RowAt>
bool encode_rays(const RayCloud& rays, const RowAt& row_at, std::size_t begin, std::size_t end, double limit,
                 std::size_t stride, std::byte* out) {
  Safety safety(limit);
  for (std::size_t i = begin; i < end; ++i, out += stride) {
    const std::size_t row = row_at(i);
    const double* to = rays.ends[row].data();
    const double* from = rays.starts[row].data();
    Real point[3], ray[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double way = from[axis] - to[axis];
      safety.add(to[axis]);
      safety.add(way);
      point[axis] = static_cast<Real>(to[axis]);
      ray[axis] = static_cast<Real>(way);
    }
    const double time = rays.times[row];
    safety.add_time(time);
    Colour colour = rays.colours[row];
    colour.intensity = alpha_of(rays, row);
    std::memcpy(out, point, sizeof point);
    std::memcpy(out + sizeof point, &time, 8);
    std::memcpy(out + sizeof point + 8, ray, sizeof ray);
    std::memcpy(out + 2 * sizeof point + 8, &colour, 4);
  }
  return safety.is_safe();
}

template <class RowAt>
void encode_extra(const Column& column, const RowAt& row_at, std::size_t begin, std::size_t end,
                  std::size_t stride, std::byte* out) {
  // A 64-bit integer is its low half followed by its high one, as the two properties are.
  visit_scalar(column.type(), [&]<class T>() {
    for (std::size_t i = begin; i < end; ++i, out += stride)
      std::memcpy(out, column.data() + row_at(i) * sizeof(T), sizeof(T));
  });
}

/// As encode_rays.
template <class Real, class RowAt>
bool encode_points(const RayCloud& rays, const RowAt& row_at, std::size_t begin, std::size_t end,
                   double limit, const RowColumns& columns, std::byte* out) {
  Safety safety(limit);
  for (std::size_t i = begin; i < end; ++i, out += columns.row_bytes) {
    const std::size_t row = row_at(i);
    Real point[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = rays.ends[row].data()[axis];
      safety.add(value);
      point[axis] = static_cast<Real>(value);
    }
    safety.add_time(rays.times[row]);
    std::memcpy(out, point, sizeof point);
    if (columns.time != RowColumns::kNone) std::memcpy(out + columns.time, &rays.times[row], 8);
    if (columns.colour != RowColumns::kNone) std::memcpy(out + columns.colour, &rays.colours[row], 3);
    if (columns.alpha != RowColumns::kNone) out[columns.alpha] = std::byte{alpha_of(rays, row)};
  }
  return safety.is_safe();
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
  encode_all(
      rays, rays.size(), [](std::size_t i) { return i; }, raw);
}

void PlyEncoder::encode_rows(const RayCloud& rays, std::span<const std::uint32_t> rows, RawChunk& raw) const {
  encode_all(
      rays, rows.size(), [rows](std::size_t i) { return std::size_t{rows[i]}; }, raw);
}

template <class RowAt>
void PlyEncoder::encode_all(const RayCloud& rays, std::size_t count, const RowAt& row_at,
                            RawChunk& raw) const {
  const RowColumns& columns = layout_->columns();
  const std::size_t stride = columns.row_bytes;
  raw.rows = count;
  raw.bytes.resize(count * stride);
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, count);
    std::byte* out = raw.bytes.data() + begin * stride;
    const auto encode_as = [&]<class Real>(Real) {
      return rays_ ? encode_rays<Real>(rays, row_at, begin, end, safe_, stride, out)
                   : encode_points<Real>(rays, row_at, begin, end, safe_, columns, out);
    };
    const bool safe = single_ ? encode_as(float{}) : encode_as(double{});
    for (std::size_t i = begin; i < end && !safe; ++i)
      check_ray(rays, row_at(i));
    for (std::size_t c = 0; c < rays.extras.size(); ++c)
      encode_extra(rays.extras[c], row_at, begin, end, stride, out + layout_->extra(c));
  }
}

/// Throws if a value cannot be stored.
void PlyEncoder::check_ray(const RayCloud& rays, std::size_t row) const {
  if (!std::isfinite(rays.times[row])) fail_not_finite();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    check_value(rays.ends[row][axis]);
    if (rays_) check_value(rays.starts[row][axis] - rays.ends[row][axis]);
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

bool PlyEncoder::reflect(RayCloud& rays) const {
  const bool settled = single_ ? reflect_as<float>(rays) : reflect_as<double>(rays);
  reflect_settled(rays);
  return settled;
}

void PlyEncoder::reflect_settled(RayCloud& rays) const {
  for (std::size_t i = 0; i < rays.size(); ++i)
    rays.colours[i].intensity = alpha_of(rays, i);
}

/// Block by block, in loops that compilers vectorise. What comes from a file mostly stays as it is, which one
/// loop finds out without writing.
template <class Real>
bool PlyEncoder::reflect_as(RayCloud& rays) const {
  bool settled = true;
  double* to = rays.ends.data()->data();
  double* from = rays.starts.data()->data();
  for (std::size_t begin = 0; begin < rays.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, rays.size());
    Safety safety(safe_);
    std::uint64_t changing = 0;  // bits that would not be the same
    for (std::size_t j = 3 * begin; j < 3 * end; ++j) {
      const double way = from[j] - to[j];
      safety.add(to[j]);
      safety.add(way);
      const auto stored_end = static_cast<double>(static_cast<Real>(to[j]));
      const auto stored_way = static_cast<double>(static_cast<Real>(way));
      changing |=
          (std::bit_cast<std::uint64_t>(stored_end) ^ std::bit_cast<std::uint64_t>(to[j])) |
          (std::bit_cast<std::uint64_t>(stored_way) ^ std::bit_cast<std::uint64_t>(way)) |
          (std::bit_cast<std::uint64_t>(stored_end + stored_way) ^ std::bit_cast<std::uint64_t>(from[j]));
    }
    for (std::size_t i = begin; i < end; ++i)
      safety.add_time(rays.times[i]);
    for (std::size_t i = begin; i < end && !safety.is_safe(); ++i)
      check_ray(rays, i);
    if (changing != 0) settled = store_as<Real>(rays, begin, end) && settled;
  }
  return settled;
}

/// Rounds starts and ends as a file does. Returns whether doing it again would leave them.
template <class Real>
bool PlyEncoder::store_as(RayCloud& rays, std::size_t begin, std::size_t end) {
  double* to = rays.ends.data()->data();
  double* from = rays.starts.data()->data();
  std::size_t changing = 0;
  for (std::size_t j = 3 * begin; j < 3 * end; ++j) {
    const auto stored_end = static_cast<Real>(to[j]);
    const auto stored_ray = static_cast<Real>(from[j] - to[j]);
    to[j] = static_cast<double>(stored_end);
    from[j] = static_cast<double>(stored_end) + static_cast<double>(stored_ray);
    changing += from[j] - to[j] != static_cast<double>(stored_ray) ? 1 : 0;
  }
  return changing == 0;
}

}  // namespace ray
