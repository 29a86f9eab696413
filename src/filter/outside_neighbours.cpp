#include "outside_neighbours.h"

#include "surface_points.h"
#include "transparent_cubes.h"
#include "without_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ray {
namespace {

constexpr double kLeastSigma = 0.001;  // m: no lidar is truer
constexpr double kLineLike = 0.05;     // of the greatest variance: a second one below is noise too
constexpr double kAcrossRay = 0.85;    // most cosine between a line and the ray that ends on it
constexpr std::size_t kFewest = 4;     // neighbours that tell of a surface

/// The plane around a point, through point + height · normal, and how far its points are from it.
struct NoisyPlane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // zero: there is none
  float height = 0.0F;                               // m
  float variance = 0.0F;                             // m², of a point from the plane, unbiased
  float reach = 0.0F;                                // m, of its neighbours
  std::uint32_t points = 0;
  bool is_flat = false;  // or a line: something to stand in the way of rays, however thin
};

NoisyPlane noisy_plane(const PointTree& tree, std::size_t place, const Surfel& surfel) {
  constexpr double kFlat = 0.1;
  NoisyPlane plane;
  plane.points = surfel.count;
  plane.reach =
      std::nextafter(static_cast<float>(std::sqrt(surfel.reach2)), std::numeric_limits<float>::infinity());
  if (!surfel.is_surface() || surfel.count <= kFewest) return plane;
  plane.normal = surfel.normal.cast<float>();
  plane.height = static_cast<float>(surfel.normal.dot(surfel.centroid - tree.point(place)));
  const bool is_line = surfel.variances[1] < kLineLike * surfel.variances[2];
  // But not if it lies along the rays: that is how the ends of beams which met two surfaces lie.
  const Eigen::Vector3d ray = unpack_direction(tree.to_sensor(place));
  plane.is_flat = is_line ? std::abs(surfel.axis.dot(ray)) < kAcrossRay
                          : surfel.variances[0] < kFlat * surfel.variances[1] &&
                                surfel.normal.dot(ray) > 1.0 - kAcrossRay;
  const double count = surfel.count;
  plane.variance = static_cast<float>(surfel.variances[is_line ? 1 : 0] * count / (count - 3.0));
  return plane;
}

/// What one neighbour's plane says of a point: how far off it is, as a plane without it would see it, scaled
/// so that the noise of the plane itself does not count; and the variance without it.
struct Opinion {
  double residual;  // m
  double variance;  // m²
};

Opinion opinion_of(const NoisyPlane& plane, const Eigen::Vector3d& offset) {
  const double residual = plane.normal.cast<double>().dot(offset) - static_cast<double>(plane.height);
  const double count = plane.points;
  const double reach = plane.reach;
  const double distance2 = offset.squaredNorm();
  const bool includes_it = distance2 <= reach * reach;
  // Of an even disc of points, a coordinate has a quarter of the squared radius for a variance.
  const double lateral2 = std::max(distance2 - residual * residual, 0.0);
  const double leverage = (1.0 + 4.0 * lateral2 / (reach * reach)) / count;
  if (!includes_it) return {residual / std::sqrt(1.0 + leverage), plane.variance};
  const double rest = std::max(1.0 - leverage, 0.3);
  const double freedom = count - 3.0;
  const double variance = (freedom * plane.variance - residual * residual / rest) / (freedom - 1.0);
  return {residual / std::sqrt(rest), std::max(variance, 0.0)};
}

/// The exchanges that sort sixteen values whatever they are (Batcher 1968), without a branch.
constexpr auto sorting_network() {
  constexpr std::size_t kValues = kSurfaceNeighbours;
  std::array<std::array<std::uint8_t, 2>, 63> pairs{};
  std::size_t count = 0;
  for (std::size_t p = 1; p < kValues; p *= 2)
    for (std::size_t k = p; k > 0; k /= 2)
      for (std::size_t j = k % p; j + k < kValues; j += 2 * k)
        for (std::size_t i = j; i < j + k && i + k < kValues; ++i)
          if (i / (2 * p) == (i + k) / (2 * p))
            pairs[count++] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i + k)};
  return pairs;
}

using Values = std::array<double, kSurfaceNeighbours>;

/// Of the first `count`; the rest must be infinite.
double median(Values values, std::size_t count) {
  static constexpr auto kNetwork = sorting_network();
  for (const auto& [low, high] : kNetwork) {
    const double a = values[low], b = values[high];
    values[low] = std::min(a, b);
    values[high] = std::max(a, b);
  }
  return 0.5 * (values[(count - 1) / 2] + values[count / 2]);
}

/// Medians, so that neither one noisy neighbour nor the order of them matters.
bool is_outside(const PointTree& tree, std::span<const NoisyPlane> planes, std::size_t place,
                std::span<const Neighbour> neighbours, double sigmas) {
  // So many times as far from its nearest neighbour as those are from their sixteenth.
  constexpr double kLonely = 3.0;
  Values residuals, variances, reaches;
  for (Values* values : {&residuals, &variances, &reaches})
    values->fill(std::numeric_limits<double>::infinity());
  std::size_t count = 0;
  double nearest2 = std::numeric_limits<double>::infinity();
  for (const Neighbour& neighbour : neighbours) {
    const NoisyPlane& plane = planes[neighbour.place];
    nearest2 = std::min(nearest2, neighbour.distance2);
    if (plane.normal.isZero()) continue;
    const Opinion opinion = opinion_of(plane, tree.point(place) - tree.point(neighbour.place));
    residuals[count] = opinion.residual;
    variances[count] = opinion.variance;
    reaches[count++] = plane.reach;
  }
  if (count == 0) return false;
  const double nearest = std::sqrt(nearest2);
  const bool may_be_lonely = nearest > kLonely * *std::min_element(reaches.begin(), reaches.end());
  if (may_be_lonely && nearest > kLonely * median(reaches, count)) return true;
  // The median of variances from 13 degrees of freedom is 5 % below their mean.
  constexpr double kMedian = 0.95;
  const double sigma = std::max(std::sqrt(median(variances, count) / kMedian), kLeastSigma);
  return std::abs(median(residuals, count)) > sigmas * sigma;
}

