#pragma once
/// From the point records of LAS to rays.

#include "las_header.h"

#include <raycloud/core/cloud_info.h>
#include <raycloud/core/ray_cloud.h>

#include <array>
#include <optional>
#include <vector>

namespace ray {

/// Where the values of an extra column are in a point record, and how they become those of the column.
struct LasColumn {
  enum class Kind {
    copied,
    scaled,
    return_number,  ///< of formats 0–5, in 3 bits
    number_of_returns,
    classification,
    flags,
    scan_angle_rank,   ///< whole degrees
    return_number_14,  ///< of formats 6–10, in 4 bits
    number_of_returns_14,
    scan_angle  ///< 0.006 degrees
  };
  ColumnInfo info;
  Kind kind = Kind::copied;
  std::size_t at = 0;
  LasExtraField field;  ///< of a scaled one
};

/// The scan angle of LAS 1.4 in degrees; also what decides whether a column of degrees survives in that
/// field.
[[nodiscard]] inline float scan_angle_degrees(std::int16_t stored) {
  return static_cast<float>(stored * 0.006);
}

class LasDecoder {
 public:
  explicit LasDecoder(const LasHeader& header);

  /// Without ray_count, precision and what only the file as a whole tells.
  [[nodiscard]] const CloudInfo& info() const { return info_; }
  [[nodiscard]] bool has_colours() const { return colours_at_ != 0; }

  /// All bits that are set in any colour.
  [[nodiscard]] std::uint16_t colour_bits(std::span<const std::byte> records) const;

  /// Replaces `rays` and returns how many rows were left out; colours lose their low byte if `wide_colours`.
  std::size_t decode(std::span<const std::byte> records, bool wide_colours, RayCloud& rays) const;

 private:
  void decode_coordinates(std::span<const std::byte> records, RayCloud& rays) const;
  void decode_colours(std::span<const std::byte> records, bool wide_colours, RayCloud& rays) const;

  std::size_t record_length_;
  std::array<double, 3> scale_;
  std::array<double, 3> offset_;
  std::size_t times_at_ = 0;  ///< byte in the record, 0 where there are none; the same below
  std::size_t colours_at_ = 0;
  std::optional<std::array<LasExtraField, 3>> origins_;
  std::optional<LasExtraField> bounded_;
  std::optional<LasExtraField> alpha_;
  std::vector<LasColumn> columns_;
  CloudInfo info_;
};

}  // namespace ray
