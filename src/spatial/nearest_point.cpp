#include <raycloud/spatial/nearest_point.h>

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

double box_distance2(const Eigen::Vector3d& from, const std::array<std::array<double, 2>, 3>& min,
                     const std::array<std::array<double, 2>, 3>& max, std::size_t side) {
  const auto apart = [&](Eigen::Index axis) {
    const auto i = static_cast<std::size_t>(axis);
    return std::max({min[i][side] - from[axis], from[axis] - max[i][side], 0.0});
  };
  const double x = apart(0), y = apart(1), z = apart(2);
  return x * x + y * y + z * z;
}

}  // namespace

/// Lowers `nearest2` to the nearest of the points [first, first + count), if one is nearer.
void NearestPoint::scan(std::uint32_t first, std::uint32_t count, const Eigen::Vector3d& from,
                        double& nearest2) {
  for (std::uint32_t place = first; place < first + count; ++place) {
    const double x = tree_.x_[place] - from.x(), y = tree_.y_[place] - from.y(),
                 z = tree_.z_[place] - from.z();
    const double distance2 = x * x + y * y + z * z;
    if (distance2 < nearest2) {
      nearest2 = distance2;
      last_ = place;
    }
  }
}

double NearestPoint::distance2(const Eigen::Vector3d& from, double within2) {
  if (tree_.size() == 0) return PointTree::kInfinity;
  double nearest2 = std::nextafter(within2, PointTree::kInfinity);
  scan(last_, 1, from, nearest2);  // what was near the place before is near
  const std::vector<PointTree::Pair>& pairs = tree_.pairs_;
  open_[0] = {1, 0.0};
  for (std::size_t open = 1; open > 0;) {
    const auto [node, box2] = open_[--open];
    if (box2 >= nearest2) continue;
    const PointTree::Pair& pair = pairs[node / 2];
    const std::uint32_t parts = pair.parts[node % 2];
    if (parts == 0) {
      scan(pair.first[node % 2], pair.count[node % 2], from, nearest2);
      continue;
    }
    const PointTree::Pair& both = pairs[parts];
    const std::array<double, 2> apart{box_distance2(from, both.min, both.max, 0),
                                      box_distance2(from, both.min, both.max, 1)};
    const std::uint32_t nearer = apart[1] < apart[0] ? 1 : 0;
    open_[open++] = {2 * parts + 1 - nearer, apart[1 - nearer]};
    open_[open++] = {2 * parts + nearer, apart[nearer]};
  }
  return nearest2 <= within2 ? nearest2 : PointTree::kInfinity;
}

}  // namespace ray
