// Makes a large ray cloud for benchmarks by laying copies of a real one side by side, as a scanner would that
// drove the same street again and again: copies overlap, and times go on. So the more copies, the denser is
// the cloud, and rays of one copy go through the surfaces of others; copies that are as far apart as they are
// wide do neither.
//   tile_cloud CLOUD.ply RAYS OUT.ply [METRES APART]

#include <raycloud/exec/stream.h>
#include <raycloud/io/ray_cloud_file.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

int main(int argc, char** argv) {
  if (argc != 4 && argc != 5) {
    std::fprintf(stderr, "usage: tile_cloud CLOUD.ply RAYS OUT.ply [METRES APART]\n");
    return 2;
  }
  const auto wanted = static_cast<std::size_t>(std::strtoull(argv[2], nullptr, 10));
  const auto source = ray::open_ray_cloud(argv[1]);
  ray::RayCloud cloud = ray::read_all({}, *source);
  cloud.extras.clear();  // the native row of 36 bytes
  const auto [first, last] = std::minmax_element(cloud.times.begin(), cloud.times.end());
  const double period = *last - *first + 0.01;
  const std::size_t copies = (wanted + cloud.size() - 1) / cloud.size();
  std::size_t side = 1;
  while (side * side < copies)
    ++side;

  ray::CloudInfo info = source->info();
  info.extras.clear();
  info.ray_count = wanted;
  const auto sink = ray::create_ray_cloud(argv[3], info);
  constexpr std::size_t kChunk = 32768;
  constexpr double kOverlapping = 30.0;  // m; less than the scan's reach
  const double apart = argc > 4 ? std::strtod(argv[4], nullptr) : kOverlapping;
  ray::RawChunk raw;
  for (std::size_t done = 0, copy = 0; done < wanted; ++copy) {
    const auto middle = static_cast<double>(side - 1) / 2.0;
    const Eigen::Vector3d offset(apart * (static_cast<double>(copy % side) - middle),
                                 apart * (static_cast<double>(copy / side) - middle), 0.0);
    ray::RayCloud tile = cloud;
    tile.transform(ray::translation_pose(offset));
    for (double& time : tile.times)
      time += period * static_cast<double>(copy);
    for (std::size_t row = 0; row < tile.size() && done < wanted; row += kChunk) {
      const std::size_t rows = std::min({kChunk, tile.size() - row, wanted - done});
      std::vector<std::uint8_t> mask(tile.size());
      std::fill_n(mask.begin() + static_cast<std::ptrdiff_t>(row), rows, std::uint8_t{1});
      ray::RayCloud chunk = tile;
      chunk.select(mask);
      sink->encode(chunk, raw);
      sink->write(raw);
      done += rows;
    }
  }
  sink->finish();
  return 0;
}
