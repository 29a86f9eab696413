#include "require.h"
#include "whole_rays.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/stream_parts.h>
#include <raycloud/filter/split.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ray {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double squared_length(const Eigen::Vector3d& v, const char* message) {
  const double squared = v.squaredNorm();
  require(std::isnormal(squared), message);
  return squared;
}

}  // namespace

SplitRulePtr split_by_range(Metres range) {
  require(std::isfinite(range.value) && range.value >= 0.0, "the range must be 0 or more");
  return whole_rays([squared = range.value * range.value](const RayCloud& rays, std::size_t i) {
    return (rays.ends[i] - rays.starts[i]).squaredNorm() <= squared;
  });
}

SplitRulePtr split_by_direction(const Eigen::Vector3d& v) {
  const double squared = squared_length(v, "the ray direction cannot be 0,0,0");
  return whole_rays([v, squared](const RayCloud& rays, std::size_t i) {
    return (rays.ends[i] - rays.starts[i]).normalized().dot(v) <= squared;
  });
}

SplitRulePtr split_by_time(Seconds last) {
  require(std::isfinite(last.value), "the time must be a number");
  return whole_rays(
      [last = last.value](const RayCloud& rays, std::size_t i) { return rays.times[i] <= last; });
}

SplitRulePtr split_by_alpha(double a) {
  require(a >= 0.0 && a <= 1.0, "alpha must be from 0 to 1");
  return whole_rays([most = static_cast<int>(std::floor(255.0 * a))](const RayCloud& rays, std::size_t i) {
    const int alpha = rays.bounded[i] != 0 ? std::max<int>(rays.colours[i].intensity, 1) : 0;
    return alpha <= most;
  });
}

SplitRulePtr split_by_colour(const Eigen::Vector3d& v) {
  const double squared =
      squared_length(v, "the colour cannot be 0,0,0: to split by black, split by the single colour");
  return whole_rays([v, squared](const RayCloud& rays, std::size_t i) {
    const Colour& colour = rays.colours[i];
    return Eigen::Vector3d(colour.red, colour.green, colour.blue).dot(v) <= 255.0 * squared;
  });
}

SplitRulePtr split_by_single_colour(const Colour& colour) {
  return whole_rays([colour](const RayCloud& rays, std::size_t i) {
    const Colour& own = rays.colours[i];
    return own.red == colour.red && own.green == colour.green && own.blue == colour.blue;
  });
}

Seconds time_at(const Context& context, RaySource& source, double fraction) {
  require(fraction >= 0.0 && fraction <= 1.0, "the share of the time must be from 0 to 100 %");
  using Span = std::pair<double, double>;
  Span all{kInfinity, -kInfinity};
  stream(
      context, source, nullptr,
      [](const RayCloud& rays) {
        const auto [first, last] = std::minmax_element(rays.times.begin(), rays.times.end());
        return rays.empty() ? Span{kInfinity, -kInfinity} : Span{*first, *last};
      },
      [&](const RayCloud&, const Span& span) {
        all = {std::min(all.first, span.first), std::max(all.second, span.second)};
      });
  if (all.first > all.second) return {};
  // At 100 % the last ray is inside, whatever the rounding.
  return {fraction == 1.0 ? all.second : all.first + fraction * (all.second - all.first)};
}

SplitCounts split_cloud(const Context& context, RaySource& source, const SplitRule& rule, RaySink& inside,
                        RaySink& outside) {
  SplitCounts counts;
  counts.stream = stream_parts(
      context, source,
      [&](const RayCloud& rays, std::vector<StreamPart>& parts) {
        parts.resize(2);
        parts[0].sink = &inside;
        parts[1].sink = &outside;
        rule.apply(rays, parts[0].rays, parts[1].rays);
        return Nothing{};
      },
      [&](Nothing, const std::vector<StreamPart>& parts) {
        counts.inside += parts[0].rays.size();
        counts.outside += parts[1].rays.size();
      });
  return counts;
}

}  // namespace ray
