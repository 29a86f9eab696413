#include "walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace ray::align {
namespace {

constexpr double kQuarter = std::numbers::pi / 2.0;

/// The difference of two angles modulo a quarter turn, within 45 degrees.
double quarter_difference(double a, double b) {
  return std::remainder(a - b, kQuarter);
}

/// A patch of a wall as its line sees it.
struct OnLine {
  double offset, along, area, count;
  int axis;
  bool to_positive;
};

std::vector<OnLine> turned_back(const std::vector<Upright>& patches, double angle) {
  constexpr double kAligned = 0.966;  // cosine of 15 degrees
  const double c = std::cos(angle), s = std::sin(angle);
  std::vector<OnLine> turned;
  turned.reserve(patches.size());
  for (const Upright& patch : patches) {
    const Eigen::Vector2d place(c * patch.place.x() + s * patch.place.y(),
                                c * patch.place.y() - s * patch.place.x());
    const Eigen::Vector2d normal(c * patch.normal.x() + s * patch.normal.y(),
                                 c * patch.normal.y() - s * patch.normal.x());
    const int axis = std::abs(normal.x()) > std::abs(normal.y()) ? 0 : 1;
    if (std::abs(normal[axis]) < kAligned) continue;
    turned.push_back({place[axis], place[1 - axis], patch.area, patch.count, axis, normal[axis] > 0.0});
  }
  return turned;
}

/// The offsets with more area within `reach` than their surroundings: the peaks of a histogram.
std::vector<WallLine> peaks_of(const std::vector<OnLine>& patches, int axis, bool to_positive, double reach) {
  constexpr double kBinsOfReach = 4.0;
  const double bin = reach / kBinsOfReach;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const OnLine& patch : patches)
    if (patch.axis == axis && patch.to_positive == to_positive)
      low = std::min(low, patch.offset), high = std::max(high, patch.offset);
  std::vector<WallLine> lines;
  if (!(low <= high)) return lines;
  constexpr int kAround = 4;
  const auto bins = static_cast<std::size_t>((high - low) / bin) + 1 + 2 * kAround;
  std::vector<double> areas(bins), sums(bins);
  for (const OnLine& patch : patches)
    if (patch.axis == axis && patch.to_positive == to_positive)
      areas[static_cast<std::size_t>((patch.offset - low) / bin) + kAround] += patch.area;
  for (std::size_t i = 1; i + 1 < bins; ++i)
    sums[i] = 0.5 * areas[i - 1] + areas[i] + 0.5 * areas[i + 1];
  for (std::size_t i = kAround; i + kAround < bins; ++i) {
    bool is_peak = sums[i] > 0.0;
    for (std::size_t k = i - kAround; k <= i + kAround && is_peak; ++k)
      is_peak = sums[k] < sums[i] || (sums[k] == sums[i] && k >= i);
    if (is_peak)
      lines.push_back({low + (static_cast<double>(i - kAround) + 0.5) * bin, sums[i], to_positive});
  }
  return lines;
}

/// Sums over the lines of an axis, for the normal equation of the turn.
struct LineSums {
  double information = 0.0, pull = 0.0, squares = 0.0, weights = 0.0, count = 0.0;
};

/// Moves the lines to where they leave the least squares; one step of Tukey's weights.
LineSums fit_lines(const std::vector<OnLine>& patches, std::vector<WallLine>& lines, int axis, double reach) {
  LineSums all;
  for (WallLine& line : lines) {
    double w = 0.0, wt = 0.0, wr = 0.0, wtt = 0.0, wtr = 0.0, wrr = 0.0, area = 0.0;
    for (const OnLine& patch : patches) {
      if (patch.axis != axis || patch.to_positive != line.to_positive) continue;
      const double off = patch.offset - line.offset;
      if (std::abs(off) >= reach) continue;
      const double u = off / reach, weight = patch.count * (1.0 - u * u) * (1.0 - u * u);
      // Turning by a small angle moves a patch by the distance along the line.
      const double t = axis == 0 ? -patch.along : patch.along;
      w += weight, wt += weight * t, wr += weight * off, wtt += weight * t * t, wtr += weight * t * off;
      wrr += weight * off * off;
      area += patch.area;
      all.count += 1.0;
    }
    line.area = area;
    if (!(w > 0.0)) continue;
    line.offset += wr / w;
    all.information += wtt - wt * wt / w;
    all.pull += wtr - wt * wr / w;
    all.squares += wrr - wr * wr / w;
    all.weights += w;
  }
  return all;
}

