#include "move_in_place.h"

#include "cloud_to_cloud.h"

#include <raycloud/filter/transform.h>
#include <raycloud/io/ray_cloud_file.h>

namespace ray::tools {

void move_in_place(cli::Session& session, const std::filesystem::path& cloud, const Pose& pose,
                   Seconds time_shift) {
  if (pose.is_identity() && time_shift.value == 0.0) {
    (void)open_ray_cloud(cloud);  // what is not a ray cloud is refused here too
    session.note("a move by nothing: " + cloud.string() + " stays as it is");
    return;
  }
  constexpr double kCoordinateStep = 2e-5;  // m; half of it may be lost
  run_cloud_to_cloud(
      session,
      {.input = cloud, .output = cloud, .coordinate_step = kCoordinateStep, .write = {.flush_to_disk = true}},
      [&](RaySource& source, RaySink& sink) {
        return transform_cloud(session.context(), source, sink, pose, time_shift);
      });
}

}  // namespace ray::tools
