// What a point cloud knows: the same rays as if all had been seen from one side, so that no ray tells the
// sides of a wall apart. For the pictures of docs/algorithms/surfels.md, which tells how they are made.
//   from_one_side CLOUD.ply OUT.ply

#include <raycloud/exec/stream.h>
#include <raycloud/io/ray_cloud_file.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: from_one_side CLOUD.ply OUT.ply\n");
    return 2;
  }
  const auto source = ray::open_ray_cloud(argv[1]);
  const auto sink = ray::create_ray_cloud(argv[2], source->info());
  const Eigen::Vector3d to_sensor(30.0, 20.0, 10.0);
  ray::stream(
      {}, *source, sink.get(), [](const ray::RayCloud&) { return ray::Nothing{}; },
      [&](ray::RayCloud& rays, ray::Nothing) {
        for (std::size_t i = 0; i < rays.size(); ++i)
          rays.starts[i] = rays.ends[i] + to_sensor;
      });
  sink->finish();
  return 0;
}
