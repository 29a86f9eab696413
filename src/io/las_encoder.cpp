#include "las_encoder.h"

#include "las_decoder.h"
#include "las_header.h"
#include "las_notes.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>

namespace ray {
namespace {

struct FieldInfo {
  std::string_view name;
  ScalarType type;
};

/// In the order of LasField.
constexpr std::array<FieldInfo, kLasFieldCount> kFields{{{"intensity", ScalarType::uint16},
                                                         {"return_number", ScalarType::uint8},
                                                         {"number_of_returns", ScalarType::uint8},
                                                         {"classification", ScalarType::uint8},
                                                         {"flags", ScalarType::uint8},
                                                         {"scan_angle", ScalarType::float32},
                                                         {"user_data", ScalarType::uint8},
                                                         {"point_source_id", ScalarType::uint16}}};

/// The nearest angle that LAS 1.4 can store, 0 if there is none.
std::int16_t stored_angle(float degrees) {
  const double steps = std::nearbyint(degrees / 0.006);
  return std::abs(steps) <= 30000.0 ? static_cast<std::int16_t>(steps) : std::int16_t{0};
}

bool survives(float degrees) {
  return std::bit_cast<std::uint32_t>(scan_angle_degrees(stored_angle(degrees))) ==
         std::bit_cast<std::uint32_t>(degrees);
}

bool loses_a_value(const Column& column, LasField field) {
  if (field == LasField::scan_angle) {
    const auto values = column.values<float>();
    return !std::all_of(values.begin(), values.end(), survives);
  }
  if (field != LasField::return_number && field != LasField::number_of_returns) return false;
  const auto values = column.values<std::uint8_t>();
  return std::any_of(values.begin(), values.end(), [](std::uint8_t value) { return value > 15; });
}

void survey_columns(const RayCloud& rays, LasSurvey& survey) {
  const Column* returns = nullptr;
  for (const Column& column : rays.extras) {
    const auto field = las_field_of(column.info());
    if (!field) continue;
    auto& lossy = survey.lossy[static_cast<std::size_t>(*field)];
    lossy = lossy || loses_a_value(column, *field);
    if (*field == LasField::return_number) returns = &column;
  }
  if (returns == nullptr) {
    survey.by_return[1] = rays.size();
  } else {
    for (const std::uint8_t value : returns->values<std::uint8_t>())
      if (value <= 15) ++survey.by_return[value];
  }
}

Bounds bounds_of(const std::vector<Eigen::Vector3d>& points) {
  Bounds bounds;
  for (const Eigen::Vector3d& point : points) {
    if (!point.allFinite())
      throw Error(ErrorCode::out_of_range, "a coordinate that is not a finite number cannot be stored");
    bounds.add(point);
  }
  return bounds;
}

template <class T>
void put(const RayCloud& rays, std::size_t length, std::byte* at, const T& value) {
  for (std::size_t row = 0; row < rays.size(); ++row, at += length)
    store(at, value(row));
}

void put_points(const std::vector<Eigen::Vector3d>& points, const LasGrid& grid, std::size_t length,
                std::byte* at) {
  for (const Eigen::Vector3d& point : points) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      store(at + 4 * axis, grid[axis].stored(point[static_cast<Eigen::Index>(axis)]));
    at += length;
  }
}

template <class T, class Stored>
void put_values(const Column& column, std::size_t length, std::byte* at, const Stored& stored) {
  for (const T value : column.values<T>()) {
    stored(at, value);
    at += length;
  }
}

}  // namespace

std::optional<LasField> las_field_of(const ColumnInfo& column) {
  for (std::size_t i = 0; i < kFields.size(); ++i)
    if (kFields[i].name == column.name && kFields[i].type == column.type) return static_cast<LasField>(i);
  return std::nullopt;
}

void LasSurvey::add(const LasSurvey& other) {
  if (rays == 0) {
    first_end = other.first_end;
    first_start = other.first_start;
  }
  rays += other.rays;
  ends.add(other.ends);
  starts.add(other.starts);
  for (std::size_t i = 0; i < lossy.size(); ++i)
    lossy[i] = lossy[i] || other.lossy[i];
  for (std::size_t i = 0; i < by_return.size(); ++i)
    by_return[i] += other.by_return[i];
}

LasSurvey survey_rays(const RayCloud& rays) {
  LasSurvey survey;
  survey.rays = rays.size();
  survey.ends = bounds_of(rays.ends);
  survey.starts = bounds_of(rays.starts);
  if (!std::all_of(rays.times.begin(), rays.times.end(), [](double time) { return std::isfinite(time); }))
    throw Error(ErrorCode::out_of_range, "a time that is not a finite number cannot be stored");
  if (!rays.empty()) {
    survey.first_end = rays.ends.front();
    survey.first_start = rays.starts.front();
  }
  survey_columns(rays, survey);
  return survey;
}

LasEncoder::LasEncoder(const LasContent& content, const std::vector<ColumnInfo>& columns,
                       const LasSurvey& survey, const LasGrid& ends, const LasGrid& starts)
    : content_(content), ends_(ends), starts_(starts), intensity_of_alpha_(content.alpha) {
  record_length_ = las_format_length(format());
  if (content.starts) {
    origin_at_ = add_extra("BeamOriginX", ScalarType::int32, &starts_[0]);
    add_extra("BeamOriginY", ScalarType::int32, &starts_[1]);
    add_extra("BeamOriginZ", ScalarType::int32, &starts_[2]);
    bounded_at_ = add_extra("Bounded", ScalarType::uint8);
  }
  if (content.alpha) alpha_at_ = add_extra("Alpha", ScalarType::uint8);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    Place place;
    place.field = las_field_of(columns[i]);
    if (place.field == LasField::intensity) intensity_of_alpha_ = false;
    const bool lossy = !place.field || survey.lossy[static_cast<std::size_t>(*place.field)];
    if (lossy) place.at = add_extra(extra_bytes_name(columns, i), columns[i].type);
    places_.push_back(place);
  }
  if (extra_bytes_record_.size() > 0xffff)
    throw Error(ErrorCode::out_of_range,
                "LAS can hold 341 extra columns, not " + std::to_string(extra_bytes_record_.size() / 192));
}

