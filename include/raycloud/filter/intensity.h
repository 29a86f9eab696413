#pragma once
/// Intensity at full width (an extra column) → the 8-bit intensity of a ray cloud and whether a ray is
/// bounded.

#include <raycloud/core/cloud_info.h>
#include <raycloud/core/ray_cloud.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace ray {

/// Lowest and highest value of an intensity column; empty until something is added.
struct IntensityRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(const IntensityRange& other);
};

/// How to go from a column to 8 bits: round(255 · i / maximum), at least 1 and at most 255 for a bounded ray.
struct IntensityScale {
  enum class Rule {
    keep,         ///< there is no column: what the source says stays
    all_bounded,  ///< every ray is a surface, with intensity 255
    scaled        ///< as above; 0 is an unbounded ray unless the column has negative values
  };
  Rule rule = Rule::keep;
  std::string column;
  double maximum = 255.0;
  bool zero_is_unbounded = true;
  bool chosen_by_user = false;
  std::string reason;  ///< one line for the user: what was chosen and why
};

/// The extra column that holds the intensity: "intensity", or that name in another spelling
/// ("scalar_Intensity"); empty if there is none.
[[nodiscard]] std::string intensity_column(const CloudInfo& info);

/// `max_intensity` as given (0: all rays bounded). Without it, a source that has the 8-bit intensity keeps
/// that; else the least of 1 (not for integers), 255, 4095, 65535 that is not below the highest value, else
/// that value; uint8 always has 255. All zeros mean that there is no intensity: all rays are bounded.
[[nodiscard]] IntensityScale intensity_scale(const CloudInfo& info, const IntensityRange& range,
                                             std::optional<double> max_intensity);

/// Sets the 8-bit intensities and `bounded`; the column itself is never changed. Returns the range met, so
/// that the caller can see whether a scale chosen from a sample holds for the whole. Thread-safe.
IntensityRange apply_intensity(const IntensityScale& scale, RayCloud& rays);

/// The values of that extra column in these rays.
[[nodiscard]] IntensityRange intensity_range(const RayCloud& rays, const std::string& column);

}  // namespace ray
