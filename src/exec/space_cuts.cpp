#include <raycloud/exec/space_cuts.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace ray {

SpaceCuts::SpaceCuts(std::vector<Eigen::Vector3d> sample, std::size_t parts)
    : cuts_(sample.empty() ? 1 : std::bit_ceil(std::max<std::size_t>(parts, 1))) {
  cut(1, sample);
}

void SpaceCuts::cut(std::size_t node, std::span<Eigen::Vector3d> sample) {
  if (node >= cuts_.size()) return;
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = low;
  if (!sample.empty()) low = high = sample.front();
  for (const Eigen::Vector3d& point : sample) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  if (low == high) {  // nothing to divide: what comes here goes to one part, and nothing is near the others
    cuts_[node].at = std::numeric_limits<double>::max();
    cut(2 * node, sample);
    cut(2 * node + 1, {});
    return;
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t middle = sample.size() / 2;
  std::nth_element(sample.begin(), sample.begin() + static_cast<std::ptrdiff_t>(middle), sample.end(),
                   [axis](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a[axis] < b[axis]; });
  cuts_[node] = {axis, sample[middle][axis]};
  cut(2 * node, sample.first(middle));
  cut(2 * node + 1, sample.subspan(middle));
}

Eigen::AlignedBox3d SpaceCuts::box_of(std::size_t part) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::AlignedBox3d box(Eigen::Vector3d::Constant(-kInfinity), Eigen::Vector3d::Constant(kInfinity));
  for (std::size_t node = cuts_.size() + part; node > 1; node /= 2) {
    const Cut& cut = cuts_[node / 2];
    double& side = node % 2 == 0 ? box.max()[cut.axis] : box.min()[cut.axis];
    side = node % 2 == 0 ? std::min(side, cut.at) : std::max(side, cut.at);
  }
  return box;
}

void SpaceCuts::parts_near(const Eigen::Vector3d& point, double reach,
                           std::vector<std::uint32_t>& found) const {
  found.clear();
  find_near(1, point, reach, found);
}

void SpaceCuts::find_near(std::size_t node, const Eigen::Vector3d& point, double reach,
                          std::vector<std::uint32_t>& found) const {
  if (node >= cuts_.size()) {
    found.push_back(static_cast<std::uint32_t>(node - cuts_.size()));
    return;
  }
  const double beyond = point[cuts_[node].axis] - cuts_[node].at;
  // Not a hair too near: the difference is rounded.
  const double margin = reach * (1.0 + 1e-12) + std::abs(cuts_[node].at) * 1e-15;
  if (beyond <= margin) find_near(2 * node, point, reach, found);
  if (beyond >= -margin) find_near(2 * node + 1, point, reach, found);
}

}  // namespace ray
