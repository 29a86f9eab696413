// What a user of the installed library writes: makes a small ray cloud, saves it, opens it, reads it back.
#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/stream.h>
#include <raycloud/io/ray_cloud_file.h>
#include <raycloud/synth/simulate.h>

#include <algorithm>
#include <cstdio>

// A scan of a floor: the largest thing there is to link.
std::size_t rays_that_hit_a_floor() {
  ray::Scene scene;
  scene.objects.resize(1);
  scene.objects[0].mesh.vertices = {{-9.0, -9.0, 0.0}, {9.0, -9.0, 0.0}, {0.0, 9.0, 0.0}};
  scene.objects[0].mesh.faces = {{0, 1, 2}};
  scene.path.times = {0.0};
  scene.path.positions = {{0.0, 0.0, 1.0}};
  const auto scan = ray::simulate(scene, {.rays = 1000});
  const ray::RayCloud rays = ray::read_all({}, *scan);
  return static_cast<std::size_t>(std::count(rays.bounded.begin(), rays.bounded.end(), 1));
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  ray::RayCloud cloud;
  cloud.resize(3);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.starts[i] = {0.0, 0.0, 1.0};
    cloud.ends[i] = {1.0 + static_cast<double>(i), 2.0, 3.0};
    cloud.times[i] = static_cast<double>(i);
    cloud.bounded[i] = 1;
  }
  const ray::Context context;
  ray::MemorySource source(cloud);
  const auto sink = ray::create_ray_cloud(argv[1], source.info());
  ray::stream_each(context, source, *sink, [](ray::RayCloud&) {});
  sink->finish();
  const auto file = ray::open_ray_cloud(argv[1]);
  const ray::RayCloud back = ray::read_all(context, *file);
  const bool same = back.size() == cloud.size() && (back.ends[2] - cloud.ends[2]).norm() < 1e-4;
  std::printf("%zu rays read back, %s\n", back.size(), same ? "the same" : "NOT the same");
  return same && rays_that_hit_a_floor() > 0 ? 0 : 1;
}
