#include "cloud_ellipsoids.h"
#include "count_rule.h"
#include "judgement.h"
#include "read_ends.h"
#include "transient_regions.h"
#include "transients_in_blocks.h"
#include "write_judged.h"

#include <raycloud/core/error.h>
#include <raycloud/volume/transients.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ray {
namespace {

const std::array<ColumnInfo, 4> kTransientColumns{{{"opacity", ScalarType::float32},
                                                   {"hits", ScalarType::uint16},
                                                   {"passes", ScalarType::uint16},
                                                   {"transience", ScalarType::float32}}};

void colour_by_evidence(Colour& colour, float opacity, std::uint16_t passes, double transience) {
  constexpr int kManyPasses = 51;
  colour.red = static_cast<std::uint8_t>(5 * std::min<int>(passes, kManyPasses));
  colour.green = static_cast<std::uint8_t>(255.0F * opacity);
  colour.blue = static_cast<std::uint8_t>(255.0 * std::min(1.0, transience));
}

TransientCounts split_whole(const Context& context, RaySource& source, RaySink& fixed, RaySink& transient,
                            ReadEnds&& ends, JudgeRule rule) {
  EllipsoidMaker maker(context, std::move(ends.points));
  RangeNoise noise(ends.sample.bounded, ends.reach);
  noise.add(context, maker.points());
  rule.counting = count_rule(rule.transients.paper, noise.value());
  OwnHits own(context, maker.points(), end_ticks(context, source, rule.times), look_ticks(rule));
  const std::unique_ptr<EllipsoidTree> tree =
      EllipsoidMaker(std::move(maker)).make(context, ends.reach, noise.value(), &own);
  const std::vector<Evidence> evidence = count_evidence(context, own.take(), source, *tree, rule);
  const Sides sides = sides_of(rule.transients.merge);
  const auto scores_of = [&](const std::optional<Contradiction>& which) {
    return which ? transience_scores(context, *tree, evidence, *which, kWithinCloud, rule.transients.paper)
                 : std::vector<float>();
  };
  const std::vector<float> of_ends = scores_of(sides.ends);
  std::vector<float> of_passes = scores_of(sides.passes);
  spare_passes(of_ends, of_passes);
  std::optional<PassJudge> passes;
  if (sides.passes) passes.emplace(*tree, evidence, std::move(of_passes), rule);
  std::vector<JudgedEnd> judged;  // of a chunk
  std::size_t next = 0;
  return write_judged(
      context, source, fixed, transient, rule.transients,
      [&](const RayCloud& rays, const RawChunk&) {
        return passes ? passes->judge(rays) : std::vector<float>();
      },
      [&](const RayCloud& rays, const std::vector<float>& of_rays) {
        judged.clear();
        for (const std::uint8_t bounded : rays.bounded) {
          if (bounded == 0) continue;
          const std::uint32_t slot = tree->slot(next++);
          judged.push_back(judged_end(evidence[slot], of_ends.empty() ? 0.0F : of_ends[slot]));
        }
        return JudgedChunk{judged, of_rays};
      });
}

}  // namespace

void share_out(RayCloud& rays, const JudgedChunk& judged, const TransientRule& rule,
               const std::vector<ColumnInfo>& schema, std::vector<StreamPart>& parts) {
  for (const ColumnInfo& column : schema)
    if (rays.extra(column.name) == nullptr) rays.extras.emplace_back(column, rays.size());
  const auto opacities = rays.extra("opacity")->values<float>();
  const auto hits = rays.extra("hits")->values<std::uint16_t>();
  const auto passes = rays.extra("passes")->values<std::uint16_t>();
  const auto transiences = rays.extra("transience")->values<float>();
  for (std::size_t i = 0, next = 0; i < rays.size(); ++i) {
    const bool bounded = rays.bounded[i] != 0;
    const JudgedEnd end = bounded ? judged.ends[next++] : JudgedEnd{};
    opacities[i] = end.opacity;
    hits[i] = end.hits;
    passes[i] = end.passes;
    transiences[i] = std::max(end.transience, judged.passes.empty() ? 0.0F : judged.passes[i]);
    const double transience = static_cast<double>(transiences[i]);
    if (bounded && rule.colour)
      colour_by_evidence(rays.colours[i], end.opacity, end.passes, transience / rule.rays);
    parts[transience > rule.rays ? 1 : 0].rows.push_back(static_cast<std::uint32_t>(i));
  }
}

std::vector<ColumnInfo> transient_columns(std::vector<ColumnInfo> source) {
  for (const ColumnInfo& column : kTransientColumns) {
    const auto known = std::find_if(source.begin(), source.end(),
                                    [&](const ColumnInfo& other) { return other.name == column.name; });
    if (known == source.end())
      source.push_back(column);
    else if (known->type != column.type)
      throw Error(ErrorCode::wrong_content, "the column " + column.name + " is " +
                                                std::string(name_of(known->type)) + ", not " +
                                                std::string(name_of(column.type)));
  }
  return source;
}

TransientCounts split_transients(const Context& context, RaySource& source, RaySink& fixed,
                                 RaySink& transient, const TransientRule& rule) {
  if (!(rule.rays > 0.0) || !std::isfinite(rule.rays))
    throw Error(ErrorCode::usage, "the number of rays must be above 0");
  const std::size_t memory = memory_budget(context);
  ReadEnds ends = read_ends(context, source, memory / kJudgedPointBytes);
  if (ends.rays > 1 && ends.sample.bounded > 0 && !(ends.first_time < ends.last_time))
    throw Error(ErrorCode::no_data,
                "all rays have the same time: without an order in time nothing can be told to come or go");
  const JudgeRule judge{rule, TimeScale(ends.first_time, ends.last_time), {}};
  return ends.fits() ? split_whole(context, source, fixed, transient, std::move(ends), judge)
                     : split_in_blocks(context, source, fixed, transient, ends, judge);
}

}  // namespace ray
