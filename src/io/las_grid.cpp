#include "las_grid.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace ray {
namespace {

constexpr double kUsualScale = 0.0001;

/// The offset nearest to the middle that is a multiple of a metre, or of the scale, if 32 bits hold the rest.
std::optional<LasAxis> axis_of_scale(double scale, double min, double max) {
  const double middle = min + 0.5 * (max - min);
  for (const double unit : {1.0, scale}) {
    const LasAxis axis{scale, std::nearbyint(middle / unit) * unit};
    if (axis.holds(min, max)) return axis;
  }
  return std::nullopt;
}

std::optional<LasAxis> axis_through(double scale, double min, double max, double sample) {
  const double middle = min + 0.5 * (max - min);
  const LasAxis axis{scale, sample + scale * std::nearbyint((middle - sample) / scale)};
  return axis.holds(min, max) ? std::optional(axis) : std::nullopt;
}

LasAxis usual_axis(double scale, double min, double max) {
  // 1, 2, 5, 10 …: each is 2 or 2.5 times the one before.
  for (int exponent = static_cast<int>(std::floor(std::log10(scale)));; ++exponent) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      // A division by a power of ten gives the double nearest to the decimal number, a product need not.
      const double candidate =
          exponent < 0 ? digit / std::pow(10.0, -exponent) : digit * std::pow(10.0, exponent);
      if (candidate < scale) continue;
      if (const auto axis = axis_of_scale(candidate, min, max)) return *axis;
    }
  }
}

}  // namespace

bool LasAxis::on_grid(double value) const {
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * (std::abs(value) + std::abs(offset));
  return std::abs(steps(value) * scale + offset - value) <= std::max(1e-3 * scale, rounding);
}

bool LasAxis::holds(double min, double max) const {
  return steps(min) >= std::numeric_limits<std::int32_t>::min() &&
         steps(max) <= std::numeric_limits<std::int32_t>::max();
}

LasGrid choose_las_grid(const Bounds& bounds, double step, const Eigen::Vector3d& sample,
                        const OnGrid& all_on_grid) {
  LasGrid grid;
  if (bounds.empty()) return grid;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto index = static_cast<Eigen::Index>(axis);
    const double min = bounds.min[index];
    const double max = bounds.max[index];
    std::optional<LasAxis> chosen;
    if (step > 0.0) {
      chosen = axis_of_scale(step, min, max);
      if (chosen && !all_on_grid(axis, *chosen)) {
        chosen = axis_through(step, min, max, sample[index]);
        if (chosen && !all_on_grid(axis, *chosen)) chosen.reset();
      }
    }
    const double scale = step > 0.0 ? std::min(step, kUsualScale) : kUsualScale;
    if (!chosen) chosen = axis_of_scale(scale, min, max);
    grid[axis] = chosen ? *chosen : usual_axis(scale, min, max);
  }
  return grid;
}

}  // namespace ray
