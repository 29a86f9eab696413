#include <raycloud/core/error.h>
#include <raycloud/filter/intensity.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace ray {
namespace {

bool is_integer(ScalarType type) {
  return type != ScalarType::float32 && type != ScalarType::float64;
}

// Calls `use(row, value)` for every row.
template <class Use>
void for_each_value(const Column& column, const Use& use) {
  visit_scalar(column.type(), [&]<class T>() {
    const std::span<const T> values = column.values<T>();
    for (std::size_t i = 0; i < values.size(); ++i)
      use(i, static_cast<double>(values[i]));
  });
}

void widen(IntensityRange& range, double value) {
  if (value < range.low) range.low = value;
  if (value > range.high) range.high = value;
}

double usual_maximum(ScalarType type, double highest) {
  if (type == ScalarType::uint8) return 255.0;
  if (!is_integer(type) && highest <= 1.0) return 1.0;
  for (const double usual : {255.0, 4095.0, 65535.0})
    if (highest <= usual) return usual;
  return highest;
}

std::string shortest(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

}  // namespace

void IntensityRange::add(const IntensityRange& other) {
  low = std::min(low, other.low);
  high = std::max(high, other.high);
}

std::string intensity_column(const CloudInfo& info) {
  for (const ColumnInfo& extra : info.extras) {
    std::string name = extra.name;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    if (name == "intensity" || name == "scalar_intensity") return extra.name;
  }
  return {};
}

IntensityScale intensity_scale(const CloudInfo& info, const IntensityRange& range,
                               std::optional<double> max_intensity) {
  using Rule = IntensityScale::Rule;
  if (max_intensity && !(*max_intensity >= 0.0 && std::isfinite(*max_intensity)))
    throw Error(ErrorCode::usage, "the maximum intensity must be 0 or more");
  IntensityScale scale{.column = intensity_column(info), .chosen_by_user = max_intensity.has_value()};
  if (max_intensity && *max_intensity == 0.0) {
    scale.rule = Rule::all_bounded;
    scale.reason = "all rays are bounded, as --max_intensity 0 asks";
    return scale;
  }
  if (info.present.intensity && !max_intensity) return {};
  if (scale.column.empty()) {
    scale.reason = info.present.intensity ? "" : "no intensity: all rays are bounded";
    return scale;
  }
  if (!(range.low < 0.0) && !(range.high > 0.0)) {
    scale.rule = Rule::all_bounded;
    scale.reason = "every intensity is 0, so there is none: all rays are bounded";
    return scale;
  }
  const auto column = std::find_if(info.extras.begin(), info.extras.end(),
                                   [&](const ColumnInfo& extra) { return extra.name == scale.column; });
  scale.rule = Rule::scaled;
  scale.zero_is_unbounded = !(range.low < 0.0);
  scale.maximum = max_intensity.value_or(usual_maximum(column->type, range.high));
  scale.reason =
      "intensity " + shortest(scale.maximum) + " becomes 255" +
      (scale.chosen_by_user ? "" : " (highest " + shortest(range.high) + "; --max_intensity sets another)");
  return scale;
}

IntensityRange intensity_range(const RayCloud& rays, const std::string& column) {
  IntensityRange range;
  if (const Column* values = rays.extra(column))
    for_each_value(*values, [&](std::size_t, double value) { widen(range, value); });
  return range;
}

IntensityRange apply_intensity(const IntensityScale& scale, RayCloud& rays) {
  using Rule = IntensityScale::Rule;
  if (scale.rule == Rule::all_bounded) {
    for (Colour& colour : rays.colours)
      colour.intensity = 255;
    std::fill(rays.bounded.begin(), rays.bounded.end(), std::uint8_t{1});
    return intensity_range(rays, scale.column);
  }
  const Column* values = scale.rule == Rule::scaled ? rays.extra(scale.column) : nullptr;
  IntensityRange range;
  if (values == nullptr) return range;
  for_each_value(*values, [&](std::size_t i, double value) {
    widen(range, value);
    const bool bounded = value != 0.0 || !scale.zero_is_unbounded;
    const double shade =
        value > 0.0 ? std::clamp(std::round(255.0 * value / scale.maximum), 1.0, 255.0) : 1.0;
    rays.bounded[i] = bounded ? 1 : 0;
    rays.colours[i].intensity = bounded ? static_cast<std::uint8_t>(shade) : std::uint8_t{0};
  });
  return range;
}

}  // namespace ray
