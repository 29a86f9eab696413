#include "move_in_place.h"

#include "cloud_to_cloud.h"

#include <raycloud/filter/transform.h>
#include <raycloud/io/ray_cloud_file.h>

namespace ray::tools {

void move_in_place(cli::Session& session, const std::filesystem::path& cloud, const Move& move) {
  if (move.pose.is_identity() && move.time_shift.value == 0.0) {
    (void)open_ray_cloud(cloud);  // what is not a ray cloud is refused here too
    session.note("a move by nothing: " + cloud.string() + " stays as it is");
    return;
  }
  run_cloud_to_cloud(session,
                     {.input = cloud,
                      .output = cloud,
                      .coordinate_step = 2.0 * move.tolerance.value,
                      .write = {.flush_to_disk = true}},
                     [&](RaySource& source, RaySink& sink) {
                       return transform_cloud(session.context(), source, sink, move.pose, move.time_shift);
                     });
}

}  // namespace ray::tools