/// Lines that are worth it.
std::vector<WallLine> lines_of(const std::vector<OnLine>& patches, int axis, double reach) {
  constexpr double kLeastShare = 0.02;  // of the area of the strongest
  std::vector<WallLine> lines = peaks_of(patches, axis, false, reach);
  const std::vector<WallLine> others = peaks_of(patches, axis, true, reach);
  lines.insert(lines.end(), others.begin(), others.end());
  double most = 0.0;
  for (const WallLine& line : lines)
    most = std::max(most, line.area);
  std::erase_if(lines, [&](const WallLine& line) { return line.area < kLeastShare * most; });
  return lines;
}

}  // namespace

Upright upright_of(const Patch& patch) {
  return {patch.mean.head<2>(), patch.normal.head<2>().normalized(), patch.area(), patch.count};
}

Heading heading_of(const std::vector<Upright>& patches) {
  constexpr int kBins = 180;  // of half a degree
  constexpr double kBin = kQuarter / kBins;
  constexpr double kNear = 3.0 * std::numbers::pi / 180.0;
  std::array<double, kBins> areas{};
  std::vector<double> angles;
  angles.reserve(patches.size());
  double all = 0.0;
  for (const Upright& patch : patches) {
    angles.push_back(std::atan2(patch.normal.y(), patch.normal.x()));
    const double turn = quarter_difference(angles.back(), 0.0) + kQuarter / 2.0;
    areas[static_cast<std::size_t>(std::clamp(turn / kBin, 0.0, kBins - 1.0))] += patch.area;
    all += patch.area;
  }
  Heading heading;
  double most = 0.0;
  constexpr int kAround = 4;
  for (int i = 0; i < kBins; ++i) {
    double sum = 0.0;
    for (int k = -kAround; k <= kAround; ++k)
      sum += areas[static_cast<std::size_t>((i + k + kBins) % kBins)] * (kAround + 1 - std::abs(k));
    if (sum > most) most = sum, heading.angle = (i + 0.5) * kBin - kQuarter / 2.0;
  }
  for (double reach = 2.0 * kNear; reach > 0.2 * kNear; reach *= 0.7) {
    double weights = 0.0, pull = 0.0;
    heading.area = 0.0;
    for (std::size_t i = 0; i < patches.size(); ++i) {
      const double off = quarter_difference(angles[i], heading.angle);
      if (std::abs(off) < kNear) heading.area += patches[i].area;
      const double u = off / reach;
      if (std::abs(u) >= 1.0) continue;
      const double weight = patches[i].area * (1.0 - u * u) * (1.0 - u * u);
      weights += weight, pull += weight * off;
    }
    if (weights > 0.0) heading.angle += pull / weights;
  }
  heading.angle = quarter_difference(heading.angle, 0.0);
  heading.share = all > 0.0 ? heading.area / all : 0.0;
  return heading;
}

WallGrid fit_walls(const std::vector<Upright>& patches, double angle, double width) {
  constexpr double kEnough = 1e-7;  // rad
  WallGrid grid;
  grid.angle = angle;
  double reach = 0.5 * width;
  for (int round = 0; round < 4; ++round, reach = std::max(0.6 * reach, 0.15 * width)) {
    for (int step = 0; step < 4; ++step) {
      const std::vector<OnLine> turned = turned_back(patches, grid.angle);
      std::array<LineSums, 2> sums;
      for (int axis = 0; axis < 2; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        if (step == 0) grid.lines[at] = lines_of(turned, axis, reach);
        sums[at] = fit_lines(turned, grid.lines[at], axis, reach);
      }
      const double information = sums[0].information + sums[1].information;
      const double weights = sums[0].weights + sums[1].weights;
      if (!(information > 0.0)) return grid;
      const double turn = (sums[0].pull + sums[1].pull) / information;
      grid.angle += turn;
      grid.residual = std::sqrt((sums[0].squares + sums[1].squares) / weights);
      const double per_patch = weights / (sums[0].count + sums[1].count);
      grid.sigma = grid.residual * std::sqrt(per_patch / information);
      if (std::abs(turn) < kEnough) break;
    }
  }
  for (auto& lines : grid.lines)
    std::sort(lines.begin(), lines.end(),
              [](const WallLine& a, const WallLine& b) { return a.offset < b.offset; });
  return grid;
}

}  // namespace ray::align
