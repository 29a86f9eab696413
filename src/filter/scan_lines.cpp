#include "scan_lines.h"

#include <raycloud/exec/parallel.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace ray {
namespace {

constexpr std::size_t kWidest = 160;    // records in which the next beam of a line is looked for
constexpr std::size_t kSampled = 4000;  // beams from which the step is learned
constexpr double kLargestStep = 0.05;   // rad; beams further apart are no line
constexpr double kSteps = 2.5;          // further than so many steps is not next to each other
constexpr double kSamePulse = 1e-6;     // rad; returns of one pulse

struct Next {
  std::uint32_t beam = ScanLines::kNone;
  double tangent = std::numeric_limits<double>::infinity();
};

/// The beam nearest in angle to beam i of the `window` records after it (way 1) or before it (way -1).
Next nearest_in_angle(const Beams& beams, std::size_t i, std::size_t window, int way) {
  const std::size_t there = way > 0 ? beams.size() - 1 - i : i;
  Next next;
  for (std::size_t k = 1; k <= std::min(window, there); ++k) {
    const std::size_t j = way > 0 ? i + k : i - k;
    if (!beams.rings.empty() && beams.rings[j] != beams.rings[i]) continue;
    const double tangent = tangent_between(beams.starts[i], beams.ends[i], beams.ends[j]);
    if (tangent > kSamePulse && tangent < next.tangent) next = {static_cast<std::uint32_t>(j), tangent};
  }
  return next;
}

/// The part of sorted values below which `fraction` of them are.
template <class T>
T quantile(std::vector<T>& values, double fraction) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
}

/// Whether the beams before and after are on opposite sides of beam i and about as far from it.
bool is_line(const Beams& beams, std::size_t i, const Next& before, const Next& after) {
  if (before.beam == ScanLines::kNone || after.beam == ScanLines::kNone) return false;
  const auto direction = [&](std::size_t beam) {
    return Eigen::Vector3d((beams.ends[beam] - beams.starts[i]).normalized());
  };
  const Eigen::Vector3d here = direction(i);
  const Eigen::Vector3d back = direction(before.beam) - here, forth = direction(after.beam) - here;
  const auto [shorter, longer] = std::minmax(before.tangent, after.tangent);
  return longer <= kSteps * shorter && back.dot(forth) < -0.5 * back.norm() * forth.norm();
}

/// Learns the step and the window from beams all over the cloud.
ScanLines learn_lines(const Beams& beams) {
  const std::size_t stride = std::max<std::size_t>(beams.size() / kSampled, 1);
  std::vector<double> tangents;
  std::vector<std::pair<Next, std::size_t>> nexts;
  std::size_t on_lines = 0;
  for (std::size_t i = 0; i < beams.size(); i += stride) {
    const Next next = nearest_in_angle(beams, i, kWidest, 1);
    if (next.beam == ScanLines::kNone) continue;
    if (is_line(beams, i, nearest_in_angle(beams, i, kWidest, -1), next)) ++on_lines;
    tangents.push_back(next.tangent);
    nexts.emplace_back(next, next.beam - i);
  }
  ScanLines lines;
  if (2 * on_lines < tangents.size() || on_lines == 0) return lines;
  lines.step = quantile(tangents, 0.5);
  std::vector<std::size_t> offsets;
  for (const auto& [next, offset] : nexts)
    if (next.tangent <= kSteps * lines.step) offsets.push_back(offset);
  lines.window = quantile(offsets, 0.95);
  lines.in_scan_order = lines.step <= kLargestStep;
  return lines;
}

}  // namespace

double tangent_between(const Eigen::Vector3d& start, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d to_a = a - start, to_b = b - start;
  const double along = to_a.dot(to_b);
  return along > 0.0 ? to_a.cross(to_b).norm() / along : std::numeric_limits<double>::infinity();
}

ScanLines find_scan_lines(const Context& context, const Beams& beams) {
  ScanLines lines = learn_lines(beams);
  if (!lines.in_scan_order) return lines;
  lines.before.resize(beams.size());
  lines.after.resize(beams.size());
  parallel_for(context, beams.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    const auto within = [&](const Next& next) {
      return next.tangent <= kSteps * lines.step ? next.beam : ScanLines::kNone;
    };
    for (std::size_t i = begin; i < end; ++i) {
      lines.before[i] = within(nearest_in_angle(beams, i, lines.window, -1));
      lines.after[i] = within(nearest_in_angle(beams, i, lines.window, 1));
    }
  });
  return lines;
}

}  // namespace ray
