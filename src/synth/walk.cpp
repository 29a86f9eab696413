#include "walk.h"

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

// Distance along the way as time.
Trajectory by_distance(const std::vector<Eigen::Vector3d>& way) {
  Trajectory line;
  for (const Eigen::Vector3d& place : way) {
    const double step = line.empty() ? 0.0 : (place - line.positions.back()).norm();
    if (!line.empty() && step < 1e-9) continue;
    line.times.push_back(line.empty() ? 0.0 : line.times.back() + step);
    line.positions.push_back(place);
  }
  return line;
}

// Rotation about z that turns x to `heading`, from square roots alone.
Eigen::Quaterniond facing(const Eigen::Vector2d& heading) {
  const double cosine = std::clamp(heading.x(), -1.0, 1.0);
  const double half_cosine = std::sqrt((1 + cosine) / 2);
  const double half_sine = std::sqrt((1 - cosine) / 2);
  return {half_cosine, 0, 0, heading.y() < 0 ? -half_sine : half_sine};
}

}  // namespace

Trajectory walked(const std::vector<Eigen::Vector3d>& way, const Walk& walk) {
  constexpr double kTimeStep = 0.1;
  constexpr double kLook = 0.5;
  const Trajectory line = by_distance(way);
  const double length = line.times.back();
  const auto nodes = static_cast<std::size_t>(std::ceil(length / walk.speed / kTimeStep)) + 1;
  const auto at = [&](double distance) { return position_at(line, spot_at(line, distance)); };
  Trajectory path;
  Eigen::Vector2d heading = Eigen::Vector2d::UnitX();
  for (std::size_t i = 0; i < nodes; ++i) {
    const double distance = length * static_cast<double>(i) / static_cast<double>(nodes - 1);
    const Eigen::Vector2d ahead = (at(distance + kLook) - at(distance - kLook)).head<2>();
    if (ahead.norm() > 0.05) heading = ahead.normalized();
    path.times.push_back(distance / walk.speed);
    path.positions.push_back(at(distance) + walk.head * Eigen::Vector3d::UnitZ());
    path.orientations.push_back(facing(heading));
  }
  return path;
}

std::vector<Eigen::Vector3d> stations_along(const std::vector<Eigen::Vector3d>& way, std::size_t count,
                                            double height) {
  const Trajectory line = by_distance(way);
  std::vector<Eigen::Vector3d> stations;
  for (std::size_t i = 0; i < count; ++i) {
    const double distance = line.times.back() * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    stations.push_back(position_at(line, spot_at(line, distance)) + height * Eigen::Vector3d::UnitZ());
  }
  return stations;
}

}  // namespace ray
