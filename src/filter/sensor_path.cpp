#include <raycloud/core/error.h>
#include <raycloud/exec/stream.h>
#include <raycloud/filter/sensor_path.h>

#include <algorithm>
#include <cmath>

namespace ray {

SensorPath::SensorPath(double spacing) : spacing_(spacing) {
  if (!(spacing > 0.0) || !std::isfinite(spacing))
    throw Error(ErrorCode::usage, "the time between trajectory nodes must be positive");
}

void SensorPath::add(const RayCloud& rays) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double time = rays.times[i];
    if (earliest_.empty() || time > last_.time) last_ = {time, rays.starts[i]};
    if (time >= known_begin_ && time < known_end_) continue;
    const double slot = std::floor(time / spacing_);
    const auto [node, added] = earliest_.try_emplace(slot, Node{time, rays.starts[i]});
    if (time < node->second.time) node->second = {time, rays.starts[i]};
    known_begin_ = node->second.time;
    // A rounded end could reach into the next slot, which must not be skipped.
    known_end_ = std::nextafter((slot + 1.0) * spacing_, known_begin_);
    while (known_end_ > known_begin_ && std::floor(known_end_ / spacing_) > slot)
      known_end_ = std::nextafter(known_end_, known_begin_);
  }
}

Trajectory SensorPath::trajectory() const {
  std::vector<Node> nodes;
  nodes.reserve(earliest_.size() + 1);
  for (const auto& [slot, node] : earliest_)
    nodes.push_back(node);
  std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return a.time < b.time; });
  if (!nodes.empty() && last_.time > nodes.back().time) nodes.push_back(last_);
  Trajectory path;
  for (const Node& node : nodes) {
    path.times.push_back(node.time);
    path.positions.push_back(node.position);
  }
  return path;
}

Metres sampling_error(const Context& context, RaySource& source, const Trajectory& trajectory) {
  double largest = 0.0;  // squared
  const auto of_chunk = [&](const RayCloud& rays) {
    double squared = 0.0;
    TrajectorySpot spot;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      spot = spot_at(trajectory, rays.times[i], spot.node);
      squared = std::max(squared, (rays.starts[i] - position_at(trajectory, spot)).squaredNorm());
    }
    return squared;
  };
  stream(context, source, nullptr, of_chunk,
         [&](RayCloud&, double squared) { largest = std::max(largest, squared); });
  return {std::sqrt(largest)};
}

}  // namespace ray
