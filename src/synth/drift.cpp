#include "turn.h"

#include <raycloud/core/trajectory.h>
#include <raycloud/exec/random.h>
#include <raycloud/synth/drift.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ray {
namespace {

constexpr double kStep = 0.25;         // s
constexpr double kYawPerMetre = 0.05;  // rad
constexpr double kTurn = 6.283185307179586;

/// A sum of slow waves that is 0 at 0; `done` runs from 0 to 1.
double wander(const RandomStream& random, std::uint64_t axis, double done) {
  constexpr std::array kWaves{0.4, 1.1, 2.7};
  double sum = 0.0;
  for (std::size_t k = 0; k < kWaves.size(); ++k) {
    const double phase = random.uniform(axis, k);
    sum += (turned(kWaves[k] * done + phase).y() - turned(phase).y()) / kWaves[k];
  }
  return sum;
}

}  // namespace

Drift make_drift(std::pair<double, double> times, double largest, std::uint64_t seed) {
  const RandomStream random(seed, "drift");
  const double duration = times.second - times.first;
  const auto steps = static_cast<std::size_t>(std::max(1.0, std::ceil(duration / kStep)));
  Drift drift;
  double most_offset = 0.0;
  double most_yaw = 0.0;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double done = static_cast<double>(i) / static_cast<double>(steps);
    drift.times.push_back(i == steps ? times.second : times.first + done * duration);
    drift.offsets.emplace_back(wander(random, 0, done), wander(random, 1, done),
                               0.3 * wander(random, 2, done));
    drift.yaws.push_back(wander(random, 3, done));
    most_offset = std::max(most_offset, drift.offsets.back().norm());
    most_yaw = std::max(most_yaw, std::abs(drift.yaws.back()));
  }
  for (Eigen::Vector3d& offset : drift.offsets)
    offset *= largest / most_offset;
  for (double& yaw : drift.yaws)
    yaw *= largest * kYawPerMetre / most_yaw;
  return drift;
}

Pose pose_error(const Drift& drift, double time, const Eigen::Vector3d& sensor) {
  const auto after = std::upper_bound(drift.times.begin(), drift.times.end(), time);
  const auto last = drift.times.size() - 1;
  const std::size_t next = std::min(static_cast<std::size_t>(after - drift.times.begin()), last);
  const std::size_t node = next > 0 ? next - 1 : 0;
  const double span = drift.times[next] - drift.times[node];
  const double fraction = span > 0.0 ? std::clamp((time - drift.times[node]) / span, 0.0, 1.0) : 0.0;
  const double yaw = (1.0 - fraction) * drift.yaws[node] + fraction * drift.yaws[next];
  const Eigen::Vector2d angle = turned(yaw / kTurn);
  Pose pose;
  pose.rotation << angle.x(), -angle.y(), 0.0, angle.y(), angle.x(), 0.0, 0.0, 0.0, 1.0;
  const Eigen::Vector3d offset = (1.0 - fraction) * drift.offsets[node] + fraction * drift.offsets[next];
  pose.translation = sensor + offset - pose.rotation * sensor;
  return pose;
}

}  // namespace ray
