#include <raycloud/core/error.h>
#include <raycloud/filter/sensor_origin.h>

#include <algorithm>

namespace ray {
namespace {

constexpr double kGapSpacings = 10.0;

}  // namespace

void OriginCounts::add(const OriginCounts& other) {
  before += other.before;
  after += other.after;
  in_gaps += other.in_gaps;
  longest_gap = std::max(longest_gap, other.longest_gap);
}

OriginStep::OriginStep(SensorOrigin origin) : origin_(std::move(origin)) {
  const auto* moving = std::get_if<MovingSensor>(&origin_);
  if (moving == nullptr) return;
  if (moving->trajectory.empty()) throw Error(ErrorCode::no_data, "the trajectory has no nodes");
  if (moving->lever_arm && moving->trajectory.orientations.empty())
    throw Error(
        ErrorCode::wrong_content,
        "--traj_offset needs orientations, and the trajectory has none (or --traj_format does not name "
        "them: t,x,y,z,qw,qx,qy,qz)");
  spacing_ = node_spacing(moving->trajectory);
}

OriginCounts OriginStep::operator()(RayCloud& rays) const {
  if (const auto* moving = std::get_if<MovingSensor>(&origin_)) return follow(*moving, rays);
  if (const auto* fixed = std::get_if<FixedSensor>(&origin_))
    std::fill(rays.starts.begin(), rays.starts.end(), fixed->position);
  if (const auto* constant = std::get_if<ConstantRay>(&origin_))
    for (std::size_t i = 0; i < rays.size(); ++i)
      rays.starts[i] = rays.ends[i] - constant->start_to_end;
  return {};
}

OriginCounts OriginStep::follow(const MovingSensor& sensor, RayCloud& rays) const {
  const Trajectory& path = sensor.trajectory;
  OriginCounts counts;
  std::vector<std::uint8_t> kept(rays.size(), 1);
  TrajectorySpot spot;
  double from = 0.0;  // the segment of the last ray, which nearly always is that of the next
  double to = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double time = rays.times[i];
    const bool before = time < path.times.front() - spacing_;
    const bool after = time > path.times.back() + spacing_;
    counts.before += before ? 1 : 0;
    counts.after += after ? 1 : 0;
    if ((before || after) && !sensor.clamp) {
      kept[i] = 0;
      continue;
    }
    if (time >= from && time < to) {
      spot.fraction = (time - from) / (to - from);
    } else {
      spot = spot_at(path, time, spot.node);
      const bool inside = spot.node + 1 < path.size() && time >= path.times[spot.node];
      from = path.times[spot.node];
      to = inside ? path.times[spot.node + 1] : from;
    }
    rays.starts[i] = position_at(path, spot);
    if (sensor.lever_arm) rays.starts[i] += orientation_at(path, spot) * *sensor.lever_arm;
    if (spot.fraction > 0.0) {
      const double gap = to - from;
      if (gap > kGapSpacings * spacing_) {
        ++counts.in_gaps;
        counts.longest_gap = std::max(counts.longest_gap, gap);
      }
    }
  }
  if (std::find(kept.begin(), kept.end(), 0) != kept.end()) rays.select(kept);
  return counts;
}

}  // namespace ray
