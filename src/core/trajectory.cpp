#include <raycloud/core/trajectory.h>

#include <algorithm>
#include <cassert>

namespace ray {
namespace {

using Times = std::vector<double>;

// The last node of [low, high) that is not later than `time`; precondition: node `low` is not.
std::size_t last_not_after(const Times& times, double time, std::size_t low, std::size_t high) {
  const auto begin = times.begin();
  const auto after = std::upper_bound(begin + static_cast<std::ptrdiff_t>(low),
                                      begin + static_cast<std::ptrdiff_t>(high), time);
  return static_cast<std::size_t>(after - begin) - 1;
}

// Gallops from the hint, so that nearly sorted queries cost O(1).
std::size_t node_before(const Times& times, double time, std::size_t hint) {
  std::size_t step = 1;
  if (times[hint] <= time) {
    std::size_t low = hint;
    while (low + step < times.size() && times[low + step] <= time) {
      low += step;
      step *= 2;
    }
    return last_not_after(times, time, low, std::min(low + step, times.size()));
  }
  std::size_t high = hint;
  while (high > step && times[high - step] > time) {
    high -= step;
    step *= 2;
  }
  return last_not_after(times, time, high > step ? high - step : 0, high);
}

}  // namespace

TrajectorySpot spot_at(const Trajectory& trajectory, double time, std::size_t hint) {
  const Times& times = trajectory.times;
  assert(!times.empty());
  if (time <= times.front()) return {0, 0.0};
  if (time >= times.back()) return {times.size() - 1, 0.0};
  const std::size_t node = node_before(times, time, std::min(hint, times.size() - 1));
  return {node, (time - times[node]) / (times[node + 1] - times[node])};
}

Eigen::Vector3d position_at(const Trajectory& trajectory, TrajectorySpot spot) {
  const Eigen::Vector3d& from = trajectory.positions[spot.node];
  if (spot.fraction == 0.0) return from;
  return from + spot.fraction * (trajectory.positions[spot.node + 1] - from);
}

Eigen::Quaterniond orientation_at(const Trajectory& trajectory, TrajectorySpot spot) {
  assert(trajectory.orientations.size() == trajectory.size());
  const Eigen::Quaterniond& from = trajectory.orientations[spot.node];
  if (spot.fraction == 0.0) return from;
  return from.slerp(spot.fraction, trajectory.orientations[spot.node + 1]);
}

double node_spacing(const Trajectory& trajectory) {
  if (trajectory.size() < 2) return 0.0;
  std::vector<double> gaps(trajectory.size() - 1);
  for (std::size_t i = 0; i < gaps.size(); ++i)
    gaps[i] = trajectory.times[i + 1] - trajectory.times[i];
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  return *middle;
}

}  // namespace ray
