#include "ply_decode.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

namespace ray {
namespace {

static_assert(std::endian::native == std::endian::little, "rows of a big-endian machine are not thought of");
static_assert(sizeof(Colour) == 4, "decoded as the four bytes of a row");

template <class T>
T swapped(T value) {
  if constexpr (sizeof(T) == 8)
    return std::bit_cast<T>(__builtin_bswap64(std::bit_cast<std::uint64_t>(value)));
  else if constexpr (sizeof(T) == 4) {
    return std::bit_cast<T>(__builtin_bswap32(std::bit_cast<std::uint32_t>(value)));
  } else if constexpr (sizeof(T) == 2) {
    return std::bit_cast<T>(__builtin_bswap16(std::bit_cast<std::uint16_t>(value)));
  } else {
    return value;
  }
}

/// Calls `put(i, value)` for one field of rows [begin, end), with the value in its own type.
template <class T, class Put>
void each_value(const std::byte* rows, const PlyLayout& layout, std::size_t offset, std::size_t begin,
                std::size_t end, const Put& put) {
  if (begin == end) return;  // no rows: there may be no buffer either
  const std::size_t stride = layout.row_bytes;
  const std::byte* from = rows + begin * stride + offset;
  const auto loop = [&](auto change) {
    for (std::size_t i = begin; i < end; ++i, from += stride) {
      T value;
      std::memcpy(&value, from, sizeof(T));
      put(i, change(value));
    }
  };
  if (layout.big_endian)
    loop([](T value) { return swapped(value); });
  else
    loop([](T value) { return value; });
}

template <class Put>
void each_value(const std::byte* rows, const PlyLayout& layout, const PlyField& field, std::size_t begin,
                std::size_t end, const Put& put) {
  visit_scalar(field.type, [&]<class T>() { each_value<T>(rows, layout, field.offset, begin, end, put); });
}

template <class T>
std::uint8_t to_channel(T value, double scale) {
  if constexpr (sizeof(T) == 1) {
    return static_cast<std::uint8_t>(value);  // a `char` holds the same bits
  } else {
    const double scaled = static_cast<double>(value) * scale;
    // Written so that NaN becomes 0. Whole numbers are cut, as a shift would, fractions rounded.
    const double rounding = std::is_floating_point_v<T> ? 0.5 : 0.0;
    return scaled > 0.0 ? static_cast<std::uint8_t>(std::min(scaled + rounding, 255.0)) : std::uint8_t{0};
  }
}

/// The layout this project writes, extras aside.
bool is_standard(const PlySchema& schema, const PlyLayout& layout, ScalarType real) {
  const std::size_t size = size_of(real);
  const auto three_at = [](const std::array<PlyField, 3>& fields, std::size_t offset, ScalarType type) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (fields[i].type != type || fields[i].offset != offset + i * size_of(type)) return false;
    }
    return true;
  };
  return !layout.big_endian && schema.ray && schema.time && schema.colour && schema.alpha &&
         three_at(schema.end, 0, real) && schema.time->type == ScalarType::float64 &&
         schema.time->offset == 3 * size && three_at(*schema.ray, 3 * size + 8, real) &&
         three_at(*schema.colour, 6 * size + 8, ScalarType::uint8) &&
         schema.alpha->type == ScalarType::uint8 && schema.alpha->offset == 6 * size + 11;
}

/// What a row of that layout says of place and time.
template <class Real>
struct StandardRow {
  Real end[3];
  Real ray[3];
  double time;

  explicit StandardRow(const std::byte* row) {
    std::memcpy(end, row, sizeof end);
    std::memcpy(&time, row + sizeof end, 8);
    std::memcpy(ray, row + sizeof end + 8, sizeof ray);
  }
  [[nodiscard]] double start(std::size_t axis) const {
    return static_cast<double>(end[axis]) + static_cast<double>(ray[axis]);
  }
};

/// 0 if the ray is finite, else NaN: 0 · x is NaN for NaN and for infinity, and a start is not finite where
/// its end is not.
double zero_if_finite(double x, double y, double z, double time) {
  return 0.0 * (x + y + z + time);
}

/// Whether all rays are finite.
template <class Real>
bool decode_standard(const std::byte* rows, std::size_t stride, std::size_t count, RayCloud& rays) {
  double* ends = rays.ends.data()->data();
  double* starts = rays.starts.data()->data();
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i, rows += stride) {
    const StandardRow<Real> row(rows);
    rays.times[i] = row.time;
    std::memcpy(&rays.colours[i], rows + 2 * sizeof row.end + 8, 4);
    rays.bounded[i] = std::to_integer<std::uint8_t>(rows[2 * sizeof row.end + 11]) != 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ends[3 * i + axis] = static_cast<double>(row.end[axis]);
      starts[3 * i + axis] = row.start(axis);
    }
    sum += zero_if_finite(row.start(0), row.start(1), row.start(2), row.time);
  }
  return sum == 0.0;
}

/// Whether all rays are finite; only then are these their times.
template <class Real>
bool decode_standard_times(const std::byte* rows, std::size_t stride, std::vector<double>& times) {
  double sum = 0.0;
  for (double& time : times) {
    const StandardRow<Real> row(rows);
    time = row.time;
    sum += zero_if_finite(row.start(0), row.start(1), row.start(2), row.time);
    rows += stride;
  }
  return sum == 0.0;
}

}  // namespace

