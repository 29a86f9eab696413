#pragma once
/// From rays to the point records of LAS 1.4.

#include "las_grid.h"

#include <raycloud/core/cloud_info.h>
#include <raycloud/core/ray_cloud.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ray {

/// The standard fields that a column of their name and type may live in.
enum class LasField {
  intensity,
  return_number,
  number_of_returns,
  classification,
  flags,
  scan_angle,
  user_data,
  point_source_id
};
inline constexpr std::size_t kLasFieldCount = 8;

[[nodiscard]] std::optional<LasField> las_field_of(const ColumnInfo& column);

/// What must be known of all rays before the first can be stored.
struct LasSurvey {
  std::uint64_t rays = 0;
  Bounds ends;
  Bounds starts;
  Eigen::Vector3d first_end = Eigen::Vector3d::Zero();
  Eigen::Vector3d first_start = Eigen::Vector3d::Zero();
  std::array<bool, kLasFieldCount> lossy{};   ///< a value of that column does not survive in its field
  std::array<std::uint64_t, 16> by_return{};  ///< points of each return number
  void add(const LasSurvey& other);
};

/// Throws Error(out_of_range) for a NaN or infinite coordinate or time.
[[nodiscard]] LasSurvey survey_rays(const RayCloud& rays);

/// Which columns a file has besides coordinates.
struct LasContent {
  bool starts = false;  ///< and `Bounded`
  bool colours = false;
  bool alpha = false;
};

/// Where everything is in a record. Fields of type uint8 to float64 follow the standard ones in this order:
/// the origin, Bounded, Alpha, then the columns that have no standard field.
class LasEncoder {
 public:
  LasEncoder(const LasContent& content, const std::vector<ColumnInfo>& columns, const LasSurvey& survey,
             const LasGrid& ends, const LasGrid& starts);

  [[nodiscard]] int format() const { return content_.colours ? 7 : 6; }
  [[nodiscard]] std::size_t record_length() const { return record_length_; }

  /// The entries of the extra bytes VLR, 192 bytes each.
  [[nodiscard]] const std::vector<std::byte>& extra_bytes_record() const { return extra_bytes_record_; }

  /// Replaces `records`. Precondition: the survey covered these rays.
  void encode(const RayCloud& rays, std::vector<std::byte>& records) const;

 private:
  struct Place {
    std::optional<LasField> field;
    std::size_t at = 0;  ///< 0: no extra bytes
  };

  std::size_t add_extra(const std::string& name, ScalarType type, const LasAxis* axis = nullptr);
  [[nodiscard]] std::uint8_t alpha_of(const RayCloud& rays, std::size_t row) const;
  void encode_rays(const RayCloud& rays, std::byte* records) const;
  void encode_column(const Column& column, const Place& place, std::byte* records) const;
  void encode_field(const Column& column, LasField field, std::byte* records) const;

  LasContent content_;
  LasGrid ends_;
  LasGrid starts_;
  std::size_t record_length_;
  std::size_t origin_at_ = 0;
  std::size_t bounded_at_ = 0;
  std::size_t alpha_at_ = 0;
  bool intensity_of_alpha_;
  std::vector<Place> places_;  ///< of the extra columns
  std::vector<std::byte> extra_bytes_record_;
};

}  // namespace ray
