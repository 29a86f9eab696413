#include "require.h"
#include "whole_rays.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/stream_parts.h>
#include <raycloud/filter/split.h>
#include <raycloud/filter/time_base.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace ray {
namespace {

/// Of all rays, looking at nothing but their times.
TimeSpan time_span(const Context& context, RaySource& source) {
  struct Item {
    RawChunk raw;
    std::vector<double> times;
    TimeSpan span;
  };
  std::vector<Item> items(pipeline_slots(context));
  TimeSpan all;
  const auto look = [&](std::size_t slot) {
    Item& item = items[slot];
    source.decode_times(item.raw, item.times);
    item.span = {};
    for (const double time : item.times)
      item.span.add(time);
  };
  const auto join = [&](std::size_t slot) {
    const Item& item = items[slot];
    if (!item.span.empty()) {
      all.add(item.span.first);
      all.add(item.span.last);
    }
    if (context.progress != nullptr) context.progress->advance(item.raw.rows);
  };
  using Mode = PipelineStage::Mode;
  if (context.progress != nullptr) context.progress->begin("times", source.info().ray_count.value_or(0));
  pipeline(context, items.size(), [&](std::size_t slot) { return source.fetch(items[slot].raw); },
           {{Mode::parallel, look}, {Mode::ordered, join}});
  if (context.progress != nullptr) context.progress->end();
  return all;
}

double squared_length(const Eigen::Vector3d& v, const char* message) {
  const double squared = v.squaredNorm();
  require(std::isnormal(squared), message);
  return squared;
}

class TestedChunks final : public SplitRule {
 public:
  explicit TestedChunks(RayTest test) : test_(std::move(test)) {}
  std::vector<ColumnInfo> columns(std::vector<ColumnInfo> source) const override { return source; }
  void apply(RayCloud& rays, std::vector<std::uint32_t>& inside,
             std::vector<std::uint32_t>& outside) const override {
    std::vector<std::uint8_t> mask(rays.size(), 0);
    test_(rays, mask);
    inside.clear();
    outside.clear();
    for (std::uint32_t i = 0; i < mask.size(); ++i)
      (mask[i] != 0 ? inside : outside).push_back(i);
  }

 private:
  RayTest test_;
};

}  // namespace

SplitRulePtr split_by_test(RayTest test) {
  return std::make_unique<TestedChunks>(std::move(test));
}

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
  const TimeSpan all = time_span(context, source);
  if (all.empty()) return {};
  // At 100 % the last ray is inside, whatever the rounding.
  return {fraction == 1.0 ? all.last : all.first + fraction * (all.last - all.first)};
}

SplitCounts split_cloud(const Context& context, RaySource& source, const SplitRule& rule, RaySink& inside,
                        RaySink& outside) {
  SplitCounts counts;
  counts.stream = stream_parts(
      context, source,
      [&](RayCloud& rays, std::vector<StreamPart>& parts) {
        parts.resize(2);
        parts[0].sink = &inside;
        parts[1].sink = &outside;
        parts[0].of_chunk = parts[1].of_chunk = true;
        rule.apply(rays, parts[0].rows, parts[1].rows);
        return Nothing{};
      },
      [&](Nothing, const std::vector<StreamPart>& parts) {
        counts.inside += parts[0].size();
        counts.outside += parts[1].size();
      });
  return counts;
}

}  // namespace ray