std::size_t LasEncoder::add_extra(const std::string& name, ScalarType type, const LasAxis* axis) {
  constexpr std::array<std::uint8_t, 10> kCodes{2, 1, 4, 3, 6, 5, 8, 7, 9, 10};  // in the order of ScalarType
  std::array<std::byte, 192> entry{};
  store(entry.data() + 2, kCodes[static_cast<std::size_t>(type)]);
  store(entry.data() + 3, static_cast<std::uint8_t>(axis == nullptr ? 0 : 8 | 16));
  std::memcpy(entry.data() + 4, name.data(), std::min<std::size_t>(name.size(), 32));
  if (axis != nullptr) {
    store(entry.data() + 112, axis->scale);
    store(entry.data() + 136, axis->offset);
  }
  extra_bytes_record_.insert(extra_bytes_record_.end(), entry.begin(), entry.end());
  const std::size_t at = record_length_;
  record_length_ += size_of(type);
  return at;
}

void LasEncoder::encode(const RayCloud& rays, std::vector<std::byte>& records) const {
  records.assign(rays.size() * record_length_, std::byte{0});
  encode_rays(rays, records.data());
  for (std::size_t i = 0; i < places_.size(); ++i)
    encode_column(rays.extras[i], places_[i], records.data());
}

/// Among points without `Bounded`, as in PLY, 0 says that a ray is unbounded.
std::uint8_t LasEncoder::alpha_of(const RayCloud& rays, std::size_t row) const {
  const std::uint8_t intensity = rays.colours[row].intensity;
  if (content_.starts) return intensity;
  return rays.bounded[row] == 0 ? std::uint8_t{0} : std::max<std::uint8_t>(intensity, 1);
}

void LasEncoder::encode_rays(const RayCloud& rays, std::byte* records) const {
  const std::size_t length = record_length_;
  put_points(rays.ends, ends_, length, records);
  // The standard has no return 0; a column may put another number here.
  put(rays, length, records + 14, [](std::size_t) { return std::uint8_t{0x11}; });
  put(rays, length, records + 22, [&](std::size_t row) { return rays.times[row]; });
  if (intensity_of_alpha_)
    put(rays, length, records + 12,
        [&](std::size_t row) { return static_cast<std::uint16_t>(257 * alpha_of(rays, row)); });
  if (content_.colours)
    put(rays, length, records + 30, [&](std::size_t row) {
      const Colour& colour = rays.colours[row];
      const auto wide = [](std::uint8_t value) { return static_cast<std::uint16_t>(257 * value); };
      return std::array{wide(colour.red), wide(colour.green), wide(colour.blue)};
    });
  if (content_.starts) {
    put_points(rays.starts, starts_, length, records + origin_at_);
    put(rays, length, records + bounded_at_, [&](std::size_t row) { return rays.bounded[row]; });
  }
  if (content_.alpha)
    put(rays, length, records + alpha_at_, [&](std::size_t row) { return alpha_of(rays, row); });
}

void LasEncoder::encode_column(const Column& column, const Place& place, std::byte* records) const {
  if (place.at != 0) {
    visit_scalar(column.type(), [&]<class T>() {
      put_values<T>(column, record_length_, records + place.at,
                    [](std::byte* at, T value) { store(at, value); });
    });
  }
  // Where the exact value is in the extra bytes, a rounded angle still serves programs that know only the
  // standard.
  const bool exact = place.at == 0;
  if (place.field && (exact || *place.field == LasField::scan_angle))
    encode_field(column, *place.field, records);
}

void LasEncoder::encode_field(const Column& column, LasField field, std::byte* records) const {
  const auto bytes_at = [&](std::size_t at) {
    put_values<std::uint8_t>(column, record_length_, records + at, store<std::uint8_t>);
  };
  const auto words_at = [&](std::size_t at) {
    put_values<std::uint16_t>(column, record_length_, records + at, store<std::uint16_t>);
  };
  const auto half_byte = [&](int shift) {
    put_values<std::uint8_t>(column, record_length_, records + 14, [&](std::byte* at, std::uint8_t value) {
      const unsigned kept = load<std::uint8_t>(at) & ~(15u << shift);
      store(at, static_cast<std::uint8_t>(kept | static_cast<unsigned>(value) << shift));
    });
  };
  switch (field) {
    case LasField::intensity:
      return words_at(12);
    case LasField::return_number:
      return half_byte(0);
    case LasField::number_of_returns:
      return half_byte(4);
    case LasField::flags:
      return bytes_at(15);
    case LasField::classification:
      return bytes_at(16);
    case LasField::user_data:
      return bytes_at(17);
    case LasField::point_source_id:
      return words_at(20);
    case LasField::scan_angle:
      return put_values<float>(column, record_length_, records + 18,
                               [](std::byte* at, float value) { store(at, stored_angle(value)); });
  }
}

}  // namespace ray
