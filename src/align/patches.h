#pragma once
/// The surfaces of a cloud as patches: the points in one cube that were seen from one side, by their mean and
/// covariance. What alignment works on; small where a cloud is large.

#include "survey.h"

#include <raycloud/spatial/key_table.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

namespace ray::align {

/// The moments of the points of a patch.
struct Gathered {
  std::uint64_t key = 0;  ///< the cube, and the side from which it was seen
  double count = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< m, from the origin
  /// m², sum over the points, about the mean: xx xy xz yy yz zz
  Eigen::Matrix<double, 6, 1> scatter = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Vector3f to_sensor = Eigen::Vector3f::Zero();
  Eigen::Vector3f sensor = Eigen::Vector3f::Zero();  ///< m, from the origin: that of the first ray
  Eigen::Vector3f seen = Eigen::Vector3f::Zero();    ///< m, from the origin: where that ray ended

  [[nodiscard]] Eigen::Matrix3d scatter_matrix() const {
    Eigen::Matrix3d matrix;
    matrix << scatter[0], scatter[1], scatter[2], scatter[1], scatter[3], scatter[4], scatter[2], scatter[4],
        scatter[5];
    return matrix;
  }
};

struct Segment {
  Eigen::Vector3f start, end;  ///< m, from the origin
};

struct Surfaces {
  Survey survey;
  double width = 0.0;              ///< m, of the cubes
  std::vector<Gathered> gathered;  ///< in the order of their keys
  std::vector<Segment> sky;        ///< an even sample of the unbounded rays
};

/// Reads the source once and rewinds it. Sums are those of integers, so that neither threads nor chunks nor
/// the order of the rays change a bit, as long as no patch has more than 4095 points: then the first ones
/// count. Memory: about 220 bytes a patch, of which 128 stay. Ends more than 2^19 widths from the origin are
/// left out.
[[nodiscard]] Surfaces gather_surfaces(const Context& context, RaySource& source, const Survey& survey,
                                       double width);

struct Patch {
  Eigen::Vector3d mean;       ///< m, from the origin
  Eigen::Vector3d normal;     ///< of unit length, towards the sensor
  Eigen::Vector3d along;      ///< of unit length, the direction of greatest extent
  Eigen::Vector3d variances;  ///< m², ascending
  double count = 0.0;         ///< of points
  /// m², of a flat one: points that fill a rectangle have the product of the standard deviations of its
  /// sides, each a √12th of the side.
  [[nodiscard]] double area() const { return 12.0 * std::sqrt(variances[1] * variances[2]); }
  [[nodiscard]] bool is_flat(double most = 0.1) const {
    return variances[0] < most * variances[1] && !is_thin();
  }
  [[nodiscard]] bool is_thin() const { return variances[1] < 0.05 * variances[2]; }
  [[nodiscard]] bool is_upright() const { return std::abs(normal.z()) < 0.35; }
  [[nodiscard]] bool is_level() const { return std::abs(normal.z()) > 0.9; }
};

/// Patches of one width, to be found by where they are.
class PatchLevel {
 public:
  /// Cubes `factor` (a power of two) times as wide as those of the surfaces; patches of fewer than
  /// `least_points` are left out.
  PatchLevel(const Context& context, const Surfaces& surfaces, int factor, double least_points);

  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] const std::vector<Patch>& patches() const { return patches_; }
  /// A flat patch of many points that is no thicker than noise makes it: no corner, no foliage.
  [[nodiscard]] bool is_clean(const Patch& patch) const {
    constexpr double kLeastPoints = 10.0, kThick = 2.5;
    return patch.count >= kLeastPoints && patch.is_flat() && patch.variances[0] < kThick * noise_;
  }

  /// Calls `visit(patch)` for all in the eight cubes nearest to a point, so at least for those within half a
  /// width.
  template <class Visit>
  void each_near(const Eigen::Vector3d& point, const Visit& visit) const {
    const Eigen::Array3d corner = (point.array() / width_ - 0.5).floor();
    if (!(corner.abs() < kMost).all()) return;
    const Eigen::Array<std::int64_t, 3, 1> low = corner.cast<std::int64_t>();
    for (std::int64_t i = 0; i < 8; ++i) {
      const Range* range = index_.find(key_of(low.x() + (i & 1), low.y() + (i >> 1 & 1), low.z() + (i >> 2)));
      if (range == nullptr) continue;
      for (std::uint32_t k = 0; k < range->count; ++k)
        visit(patches_[range->first + k]);
    }
  }

  /// Calls `visit(patch)` for all in a cube: cube i of an axis spans [i·width, (i+1)·width).
  template <class Visit>
  void each_in(const Eigen::Array<std::int64_t, 3, 1>& cube, const Visit& visit) const {
    if (!(cube.abs() < std::int64_t{1} << 19).all()) return;
    const Range* range = index_.find(key_of(cube.x(), cube.y(), cube.z()));
    for (std::uint32_t k = 0; range != nullptr && k < range->count; ++k)
      visit(patches_[range->first + k]);
  }

 private:
  static constexpr double kMost = 1 << 19;
  struct Range {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  /// Of a cube; one to one within kMost, with random-looking bits, and never 0.
  static std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z) {
    constexpr std::int64_t kHalf = std::int64_t{1} << 20;
    constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15U, kNeverZero = std::uint64_t{1} << 63;
    const auto bits = [](std::int64_t i) { return static_cast<std::uint64_t>(i + kHalf); };
    std::uint64_t key = kNeverZero | bits(z) << 42 | bits(y) << 21 | bits(x);
    key ^= key >> 32;
    key *= kGolden;
    return key ^ key >> 29;
  }

  double width_;
  double noise_ = 0.0;  // m², the usual variance of a flat surface across itself
  std::vector<Patch> patches_;
  KeyTable<Range> index_;
};

}  // namespace ray::align
