#include "las_decoder.h"

#include "las_columns.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace ray {
namespace {

/// Takes the field out of `fields`.
std::optional<LasExtraField> take_field(std::vector<LasExtraField>& fields, std::string_view name) {
  const auto found =
      std::find_if(fields.begin(), fields.end(), [&](const auto& field) { return field.name == name; });
  if (found == fields.end()) return std::nullopt;
  LasExtraField field = *found;
  fields.erase(found);
  return field;
}

/// Calls `put(row, record)` for every record.
template <class Put>
void for_each_record(std::span<const std::byte> records, std::size_t length, const Put& put) {
  const std::size_t rows = records.size() / length;
  const std::byte* record = records.data();
  for (std::size_t row = 0; row < rows; ++row, record += length)
    put(row, record);
}

double scaled_value(const LasExtraField& field, const std::byte* record) {
  return visit_scalar(field.type, [&]<class T>() {
    return static_cast<double>(load<T>(record + field.at)) * field.scale + field.offset;
  });
}

std::uint8_t byte_at(const std::byte* record, std::size_t at) {
  return load<std::uint8_t>(record + at);
}

std::uint8_t flags_as_in_14(const std::byte* record) {
  return static_cast<std::uint8_t>((byte_at(record, 15) >> 5) | (byte_at(record, 14) & 0xc0));
}

template <std::size_t Size>
void copy_values(std::span<const std::byte> records, std::size_t length, std::size_t at, std::byte* out) {
  for_each_record(records, length, [&](std::size_t row, const std::byte* record) {
    std::memcpy(out + row * Size, record + at, Size);
  });
}

template <class T, class Value>
void fill(std::span<const std::byte> records, std::size_t length, Column& column, const Value& value) {
  const std::span<T> values = column.values<T>();
  for_each_record(records, length, [&](std::size_t row, const std::byte* record) {
    values[row] = static_cast<T>(value(record));
  });
}

void copy_column(std::span<const std::byte> records, std::size_t length, std::size_t at, Column& column) {
  switch (column.stride()) {
    case 1:
      return copy_values<1>(records, length, at, column.data());
    case 2:
      return copy_values<2>(records, length, at, column.data());
    case 4:
      return copy_values<4>(records, length, at, column.data());
    default:
      return copy_values<8>(records, length, at, column.data());
  }
}

void decode_column(std::span<const std::byte> records, std::size_t length, const LasColumn& from,
                   Column& column) {
  const auto bits = [&](int shift, int mask) {
    fill<std::uint8_t>(records, length, column,
                       [&](const std::byte* record) { return (byte_at(record, from.at) >> shift) & mask; });
  };
  switch (from.kind) {
    case LasColumn::Kind::copied:
      return copy_column(records, length, from.at, column);
    case LasColumn::Kind::return_number:
      return bits(0, 7);
    case LasColumn::Kind::number_of_returns:
      return bits(3, 7);
    case LasColumn::Kind::classification:
      return bits(0, 31);
    case LasColumn::Kind::return_number_14:
      return bits(0, 15);
    case LasColumn::Kind::number_of_returns_14:
      return bits(4, 15);
    case LasColumn::Kind::flags:
      return fill<std::uint8_t>(records, length, column, flags_as_in_14);
    case LasColumn::Kind::scaled:
      return fill<double>(records, length, column,
                          [&](const std::byte* record) { return scaled_value(from.field, record); });
    case LasColumn::Kind::scan_angle_rank:
      return fill<float>(records, length, column,
                         [&](const std::byte* record) { return load<std::int8_t>(record + from.at); });
    case LasColumn::Kind::scan_angle:
      return fill<float>(records, length, column, [&](const std::byte* record) {
        return scan_angle_degrees(load<std::int16_t>(record + from.at));
      });
  }
}

}  // namespace

