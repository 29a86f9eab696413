#include "noisy_plane.h"

#include "surface_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ray {
namespace {

constexpr double kLeastSigma = 0.001;  // m: no lidar is truer
constexpr double kLineLike = 0.05;     // of the greatest variance: a second one below is noise too
constexpr double kAcrossRay = 0.85;    // most cosine between a line and the ray that ends on it

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

}  // namespace

NoisyPlane noisy_plane(const PointTree& tree, std::size_t place, const Surfel& surfel) {
  constexpr double kFlat = 0.1;
  NoisyPlane plane;
  plane.points = surfel.count;
  plane.reach =
      std::nextafter(static_cast<float>(std::sqrt(surfel.reach2)), std::numeric_limits<float>::infinity());
  if (!surfel.is_surface() || surfel.count <= kTooFew) return plane;
  plane.normal = surfel.normal.cast<float>();
  plane.height = static_cast<float>(surfel.normal.dot(surfel.centroid - tree.point(place)));
  plane.is_line = surfel.variances[1] < kLineLike * surfel.variances[2];
  // But not if it lies along the rays: that is how the ends of beams which met two surfaces lie.
  const Eigen::Vector3d ray = unpack_direction(tree.to_sensor(place));
  plane.is_flat = plane.is_line ? std::abs(surfel.axis.dot(ray)) < kAcrossRay
                                : surfel.variances[0] < kFlat * surfel.variances[1] &&
                                      surfel.normal.dot(ray) > 1.0 - kAcrossRay;
  constexpr double kAmid2 = 0.25;
  plane.is_amid = (surfel.centroid - tree.point(place)).squaredNorm() < kAmid2 * surfel.reach2;
  const double count = surfel.count;
  plane.variance = static_cast<float>(surfel.variances[plane.is_line ? 1 : 0] * count / (count - 3.0));
  return plane;
}

bool is_surely_inside(const NoisyPlane& plane, double sigmas, double beside) {
  constexpr double kSurely = 0.5;
  const bool is_alone = plane.reach > beside && !plane.is_flat;
  if (is_alone || !plane.is_amid || plane.points <= kSurfaceNeighbours) return false;
  const Opinion own = opinion_of(plane, Eigen::Vector3d::Zero());
  const double most = kSurely * sigmas;
  return own.residual * own.residual <= most * most * own.variance;
}

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

}  // namespace ray
