#include "peer_points.h"

#include <raycloud/exec/stream.h>
#include <raycloud/io/ray_cloud_file.h>
#include <raycloud/spatial/neighbour_search.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

namespace bench {

namespace {

/// The median distance of the 16th neighbour, of one point in a hundred.
double usual_radius(const std::vector<ray::SeenPoint>& points) {
  const ray::PointTree tree({}, points);
  ray::NeighbourSearch search(tree);
  std::vector<double> furthest;
  for (std::size_t place = 0; place < tree.size(); place += 100) {
    double most = 0.0;
    for (const ray::Neighbour& near : search.nearest(place, 16, std::numeric_limits<double>::infinity()))
      most = std::max(most, near.distance2);
    furthest.push_back(most);
  }
  const auto middle = furthest.begin() + static_cast<std::ptrdiff_t>(furthest.size() / 2);
  std::nth_element(furthest.begin(), middle, furthest.end());
  return std::sqrt(*middle);
}

}  // namespace

PeerPoints write_peer_points(const std::string& cloud, const std::string& points) {
  const auto source = ray::open_ray_cloud(cloud);
  const ray::RayCloud rays = ray::read_all({}, *source);
  std::vector<float> coordinates;
  std::vector<ray::SeenPoint> seen;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays.bounded[i] == 0) continue;
    seen.push_back({rays.ends[i], {}});
    for (const double coordinate : rays.ends[i])
      coordinates.push_back(static_cast<float>(coordinate));
  }
  std::FILE* file = std::fopen(points.c_str(), "wb");
  if (file == nullptr || seen.empty()) {
    std::fprintf(stderr, "failed: the points of %s to %s\n", cloud.c_str(), points.c_str());
    std::exit(1);
  }
  std::fprintf(file,
               "ply\nformat binary_little_endian 1.0\nelement vertex %zu\n"
               "property float x\nproperty float y\nproperty float z\nend_header\n",
               seen.size());
  std::fwrite(coordinates.data(), sizeof(float), coordinates.size(), file);
  std::fclose(file);
  return {seen.size(), usual_radius(seen)};
}

}  // namespace bench
