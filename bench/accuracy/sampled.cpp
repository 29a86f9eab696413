#include "sampled.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

namespace bench {

Surface rectangle(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v,
                  int part) {
  const Eigen::Vector3d across = u.cross(v);
  const auto at = [=](double a, double b) {
    const double from_rim = std::min(std::min(a, 1.0 - a) * u.norm(), std::min(b, 1.0 - b) * v.norm());
    return Truth{corner + a * u + b * v, across.normalized(), part, from_rim >= kRim};
  };
  return {at, across.norm()};
}

Surface cylinder(double radius, double height) {
  const auto at = [=](double u, double v) {
    const double angle = 2.0 * std::numbers::pi * u;
    const Eigen::Vector3d normal(std::cos(angle), std::sin(angle), 0.0);
    return Truth{radius * normal + height * v * Eigen::Vector3d::UnitZ(), normal, 0,
                 std::min(v, 1.0 - v) * height >= kRim};
  };
  return {at, 2.0 * std::numbers::pi * radius * height};
}

void add_samples(Sampled& out, const Surface& surface, const std::vector<Eigen::Vector3d>& sensors,
                 const Sampling& sampling) {
  const std::size_t first = out.truth.size();
  const ray::RandomStream random(sampling.seed, "samples from " + std::to_string(first));
  const ray::RandomStream noise(sampling.seed, "noise from " + std::to_string(first));
  const auto count = static_cast<std::size_t>(surface.area / (sampling.spacing * sampling.spacing));
  out.rays.resize(first + count);
  for (std::size_t i = 0; i < count; ++i) {
    const Truth truth = surface.at(random.uniform(i, 0), random.uniform(i, 1));
    const Eigen::Vector3d* sensor = nullptr;
    for (std::uint64_t draw = 2; sensor == nullptr; ++draw) {
      const Eigen::Vector3d& drawn = sensors[random.below(sensors.size(), i, draw)];
      if (truth.normal.dot(drawn - truth.end) > 0.0) sensor = &drawn;
    }
    const std::size_t row = first + i;
    out.rays.starts[row] = *sensor;
    out.rays.ends[row] =
        truth.end + sampling.noise * normal_number(noise, i) * (truth.end - *sensor).normalized();
    out.rays.times[row] = 1e-5 * static_cast<double>(row);
    out.rays.bounded[row] = 1;
    out.truth.push_back(truth);
  }
}

std::vector<ray::SeenPoint> seen_points(const ray::RayCloud& rays) {
  std::vector<ray::SeenPoint> points;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (rays.bounded[i] != 0)
      points.push_back({rays.ends[i], ray::pack_direction(rays.starts[i] - rays.ends[i])});
  return points;
}

double normal_number(const ray::RandomStream& random, std::uint64_t index) {
  const double positive = 1.0 - random.uniform(index, 0);
  return std::sqrt(-2.0 * std::log(positive)) * std::cos(2.0 * std::numbers::pi * random.uniform(index, 1));
}

double quantile(std::vector<double> values, double fraction) {
  const auto rank = static_cast<std::size_t>(fraction * static_cast<double>(values.size()));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::min(rank, values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double root_mean_square(const std::vector<double>& values) {
  const double sum = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace bench
