#pragma once
/// Points and what is known of the sensor → a ray cloud: the whole of `rayimport`, from stream to stream.
///
/// Streaming shape: two passes over the source (a sample of it, then all), more if the sample misled; memory
/// O(1) plus the trajectory. The result does not depend on threads or chunks.

#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/context.h>
#include <raycloud/filter/origin_audit.h>
#include <raycloud/filter/sensor_origin.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ray {

struct ImportOptions {
  SensorOrigin origin = OwnOrigins{};
  double time_scale = 1.0;              ///< > 0; time of a ray = time in the source · scale + offset
  double time_offset = 0.0;             ///< s
  std::optional<double> max_intensity;  ///< what becomes 255; 0: all rays bounded; empty: from type and range
  bool remove_start_position = false;   ///< move the cloud so that the sensor starts at 0,0,0
  std::string points_name = "points";   ///< what messages call the source
  std::string trajectory_name = "trajectory";  ///< and the trajectory
  std::string history;                         ///< line to add to the history of the cloud; empty: none
};

struct ImportReport {
  CloudInfo info;             ///< of the cloud written
  std::uint64_t rays_in = 0;  ///< valid points read
  std::uint64_t rays_out = 0;
  std::uint64_t invalid = 0;  ///< rows left out because of a NaN or infinite value
  OriginCounts origins;
  std::vector<std::string> notes;  ///< one line each: decisions (the intensity scale …) and what was left out
  OriginFindings audit;
};

/// Makes the sink for a cloud of this kind; called again after a restart, when the sink made before is gone.
using SinkMaker = std::function<std::unique_ptr<RaySink>(const CloudInfo&)>;

/// Before the first call of `make_sink` all that can be checked is: throws Error(wrong_content) if the clocks
/// of points and trajectory do not meet, if a trajectory is given for points without times, or if the source
/// should know its origins and does not; Error(no_data) if there is not one valid point, or none within the
/// trajectory. Calls `finish` on the last sink. Points without times get made-up ones (a microsecond apart,
/// in file order) and info.time_base "made_up".
///
/// Extra columns that the format of the source has in any case (info().formal_extras) and that are zero
/// throughout are left out. Precision is that of the source where that is double; else single, and double
/// from the start if PrecisionLoss stops the first try.
[[nodiscard]] ImportReport import_rays(const Context& context, RaySource& points,
                                       const ImportOptions& options, const SinkMaker& make_sink);

}  // namespace ray