PlyDecoder::PlyDecoder(PlySchema schema, PlyLayout layout, std::array<double, 3> origin, PlyColourScale scale)
    : schema_(std::move(schema)), layout_(std::move(layout)), origin_(origin), scale_(scale) {
  for (const PlyExtra& extra : schema_.extras)
    extras_.push_back(extra.info);
  if (origin_ != std::array<double, 3>{}) return;
  standard_single_ = is_standard(schema_, layout_, ScalarType::float32);
  standard_double_ = is_standard(schema_, layout_, ScalarType::float64);
}

std::size_t PlyDecoder::decode(std::span<const std::byte> rows, RayCloud& rays) const {
  const std::size_t count = rows.size() / layout_.row_bytes;
  rays.resize(count);
  rays.set_schema(extras_);
  if (count == 0) return 0;
  bool finite = true;
  if (standard_single_)
    finite = decode_standard<float>(rows.data(), layout_.row_bytes, count, rays);
  else if (standard_double_)
    finite = decode_standard<double>(rows.data(), layout_.row_bytes, count, rays);
  // Column after column, but within few enough rows to stay in the nearest cache.
  const std::size_t block = std::clamp<std::size_t>(16384 / layout_.row_bytes, 1, count);
  const bool standard = standard_single_ || standard_double_;
  for (std::size_t begin = 0; begin < count && !(standard && extras_.empty()); begin += block) {
    const std::size_t end = std::min(begin + block, count);
    if (!standard) decode_columns(rows.data(), begin, end, rays);
    decode_extras(rows.data(), begin, end, rays);
  }
  return standard && finite ? 0 : drop_not_finite(rays);
}

std::size_t PlyDecoder::decode_times(std::span<const std::byte> rows, std::vector<double>& times) const {
  times.resize(rows.size() / layout_.row_bytes);
  if (standard_single_ && decode_standard_times<float>(rows.data(), layout_.row_bytes, times)) return 0;
  if (standard_double_ && decode_standard_times<double>(rows.data(), layout_.row_bytes, times)) return 0;
  RayCloud rays;
  const std::size_t dropped = decode(rows, rays);
  times = std::move(rays.times);
  return dropped;
}

void PlyDecoder::decode_columns(const std::byte* rows, std::size_t begin, std::size_t end,
                                RayCloud& rays) const {
  const auto each = [&](const PlyField& field, const auto& put) {
    each_value(rows, layout_, field, begin, end, put);
  };
  double* ends = rays.ends.data()->data();
  double* starts = rays.starts.data()->data();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Adding -0.0 keeps every bit, where 0.0 would turn -0.0 round.
    const double origin = origin_[axis] == 0.0 ? -0.0 : origin_[axis];
    each(schema_.end[axis], [=](std::size_t i, auto value) {
      ends[3 * i + axis] = starts[3 * i + axis] = static_cast<double>(value) + origin;
    });
    if (!schema_.ray) continue;
    each((*schema_.ray)[axis],
         [=](std::size_t i, auto value) { starts[3 * i + axis] += static_cast<double>(value); });
  }
  std::fill(rays.times.data() + begin, rays.times.data() + end, 0.0);
  if (schema_.time) {
    each(*schema_.time,
         [times = rays.times.data()](std::size_t i, auto value) { times[i] = static_cast<double>(value); });
  }
  std::fill(rays.colours.data() + begin, rays.colours.data() + end, Colour{});
  if (schema_.colour) {
    constexpr std::uint8_t Colour::*kChannels[] = {&Colour::red, &Colour::green, &Colour::blue};
    for (std::size_t c = 0; c < 3; ++c) {
      each((*schema_.colour)[c],
           [colours = rays.colours.data(), channel = kChannels[c], scale = scale_.colour](
               std::size_t i, auto value) { colours[i].*channel = to_channel(value, scale); });
    }
  }
  if (schema_.alpha) {
    each(*schema_.alpha, [colours = rays.colours.data(), scale = scale_.alpha](std::size_t i, auto value) {
      colours[i].intensity = to_channel(value, scale);
    });
  }
  for (std::size_t i = begin; i < end; ++i)
    rays.bounded[i] = rays.colours[i].intensity != 0;
}

void PlyDecoder::decode_extras(const std::byte* rows, std::size_t begin, std::size_t end,
                               RayCloud& rays) const {
  for (std::size_t c = 0; c < schema_.extras.size(); ++c) {
    const PlyExtra& extra = schema_.extras[c];
    std::byte* out = rays.extras[c].data();
    if (extra.high) {
      const auto half = [&](const PlyField& field, std::size_t at) {
        each_value<std::uint32_t>(
            rows, layout_, field.offset, begin, end,
            [=](std::size_t i, std::uint32_t value) { std::memcpy(out + 8 * i + at, &value, 4); });
      };
      half(extra.field, 0);
      half(*extra.high, 4);
    } else {
      each_value(rows, layout_, extra.field, begin, end, [=](std::size_t i, auto value) {
        std::memcpy(out + sizeof(value) * i, &value, sizeof(value));
      });
    }
  }
}

std::vector<double> field_values(std::span<const std::byte> rows, const PlyLayout& layout,
                                 const PlyField& field) {
  std::vector<double> values(rows.size() / layout.row_bytes);
  each_value(rows.data(), layout, field, 0, values.size(),
             [&](std::size_t i, auto value) { values[i] = static_cast<double>(value); });
  return values;
}

}  // namespace ray