LasDecoder::LasDecoder(const LasHeader& header)
    : record_length_(header.record_length),
      scale_(header.scale),
      offset_(header.offset),
      times_at_(las_times_at(header.format)),
      colours_at_(las_colours_at(header.format)) {
  std::vector<LasExtraField> extra = header.extra_fields;
  auto x = take_field(extra, "BeamOriginX");
  auto y = take_field(extra, "BeamOriginY");
  auto z = take_field(extra, "BeamOriginZ");
  if (x && y && z) {
    origins_ = {*x, *y, *z};
    bounded_ = take_field(extra, "Bounded");
  }
  // Elsewhere a column of that name means something else.
  if (header.notes.there) alpha_ = take_field(extra, "Alpha");
  if (!origins_)
    for (auto& field : {x, y, z})
      if (field) extra.push_back(*field);
  columns_ = las_columns(header, extra);
  for (const LasColumn& column : columns_) {
    info_.extras.push_back(column.info);
    // A file of this project names its columns; any other has these because its point format does.
    if (!header.notes.there && column.at < las_format_length(header.format))
      info_.formal_extras.push_back(column.info.name);
  }
  // The finest: of a file in degrees the heights would give a step that is far too coarse for the rest.
  info_.coordinate_step = std::abs(*std::min_element(
      scale_.begin(), scale_.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
  info_.crs = header.crs;
  info_.time_base = header.time_base;
  info_.history = header.notes.history;
  info_.comments = header.notes.comments;
  info_.present.starts = origins_.has_value();
  info_.present.times = times_at_ != 0 && !header.notes.without_times;
  info_.present.colours = colours_at_ != 0 && !header.notes.without_colours;
  info_.present.intensity = alpha_.has_value();
}

std::uint16_t LasDecoder::colour_bits(std::span<const std::byte> records) const {
  std::uint16_t bits = 0;
  if (colours_at_ == 0) return bits;
  for_each_record(records, record_length_, [&](std::size_t, const std::byte* record) {
    const auto colour = load<std::array<std::uint16_t, 3>>(record + colours_at_);
    bits = static_cast<std::uint16_t>(bits | colour[0] | colour[1] | colour[2]);
  });
  return bits;
}

void LasDecoder::decode_coordinates(std::span<const std::byte> records, RayCloud& rays) const {
  for_each_record(records, record_length_, [&](std::size_t row, const std::byte* record) {
    const auto stored = load<std::array<std::int32_t, 3>>(record);
    for (std::size_t axis = 0; axis < 3; ++axis)
      rays.ends[row][static_cast<Eigen::Index>(axis)] = stored[axis] * scale_[axis] + offset_[axis];
  });
  if (!origins_) {
    rays.starts = rays.ends;
    return;
  }
  for_each_record(records, record_length_, [&](std::size_t row, const std::byte* record) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      rays.starts[row][static_cast<Eigen::Index>(axis)] = scaled_value((*origins_)[axis], record);
  });
}

void LasDecoder::decode_colours(std::span<const std::byte> records, bool wide_colours, RayCloud& rays) const {
  const std::uint8_t shift = wide_colours ? 8 : 0;
  if (info_.present.colours) {
    for_each_record(records, record_length_, [&](std::size_t row, const std::byte* record) {
      const auto colour = load<std::array<std::uint16_t, 3>>(record + colours_at_);
      rays.colours[row] = {static_cast<std::uint8_t>(colour[0] >> shift),
                           static_cast<std::uint8_t>(colour[1] >> shift),
                           static_cast<std::uint8_t>(colour[2] >> shift), 255};
    });
  } else {
    std::fill(rays.colours.begin(), rays.colours.end(), Colour{});
  }
  if (!alpha_) return;
  for_each_record(records, record_length_, [&](std::size_t row, const std::byte* record) {
    rays.colours[row].intensity = byte_at(record, alpha_->at);
  });
}

std::size_t LasDecoder::decode(std::span<const std::byte> records, bool wide_colours, RayCloud& rays) const {
  rays.set_schema(info_.extras);
  rays.resize(records.size() / record_length_);
  decode_coordinates(records, rays);
  decode_colours(records, wide_colours, rays);
  if (info_.present.times) {
    for_each_record(records, record_length_, [&](std::size_t row, const std::byte* record) {
      rays.times[row] = load<double>(record + times_at_);
    });
  } else {
    std::fill(rays.times.begin(), rays.times.end(), 0.0);
  }
  std::fill(rays.bounded.begin(), rays.bounded.end(), std::uint8_t{1});
  if (bounded_)
    for_each_record(records, record_length_, [&](std::size_t row, const std::byte* record) {
      rays.bounded[row] = scaled_value(*bounded_, record) != 0.0 ? 1 : 0;
    });
  else if (alpha_)
    for (std::size_t row = 0; row < rays.size(); ++row)
      rays.bounded[row] = rays.colours[row].intensity != 0 ? 1 : 0;
  for (std::size_t i = 0; i < columns_.size(); ++i)
    decode_column(records, record_length_, columns_[i], rays.extras[i]);
  return drop_not_finite(rays);
}

}  // namespace ray
