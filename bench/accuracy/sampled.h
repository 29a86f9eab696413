#pragma once
/// Clouds sampled from surfaces, with the truth beside each ray.

#include <raycloud/core/ray_cloud.h>
#include <raycloud/exec/random.h>
#include <raycloud/spatial/seen_point.h>

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

namespace bench {

/// Where a ray truly ends, and on what.
struct Truth {
  Eigen::Vector3d end = Eigen::Vector3d::Zero();  ///< m, without noise
  Eigen::Vector3d normal =
      Eigen::Vector3d::UnitZ();  ///< of the surface, outwards, which is where sensors are
  int part = 0;                  ///< of the scene, for its own use
  bool counted = true;           ///< false within kRim of where the surface stops, which a real one does not
};

constexpr double kRim = 0.2;  // m
constexpr int kSeeds = 5;     // pooled

struct Sampled {
  ray::RayCloud rays;
  std::vector<Truth> truth;  ///< one a ray
};

/// `at(u, v)` for u and v in [0, 1), uniform over the area.
struct Surface {
  std::function<Truth(double u, double v)> at;
  double area = 0.0;  ///< m²
};

/// A parallelogram; its normal is along `u` × `v`.
[[nodiscard]] Surface rectangle(const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
                                const Eigen::Vector3d& v, int part = 0);
/// Upright, around the z axis.
[[nodiscard]] Surface cylinder(double radius, double height);

struct Sampling {
  double spacing = 0.03;  ///< m; at random places, one for each square of this width
  double noise = 0.0;     ///< m, sigma along the ray
  std::uint64_t seed = 1;
};

/// Adds the points of a surface. Each is seen from one of the sensors, drawn at random, that its normal
/// faces.
void add_samples(Sampled& out, const Surface& surface, const std::vector<Eigen::Vector3d>& sensors,
                 const Sampling& sampling);

/// The bounded ends, by index.
[[nodiscard]] std::vector<ray::SeenPoint> seen_points(const ray::RayCloud& rays);

/// Mean 0, variance 1.
[[nodiscard]] double normal_number(const ray::RandomStream& random, std::uint64_t index);

/// The value that the share `fraction` does not exceed. Precondition: not empty.
[[nodiscard]] double quantile(std::vector<double> values, double fraction);
/// NaN of nothing, as is the mean.
[[nodiscard]] double root_mean_square(const std::vector<double>& values);
[[nodiscard]] double mean(const std::vector<double>& values);

}  // namespace bench
