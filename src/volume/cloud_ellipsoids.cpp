#include "cloud_ellipsoids.h"

#include <raycloud/exec/blocks.h>
#include <raycloud/exec/stream.h>
#include <raycloud/spatial/point_spacing.h>
#include <raycloud/spatial/surfel.h>

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

constexpr std::size_t kEllipsoidNeighbours = 16;

struct ReadEnds {
  std::vector<SeenPoint> points;
  double reach = std::numeric_limits<double>::infinity();  // m, of neighbours
};

/// Fills the times and the count of `cloud`.
ReadEnds read_ends(const Context& context, RaySource& source, CloudEllipsoids& cloud) {
  struct OfChunk {
    std::vector<SeenPoint> points;
    double first, last;
  };
  ReadEnds read;
  blocks::EndSampler sampler;
  if (source.info().ray_count) read.points.reserve(*source.info().ray_count);
  stream(
      context, source, nullptr,
      [](const RayCloud& rays) {
        OfChunk chunk;
        for (std::size_t i = 0; i < rays.size(); ++i)
          if (rays.bounded[i] != 0)
            chunk.points.push_back({rays.ends[i], pack_direction(rays.starts[i] - rays.ends[i])});
        const auto [first, last] = std::minmax_element(rays.times.begin(), rays.times.end());
        if (first != rays.times.end()) chunk.first = *first, chunk.last = *last;
        return chunk;
      },
      [&](const RayCloud& rays, const OfChunk& chunk) {
        read.points.insert(read.points.end(), chunk.points.begin(), chunk.points.end());
        sampler.add(rays, chunk.points.size());
        if (rays.empty()) return;
        cloud.rays += rays.size();
        cloud.first_time = std::min(cloud.first_time, chunk.first);
        cloud.last_time = std::max(cloud.last_time, chunk.last);
      });
  source.rewind();
  // As far as where there is a hundredth of the usual density.
  constexpr double kSpacings = 32.0;
  constexpr std::size_t kFew = 8;  // have no spacing
  const EndSample& sample = sampler.sample();
  if (sample.ends.size() >= kFew)
    read.reach = kSpacings * estimate_spacing(sample.ends, sample.bounded).value;
  return read;
}

/// The median scatter of points about flat surfaces, from every so many of them.
double range_noise_of(const Context& context, const PointTree& tree, const SurfelRule& rule) {
  constexpr double kUsual = 0.015;  // m, where nothing is flat
  constexpr double kLeast = 0.002, kMost = 0.1;
  constexpr double kFlat = 0.1;
  constexpr std::size_t kSample = 4096;
  const std::size_t stride = tree.size() / kSample + 1;
  std::vector<double> scatter(tree.size() / stride + 1, -1.0);
  parallel_for(context, tree.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    NeighbourSearch search(tree);
    for (std::size_t place = begin; place < end; ++place) {
      if (tree.index(place) % stride != 0) continue;
      const Surfel surfel = surfel_at(search, place, rule);
      if (surfel.count <= rule.neighbours / 2 || surfel.variances[0] > kFlat * surfel.variances[1]) continue;
      const double count = surfel.count;
      scatter[tree.index(place) / stride] = std::sqrt(surfel.variances[0] * count / (count - 3.0));
    }
  });
  std::erase_if(scatter, [](double value) { return value < 0.0; });
  if (scatter.empty()) return kUsual;
  const auto middle = scatter.begin() + static_cast<std::ptrdiff_t>(scatter.size() / 2);
  std::nth_element(scatter.begin(), middle, scatter.end());
  return std::clamp(*middle, kLeast, kMost);
}

}  // namespace

CloudEllipsoids cloud_ellipsoids(const Context& context, RaySource& source) {
  CloudEllipsoids cloud;
  ReadEnds ends = read_ends(context, source, cloud);
  cloud.tree = std::make_unique<EllipsoidTree>(context, ends.points.size(),
                                               [&](std::size_t i) { return ends.points[i].end; });
  const PointTree tree(context, ends.points);
  ends.points = std::vector<SeenPoint>();
  // Both sides of a thin wall together: what is between them is as solid, and it takes a third of the time.
  const SurfelRule rule{.neighbours = kEllipsoidNeighbours, .reach = ends.reach, .by_side = false};
  cloud.range_noise = range_noise_of(context, tree, rule);
  parallel_for(context, tree.size(), 4096, [&](std::size_t begin, std::size_t end) {
    NeighbourSearch search(tree);
    for (std::size_t place = begin; place < end; ++place)
      cloud.tree->set(tree.index(place),
                      ellipsoid_of(surfel_at(search, place, rule), tree.point(place),
                                   unpack_direction(tree.to_sensor(place)), cloud.range_noise));
  });
  cloud.tree->close(context);
  return cloud;
}

}  // namespace ray
