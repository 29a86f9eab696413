// The search for the 16 nearest neighbours of every end, by itself.
//   bench_neighbours CLOUD.ply [THREADS]
// Prints one line: what building the tree takes, what searching takes, and both together.

#include <raycloud/exec/parallel.h>
#include <raycloud/exec/stream.h>
#include <raycloud/io/ray_cloud_file.h>
#include <raycloud/spatial/neighbour_search.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_neighbours CLOUD.ply [THREADS]\n");
    return 2;
  }
  constexpr std::size_t kPlaces = 4096;
  const ray::Context context{.threads = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 0};
  std::vector<ray::SeenPoint> points;
  const auto source = ray::open_ray_cloud(argv[1]);
  ray::stream(
      context, *source, nullptr, [](const ray::RayCloud&) { return ray::Nothing{}; },
      [&](const ray::RayCloud& rays, ray::Nothing) {
        for (std::size_t i = 0; i < rays.size(); ++i)
          if (rays.bounded[i] != 0) points.push_back({rays.ends[i], {}});
      });
  const double begun = now();
  const ray::PointTree tree(context, points);
  const double built = now();
  std::vector<std::size_t> found((tree.size() + kPlaces - 1) / kPlaces);
  ray::parallel_for(context, tree.size(), kPlaces, [&](std::size_t begin, std::size_t end) {
    ray::NeighbourSearch search(tree);
    for (std::size_t place = begin; place < end; ++place)
      found[begin / kPlaces] += search.nearest(place, 16, 1e9).size();
  });
  const double done = now();
  const auto count = static_cast<double>(points.size());
  std::printf("\n16 nearest of %.2f M ends: tree %.2f s, search %.2f s, together %.2f M/s (bar 1.3)\n",
              count / 1e6, built - begun, done - built, count / (done - begun) / 1e6);
  return found.empty() ? 1 : 0;
}
