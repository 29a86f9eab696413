#include "turn.h"

#include <raycloud/core/error.h>
#include <raycloud/synth/scanner.h>

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

// Per second. In the golden ratio to whole numbers, so that even a sparse scan looks into evenly spread
// directions.
constexpr double kSpin = 9.618033988749895;
constexpr double kLeanTurns = 0.3090169943749474;

constexpr double kFan = 0.125;                // turns: 45 degrees
constexpr double kLean = 75.0 / 360.0;        // turns
constexpr double kTripodCone = 30.0 / 360.0;  // turns
constexpr double kStill = 10.0;               // s, of spinning where the path has one node
constexpr int kMostBeams = 1024;

/// Turned about z.
Eigen::Vector3d about_z(const Eigen::Vector3d& v, const Eigen::Vector2d& angle) {
  return {angle.x() * v.x() - angle.y() * v.y(), angle.y() * v.x() + angle.x() * v.y(), v.z()};
}
Eigen::Vector3d about_x(const Eigen::Vector3d& v, const Eigen::Vector2d& angle) {
  return {v.x(), angle.x() * v.y() - angle.y() * v.z(), angle.y() * v.y() + angle.x() * v.z()};
}

/// The raster of a station with this many rays: columns from top to bottom, twice as many as rows for a whole
/// turn.
struct Raster {
  std::uint64_t rows = 1;
  std::uint64_t columns = 1;
};
Raster raster_of(std::uint64_t rays) {
  const double steps_per_turn = std::sqrt(static_cast<double>(rays) / (0.5 - kTripodCone));
  Raster raster;
  raster.rows = static_cast<std::uint64_t>(std::max(1.0, std::ceil(steps_per_turn * (0.5 - kTripodCone))));
  raster.columns = (rays + raster.rows - 1) / raster.rows;
  return raster;
}

}  // namespace

ScanPlan::ScanPlan(const SpinningScanner& scanner, const Trajectory& path, std::uint64_t count)
    : path_(path), count_(count) {
  if (scanner.beams < 1 || scanner.beams > kMostBeams)
    throw Error(ErrorCode::usage, "a scanner has 1 to 1024 beams, not " + std::to_string(scanner.beams));
  for (int beam = 0; beam < scanner.beams; ++beam)
    beams_.push_back(turned(kFan * ((beam + 0.5) / scanner.beams - 0.5)));
}

ScanPlan::ScanPlan(const StandingScanner&, const Trajectory& path, std::vector<Eigen::Vector3d> stations,
                   std::uint64_t count)
    : path_(path), count_(count), stations_(std::move(stations)) {}

double ScanPlan::time(std::uint64_t number) const {
  const double done = static_cast<double>(number) / static_cast<double>(count_);
  return path_.times.front() + done * (path_.times.back() - path_.times.front());
}

std::size_t ScanPlan::node(std::uint64_t number) const {
  return spot_at(path_, time(number)).node;
}

Shot ScanPlan::shot(std::uint64_t number, std::size_t hint) const {
  return beams_.empty() ? standing_shot(number) : spinning_shot(number, hint);
}

Shot ScanPlan::spinning_shot(std::uint64_t number, std::size_t hint) const {
  static const Eigen::Vector2d kLeaning = turned(kLean);
  Shot shot;
  shot.time = time(number);
  shot.origin = position_at(path_, spot_at(path_, shot.time, hint));
  const double duration = path_.times.back() - path_.times.front();
  const double elapsed = duration > 0.0
                             ? shot.time - path_.times.front()
                             : kStill * (static_cast<double>(number) / static_cast<double>(count_));
  const Eigen::Vector2d& elevation = beams_[number % beams_.size()];
  const Eigen::Vector3d beam(elevation.x(), 0.0, elevation.y());
  const Eigen::Vector3d spun = about_z(beam, turned(kSpin * elapsed));
  shot.direction = about_z(about_x(spun, kLeaning), turned(kLeanTurns * elapsed)).normalized();
  return shot;
}

Shot ScanPlan::standing_shot(std::uint64_t number) const {
  // The first stations take what does not divide evenly.
  const std::uint64_t stations = stations_.size();
  const std::uint64_t share = count_ / stations;
  const std::uint64_t longer = count_ % stations;
  const std::uint64_t in_longer = longer * (share + 1);
  const bool is_longer = number < in_longer;
  const std::uint64_t rays = share + (is_longer ? 1 : 0);
  const std::uint64_t station = is_longer ? number / rays : longer + (number - in_longer) / rays;
  const std::uint64_t within = is_longer ? number % rays : (number - in_longer) % rays;
  const Raster raster = raster_of(rays);
  const auto row = static_cast<double>(within % raster.rows);
  const auto column = static_cast<double>(within / raster.rows);
  const Eigen::Vector2d from_zenith =
      turned((row + 0.5) / static_cast<double>(raster.rows) * (0.5 - kTripodCone));
  const Eigen::Vector2d azimuth = turned((column + 0.5) / static_cast<double>(raster.columns));
  Shot shot;
  shot.time = time(number);
  shot.origin = stations_[station];
  shot.direction =
      Eigen::Vector3d(from_zenith.y() * azimuth.x(), from_zenith.y() * azimuth.y(), from_zenith.x())
          .normalized();
  return shot;
}

}  // namespace ray
