// The neighbour search by itself.
#include <raycloud/exec/parallel.h>
#include <raycloud/exec/stream.h>
#include <raycloud/io/ray_cloud_file.h>
#include <raycloud/spatial/point_tree.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  using namespace ray;
  const Context context{.threads = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 0};
  const auto now = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  std::vector<SeenPoint> points;
  {
    const auto source = open_ray_cloud(argv[1]);
    const RayCloud cloud = read_all(context, *source);
    for (std::size_t i = 0; i < cloud.size(); ++i)
      if (cloud.bounded[i] != 0)
        points.push_back({cloud.ends[i], pack_direction(cloud.starts[i] - cloud.ends[i])});
  }
  const double t0 = now();
  const PointTree tree(context, points);
  const double t1 = now();
  std::vector<double> sums((tree.size() + 1023) / 1024);
  parallel_for(context, tree.size(), 1024, [&](std::size_t begin, std::size_t end) {
    NeighbourSearch search(tree);
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      double most = 0;
      for (const Neighbour& n : search.nearest(i, 16, 1e9))
        most = std::max(most, n.distance2);
      sum += most;
    }
    sums[begin / 1024] = sum;
  });
  const double t2 = now();
  double sum = 0;
  for (double s : sums)
    sum += s;
  const double n = static_cast<double>(points.size());
  std::printf("%zu points: build %.3f s, search %.3f s, together %.2f M/s (mean d2 %g)\n", points.size(),
              t1 - t0, t2 - t1, n / (t2 - t0) / 1e6, sum / n);
}
