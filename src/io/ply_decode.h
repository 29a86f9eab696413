#pragma once
/// Rows of a PLY file to rays.

#include "ply_schema.h"

#include <raycloud/core/ray_cloud.h>

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace ray {

/// What to multiply a channel by to get 0…255.
struct PlyColourScale {
  double colour = 1.0;
  double alpha = 1.0;
};

/// Thread-safe.
class PlyDecoder {
 public:
  /// `big_endian` is that of the rows given to `decode`.
  PlyDecoder(PlySchema schema, PlyLayout layout, std::array<double, 3> origin, PlyColourScale scale);

  /// As RaySource::decode. Precondition: `rows.size()` is a multiple of the layout's row_bytes.
  std::size_t decode(std::span<const std::byte> rows, RayCloud& rays) const;
  /// As RaySource::decode_times.
  std::size_t decode_times(std::span<const std::byte> rows, std::vector<double>& times) const;

 private:
  void decode_columns(const std::byte* rows, std::size_t begin, std::size_t end, RayCloud& rays) const;
  void decode_extras(const std::byte* rows, std::size_t begin, std::size_t end, RayCloud& rays) const;

  PlySchema schema_;
  PlyLayout layout_;
  std::array<double, 3> origin_;
  PlyColourScale scale_;
  std::vector<ColumnInfo> extras_;
  bool standard_single_ = false;  ///< the layout this project writes
  bool standard_double_ = false;
};

/// The values of one field as doubles.
[[nodiscard]] std::vector<double> field_values(std::span<const std::byte> rows, const PlyLayout& layout,
                                               const PlyField& field);

}  // namespace ray
