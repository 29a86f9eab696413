#pragma once
/// The bounded ends of two clouds: how far each is from the other cloud, and what area it stands for.

#include "read_ends.h"

#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/space_cuts.h>
#include <raycloud/exec/spilled_rows.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace ray {

/// 12 bytes.
struct EndMeasure {
  float distance =
      0.0F;           ///< m, to the nearest end of the other cloud; infinity above twice the distance asked
  float area = 0.0F;  ///< m², that it stands for: see compare_clouds
  std::uint8_t within = 0;  ///< 1: an end of the other cloud is within the distance, exactly
};

/// Most memory for an end of both clouds while they are measured.
inline constexpr std::size_t kMeasuredEndBytes = 90;

using TwoClouds = std::array<RaySource*, 2>;

/// All ends of two clouds, measured. In memory where both clouds' points are given and, with
/// kMeasuredEndBytes for each, fit context.memory; else in blocks of space, in temporary files, with the same
/// result.
class MeasuredEnds {
 public:
  /// Reads each cloud once and rewinds it if they do not fit. About 0.9 µs of one core an end.
  MeasuredEnds(const Context& context, const TwoClouds& clouds, std::array<ReadEnds, 2>&& ends,
               double distance);

  /// Whether all ends of a cloud are within the distance.
  [[nodiscard]] bool all_within(std::size_t cloud) const { return all_within_[cloud]; }
  /// Those of the bounded rays of a chunk, for the chunks of a cloud in order, once. Valid until the next
  /// call.
  [[nodiscard]] std::span<const EndMeasure> next(std::size_t cloud, const RayCloud& rays);

 private:
  void measure_in_blocks(const Context& context, const TwoClouds& clouds, const std::array<ReadEnds, 2>& ends,
                         double distance);

  std::array<bool, 2> all_within_{true, true};
  std::array<std::vector<EndMeasure>, 2> whole_;
  std::array<std::size_t, 2> next_{};
  std::unique_ptr<SpaceCuts> cuts_;  ///< none: all are in memory
  std::array<std::unique_ptr<SpilledRows<EndMeasure>>, 2> spilled_;
  std::vector<std::uint32_t> parts_;  ///< of a chunk
};

}  // namespace ray