/// How thin a surfel looks from the sensor: its least variance across the ray, as a part of the greatest.
double thinness(const Surfel& surfel, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d middle = surfel.axis.cross(surfel.normal);
  const auto seen = [&](const Eigen::Vector3d& direction) -> Eigen::Vector3d {
    return direction - direction.dot(ray) * ray;
  };
  const Eigen::Matrix3d covariance =
      surfel.variances[0] * seen(surfel.normal) * seen(surfel.normal).transpose() +
      surfel.variances[1] * seen(middle) * seen(middle).transpose() +
      surfel.variances[2] * seen(surfel.axis) * seen(surfel.axis).transpose();
  // Of the two eigenvalues across the ray: their sum, and their product.
  const double sum = covariance.trace();
  const double product = 0.5 * (sum * sum - covariance.squaredNorm());
  const double largest = 0.5 * (sum + std::sqrt(std::max(sum * sum - 4.0 * product, 0.0)));
  return largest > 0.0 ? (sum - largest) / largest : 1.0;
}

/// A wire has too few points for sixteen of them to look like one, and range noise may be as large as the
/// distance between them; but from the sensor they look like a line, and their ranges are alike.
bool is_on_wire(NeighbourSearch& search, std::size_t place, double reach) {
  constexpr double kThin = 0.02;
  constexpr double kLong = 0.3;
  constexpr double kWithin = 2.0;
  const Surfel surfel = surfel_at(search, place, {.neighbours = 6, .reach = reach, .by_side = false});
  const Eigen::Vector3d ray = unpack_direction(search.tree().to_sensor(place)).normalized();
  // Nor does the point alone make the line, far from all others.
  const double along = (search.tree().point(place) - surfel.centroid).dot(surfel.axis);
  if (along * along > kWithin * kWithin * surfel.variances[2]) return false;
  return surfel.variances[1] < kLong * surfel.variances[2] && std::abs(surfel.axis.dot(ray)) < kAcrossRay &&
         thinness(surfel, ray) < kThin;
}

/// Student's quantile for a normal one (Cornish and Fisher 1938): the variances of sixteen neighbours, who
/// share most of theirs, amount to some forty degrees of freedom.
double for_estimated_sigma(double sigmas) {
  constexpr double kFreedom = 40.0;
  return sigmas + (sigmas * sigmas * sigmas + sigmas) / (4.0 * kFreedom);
}

std::vector<std::uint8_t> outside_of_block(const Context& context, Block<SeenPoint>&& block, double reach,
                                           double sigmas, const TransparentCubes& transparent) {
  const PointTree tree(context, block.records);
  block.records = std::vector<SeenPoint>();
  std::vector<NoisyPlane> planes(tree.size());
  const auto neighbours_of_plane = [&](NeighbourSearch& search, std::size_t place) {
    const NoisyPlane& plane = planes[place];
    return plane.normal.isZero()
               ? search.nearest(place, kSurfaceNeighbours, plane.reach)
               : search.nearest_facing(place, kSurfaceNeighbours, plane.reach, plane.normal.cast<double>());
  };
  NeededPlaces(block, tree)
      .work_on(context, 1,
               [&](NeighbourSearch& search, std::size_t place) {
                 planes[place] = noisy_plane(
                     tree, place, surfel_at(search, place, {kSurfaceNeighbours, reach / 2.0, true}));
               },
               {.radius = [&](std::size_t place) { return static_cast<double>(planes[place].reach); },
                .neighbours = neighbours_of_plane});
  std::vector<std::uint8_t> noise(tree.size());
  const double most = for_estimated_sigma(sigmas);
  for_each_place(context, tree, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
    for (std::size_t place = begin; place < end; ++place) {
      const NoisyPlane& plane = planes[place];
      if (!block.is_own(tree.index(place))) continue;
      std::uint8_t& is_noise = noise[tree.index(place)];
      if (plane.points <= kFewest) {
        is_noise = std::isfinite(reach) ? 1 : 0;  // in a cloud of a few rays nobody can tell
        continue;
      }
      const auto neighbours = neighbours_of_plane(search, place);
      const bool outside = is_outside(tree, planes, place, neighbours, most);
      const bool in_passing = !plane.is_flat && transparent.has(tree.point(place));
      if (outside || in_passing) is_noise = is_on_wire(search, place, reach / 2.0) ? 0 : 1;
    }
  });
  return noise;
}

}  // namespace

Denoised outside_neighbours(const Context& context, RaySource& source, RaySink& sink, double sigmas) {
  const BlockNeeds needs{.bytes_per_record = 90,
                         .reach = [](const EndSample& sample) { return 2.0 * neighbour_reach(sample); }};
  const TransparentCubes transparent(context, source);
  const auto compute = [&](const Context& with, Block<SeenPoint>&& block, double reach) {
    return outside_of_block(with, std::move(block), reach, sigmas, transparent);
  };
  return {.counts = run_blocks<SeenPoint, std::uint8_t>(context, source, sink, needs, seen_point, compute,
                                                        without_noise)};
}

}  // namespace ray
