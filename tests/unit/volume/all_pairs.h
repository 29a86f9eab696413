#pragma once
/// Rays and ellipsoids of all kinds, and how they meet, worked out for each pair by itself in long double.

#include <raycloud/core/ray_cloud.h>
#include <raycloud/exec/random.h>
#include <raycloud/volume/ellipsoid_tree.h>
#include <raycloud/volume/free_space.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <vector>

namespace ray::test {

inline constexpr double kFirstTime = -10.0, kLastTime = 20.0;  // s

struct Scene {
  std::vector<Ellipsoid> ellipsoids;
  RayCloud rays;
};

/// Ellipsoids of all sizes and shapes, some of them flat; rays of all lengths, some of which end in them.
inline Scene random_scene(std::uint64_t seed, std::size_t ellipsoids, std::size_t rays, double far) {
  const RandomStream random(seed, "free space");
  Scene scene;
  const Eigen::Vector3d middle(far, -far, 0.1 * far);
  const auto point = [&](std::uint64_t index, std::uint64_t draw, double extent) -> Eigen::Vector3d {
    return middle + extent * Eigen::Vector3d(random.uniform(index, draw) - 0.5,
                                             random.uniform(index, draw + 1) - 0.5,
                                             random.uniform(index, draw + 2) - 0.5);
  };
  for (std::size_t i = 0; i < ellipsoids; ++i) {
    Surfel surfel;
    surfel.count = 17;
    const Eigen::Vector3d centre = point(i, 0, 10.0);
    surfel.centroid = centre;
    surfel.normal = (point(i, 3, 1.0) - middle).normalized();
    surfel.axis = surfel.normal.unitOrthogonal();
    const double size = 0.03 * std::pow(20.0, random.uniform(i, 6));
    const double flat = random.below(2, i, 7) == 0 ? 1.0 : 0.03;
    surfel.variances = size * size * Eigen::Vector3d(0.4 * flat * flat, 0.5, 1.0);
    const Eigen::Vector3d own = centre + size * (point(i, 8, 2.0) - middle);
    scene.ellipsoids.push_back(ellipsoid_of(surfel, own, surfel.normal, 0.01));
  }
  scene.rays.resize(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    scene.rays.starts[i] = point(i, 20, 16.0);
    scene.rays.ends[i] = random.below(2, i, 23) == 0 && ellipsoids > 0
                             ? Eigen::Vector3d(scene.ellipsoids[random.below(ellipsoids, i, 24)].centre +
                                               0.02 * (point(i, 25, 1.0) - middle))
                             : point(i, 28, 16.0);
    if (random.below(50, i, 31) == 0) scene.rays.ends[i] = scene.rays.starts[i];
    if (random.below(20, i, 32) == 0) scene.rays.ends[i].x() = scene.rays.starts[i].x();
    scene.rays.times[i] =
        kFirstTime + 30.0 / 65536.0 * (0.5 + static_cast<double>(random.below(65536, i, 33)));
    scene.rays.bounded[i] = random.below(4, i, 34) == 0 ? 0 : 1;
  }
  return scene;
}

inline EllipsoidTree tree_of(const Context& context, const std::vector<Ellipsoid>& ellipsoids) {
  EllipsoidTree tree(context, ellipsoids.size(), [&](std::size_t i) { return ellipsoids[i].centre; });
  for (std::size_t i = 0; i < ellipsoids.size(); ++i)
    tree.set(i, ellipsoids[i]);
  tree.close(context);
  return tree;
}

/// In the frame in which the ellipsoid is the unit ball, by the roots of a quadratic in long double.
struct Ball {
  Eigen::Matrix<long double, 3, 3> to_ball;
  const Ellipsoid& ellipsoid;
  explicit Ball(const Ellipsoid& of)
      : to_ball(of.shape.cast<long double>().llt().matrixL().transpose()), ellipsoid(of) {}
  [[nodiscard]] Eigen::Matrix<long double, 3, 1> at(const Eigen::Vector3d& point) const {
    return to_ball * (point - ellipsoid.centre).cast<long double>();
  }
};

inline bool is_hit(const Ball& ball, const RayCloud& rays, std::size_t i) {
  return rays.bounded[i] != 0 && ball.at(rays.ends[i]).squaredNorm() <= 1.0L;
}

struct PlainCrossing {
  bool crosses = false;
  bool proves_empty = false;
};

inline PlainCrossing plain_crossing(const Ball& ball, const RayCloud& rays, std::size_t i,
                                    const PassGuard& guard) {
  const auto from = ball.at(rays.starts[i]), to = ball.at(rays.ends[i]);
  const auto way = to - from;
  const long double a = way.squaredNorm(), b = from.dot(way), c = from.squaredNorm() - 1.0L;
  if (!(a > 0.0L) || b * b - a * c < 0.0L) return {};
  const long double root = std::sqrt(b * b - a * c);
  const long double enters = (-b - root) / a, leaves = (-b + root) / a;
  if (enters <= 0.0L || leaves >= 1.0L) return {};
  const PlainCrossing doubtful{true, false};
  const double length = (rays.ends[i] - rays.starts[i]).norm();
  const double beyond = static_cast<double>(1.0L - leaves) * length;
  if ((root / std::sqrt(a)) * (root / std::sqrt(a)) < 1.0L - guard.most_miss2) return doubtful;
  if (rays.bounded[i] != 0 && beyond < guard.beyond) return doubtful;
  if (!ball.ellipsoid.normal.isZero()) {
    const double sine = std::abs(ball.ellipsoid.normal.dot(rays.ends[i] - rays.starts[i])) / length;
    if (sine < guard.least_sine || (rays.bounded[i] != 0 && beyond * sine < guard.depth)) return doubtful;
  }
  return {true, true};
}

}  // namespace ray::test
