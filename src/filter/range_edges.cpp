#include "range_edges.h"

#include <raycloud/exec/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ray {
namespace {

constexpr double kSurfaceSlope =
    0.03;                              // by how much of itself a range changes from beam to beam on a surface
constexpr std::size_t kRecords = 160;  // before and after, in which beams of other lines are looked for
constexpr double kAcross = 0.7;        // cosine of the most by which they may lie aslant
constexpr double kFurthestLine = 0.08;  // tangent of the angle to a line beside
constexpr double kSlope = 0.5;          // by how much of itself a slope may change from beam to beam

/// Judges beams one by one, by the ranges that their neighbours have as seen from where they start.
class EdgeJudge {
 public:
  EdgeJudge(const Beams& beams, const ScanLines& lines, double distance)
      : beams_(beams), lines_(lines), distance_(distance) {}

  [[nodiscard]] bool mixed(std::size_t i) const {
    const std::uint32_t before = lines_.before[i], after = lines_.after[i];
    if (before == ScanLines::kNone || after == ScanLines::kNone) return false;
    const double range = range_of(i, i);
    const double range_before = range_of(i, before), range_after = range_of(i, after);
    if (std::abs(range - range_before) <= distance_ || std::abs(range - range_after) <= distance_)
      return false;
    const Eigen::Vector3d along = direction(i, after) - direction(i, before);
    const Eigen::Vector3d here = direction(i, i);
    if ((direction(i, before) - here).dot(direction(i, after) - here) >= 0.0) return false;  // a turn
    if (goes_on(i, before, lines_.before) || goes_on(i, after, lines_.after)) return false;
    if (!on_surface(before, lines_.before) || !on_surface(after, lines_.after)) return false;
    const auto [one, other] = beside_line(i, here, along);
    // What another line met too is a surface, however narrow on this one.
    if (std::abs(range - one) <= distance_ || std::abs(range - other) <= distance_) return false;
    const bool on_line = (range < range_before) != (range < range_after);
    return on_line || (range < one && range > other) || (range > one && range < other);
  }

 private:
  [[nodiscard]] double range_of(std::size_t from, std::size_t beam) const {
    return (beams_.ends[beam] - beams_.starts[from]).norm();
  }
  [[nodiscard]] Eigen::Vector3d direction(std::size_t from, std::size_t beam) const {
    return (beams_.ends[beam] - beams_.starts[from]).normalized();
  }

  /// Whether the range changes from the beam beside to beam i as it did from the one beside that. On a plane
  /// the inverse of the range is linear in the angle.
  [[nodiscard]] bool goes_on(std::size_t i, std::uint32_t beside,
                             const std::vector<std::uint32_t>& further) const {
    const std::uint32_t second = further[beside];
    if (second == ScanLines::kNone) return false;
    const double range = range_of(i, i), first_range = range_of(i, beside);
    const Eigen::Vector3d first = direction(i, beside);
    const double step = (direction(i, i) - first).norm(), step_before = (first - direction(i, second)).norm();
    const double change = 1.0 / range - 1.0 / first_range;
    const double expected = (1.0 / first_range - 1.0 / range_of(i, second)) * step / step_before;
    return std::abs(change - expected) <=
           std::max(kSlope * std::abs(expected), distance_ / (range * first_range));
  }

  /// Whether the beam and the next one away from the edge met one surface, as far as their ranges tell: where
  /// ranges jump from beam to beam, as in leaves, nothing is known of what is between.
  [[nodiscard]] bool on_surface(std::uint32_t beam, const std::vector<std::uint32_t>& further) const {
    const std::uint32_t second = further[beam];
    if (second == ScanLines::kNone) return false;
    const double range = range_of(beam, beam), change = std::abs(range_of(beam, second) - range);
    return change <= std::max(distance_, kSurfaceSlope * range);
  }

  /// The ranges of the nearest beams on either side of the line; NaN where there is none.
  [[nodiscard]] std::array<double, 2> beside_line(std::size_t i, const Eigen::Vector3d& here,
                                                  const Eigen::Vector3d& along) const {
    const Eigen::Vector3d across = here.cross(along).normalized();
    const double least = along.norm() / 4.0;  // half a step: less is on the line
    std::array<double, 2> nearest{kFurthestLine, kFurthestLine};
    std::array<double, 2> ranges{std::nan(""), std::nan("")};
    const std::size_t first = i - std::min(i, kRecords);
    const std::size_t last = std::min(i + kRecords, beams_.size() - 1);
    for (std::size_t j = first; j <= last; ++j) {
      const Eigen::Vector3d offset = direction(i, j) - here;
      const double up = offset.dot(across);
      const std::size_t side = up > 0.0 ? 1 : 0;
      const double angle = offset.norm();
      if (angle >= nearest[side] || std::abs(up) < std::max(kAcross * angle, least)) continue;
      nearest[side] = angle;
      ranges[side] = range_of(i, static_cast<std::uint32_t>(j));
    }
    return ranges;
  }

  const Beams& beams_;
  const ScanLines& lines_;
  double distance_;
};

}  // namespace

RangeEdges range_edges(const Context& context, const Beams& beams, double distance) {
  const ScanLines lines = find_scan_lines(context, beams);
  if (!lines.in_scan_order) {
    // Too few beams to tell are in order as well as not.
    return {mixed_in_space(context, beams, distance), beams.size() < 3};
  }
  RangeEdges edges{std::vector<std::uint8_t>(beams.size()), true};
  const EdgeJudge judge(beams, lines, distance);
  parallel_for(context, beams.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      edges.mixed[i] = judge.mixed(i) ? 1 : 0;
  });
  return edges;
}

}  // namespace ray
