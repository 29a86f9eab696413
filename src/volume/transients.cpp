#include "cloud_ellipsoids.h"
#include "contradicting_rays.h"
#include "count_rule.h"
#include "each_chunk.h"
#include "transience.h"
#include "transient_regions.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/stream_parts.h>
#include <raycloud/volume/free_space.h>
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

/// All that rays tell of the ellipsoids of their own cloud.
std::vector<Evidence> own_evidence(const Context& context, RaySource& source, const EllipsoidTree& tree,
                                   const TimeScale& scale, const CountRule& counting, bool one_episode) {
  std::vector<Evidence> evidence(tree.size());
  {
    HitTimes times(tree.size());
    each_chunk(context, source, [&](const RayCloud& rays) { times.add(tree, rays, scale); });
    constexpr double kLongest = 65536.0;  // ticks
    times.find_episodes(context, one_episode ? kLongest : scale.ticks(counting.look_time), evidence);
  }
  each_chunk(context, source,
             [&](const RayCloud& rays) { add_passes(tree, rays, counting, scale, evidence); });
  return evidence;
}

/// The scores of ends and, where the merge takes out rays that saw through something, of passes.
struct Scores {
  std::vector<float> ends;    ///< by slot; empty: none is taken out
  std::vector<float> passes;  ///< by slot; empty: none is taken out
  std::size_t first_run = 0;  ///< of the passes
  std::size_t last_run = Evidence::kRuns - 1;
};

std::vector<float> score_by(const Context& context, const EllipsoidTree& tree,
                            std::span<const Evidence> evidence, bool paper, const Contradiction& which) {
  if (!paper) return transient_regions(context, tree, evidence, which);
  std::vector<float> scores(evidence.size());
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const Transience transience = paper_transience(evidence[i]);
    scores[i] = std::max(which.before ? transience.before : 0.0F, which.after ? transience.after : 0.0F);
  }
  return scores;
}

Scores scores_of(const Context& context, const EllipsoidTree& tree, std::span<const Evidence> evidence,
                 const TransientRule& rule) {
  const auto by = [&](const Contradiction& which) {
    return score_by(context, tree, evidence, rule.paper, which);
  };
  Scores scores;
  switch (rule.merge) {
    case Merge::min:
      scores.ends = by({});
      return scores;
    case Merge::max:
      scores.passes = by({});
      return scores;
    case Merge::oldest:
      scores.ends = by({.between = false, .after = false});
      scores.passes = by({.before = false});
      scores.first_run = 1;
      break;
    case Merge::newest:
      scores.ends = by({.before = false, .between = false});
      scores.passes = by({.after = false});
      scores.last_run = Evidence::kRuns - 2;
      break;
  }
  // What is itself taken out contradicts nobody.
  for (std::size_t i = 0; i < scores.ends.size(); ++i)
    if (scores.ends[i] >= scores.passes[i]) scores.passes[i] = 0.0F;
  return scores;
}

/// Whether a run is longer than it may be by chance. Runs that are not prove nothing, whatever others do.
bool contradicts(const Evidence& evidence, std::size_t run, bool paper) {
  constexpr float kLongestByChance = 3.0F;
  return paper || static_cast<float>(evidence.passes[run]) * opacity_while_there(evidence) > kLongestByChance;
}

void colour_by_evidence(Colour& colour, float opacity, std::uint16_t passes, double transience) {
  constexpr int kManyPasses = 51;
  colour.red = static_cast<std::uint8_t>(5 * std::min<int>(passes, kManyPasses));
  colour.green = static_cast<std::uint8_t>(255.0F * opacity);
  colour.blue = static_cast<std::uint8_t>(255.0 * std::min(1.0, transience));
}

/// Fills the columns and shares out the rows, chunk by chunk, in order.
class TransientWriter {
 public:
  TransientWriter(const EllipsoidTree& tree, std::span<const Evidence> evidence, const Scores& scores,
                  const TransientRule& rule, std::vector<ColumnInfo> schema)
      : tree_(tree), evidence_(evidence), scores_(scores), rule_(rule), schema_(std::move(schema)) {}

  /// `of_passes`: the scores of the rays as passes; empty for none.
  void write(RayCloud& rays, std::span<const float> of_passes, std::vector<std::uint32_t>& fixed,
             std::vector<std::uint32_t>& transient) {
    for (const ColumnInfo& column : schema_)
      if (rays.extra(column.name) == nullptr) rays.extras.emplace_back(column, rays.size());
    const auto opacities = rays.extra("opacity")->values<float>();
    const auto hits = rays.extra("hits")->values<std::uint16_t>();
    const auto passes = rays.extra("passes")->values<std::uint16_t>();
    const auto transiences = rays.extra("transience")->values<float>();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      float transience = of_passes.empty() ? 0.0F : of_passes[i];
      opacities[i] = 0.0F;
      hits[i] = passes[i] = 0;
      if (rays.bounded[i] != 0) {
        const std::uint32_t slot = tree_.slot(next_++);
        opacities[i] = opacity_of(evidence_[slot]);
        hits[i] = evidence_[slot].hits;
        passes[i] = evidence_[slot].crossings;
        if (!scores_.ends.empty()) transience = std::max(transience, scores_.ends[slot]);
        if (rule_.colour)
          colour_by_evidence(rays.colours[i], opacities[i], passes[i],
                             static_cast<double>(transience) / rule_.rays);
      }
      transiences[i] = transience;
      (static_cast<double>(transience) > rule_.rays ? transient : fixed)
          .push_back(static_cast<std::uint32_t>(i));
    }
  }

 private:
  const EllipsoidTree& tree_;
  std::span<const Evidence> evidence_;
  const Scores& scores_;
  const TransientRule& rule_;
  std::vector<ColumnInfo> schema_;
  std::size_t next_ = 0;  ///< bounded ray
};

}  // namespace

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
  const CloudEllipsoids cloud = cloud_ellipsoids(context, source);
  const EllipsoidTree& tree = *cloud.tree;
  if (cloud.rays > 1 && tree.size() > 0 && !(cloud.first_time < cloud.last_time))
    throw Error(ErrorCode::no_data,
                "all rays have the same time: without an order in time nothing can be told to come or go");
  const TimeScale scale(cloud.first_time, cloud.last_time);
  const CountRule counting = count_rule(rule.paper, cloud.range_noise);
  const std::vector<Evidence> evidence = own_evidence(context, source, tree, scale, counting, rule.paper);
  const Scores scores = scores_of(context, tree, evidence, rule);

  TransientWriter writer(tree, evidence, scores, rule, transient_columns(source.info().extras));
  const auto score_pass = [&](std::uint32_t slot, double time) {
    const std::size_t run = evidence[slot].run_at(scale.tick(time));
    if (run == Evidence::kRuns) return 0.0F;
    const bool wanted = run >= scores.first_run && run <= scores.last_run;
    return wanted && contradicts(evidence[slot], run, rule.paper) ? scores.passes[slot] : 0.0F;
  };
  TransientCounts counts;
  counts.stream = stream_parts(
      context, source,
      [&](const RayCloud& rays, std::vector<StreamPart>& parts) {
        parts.resize(2);
        parts[0].sink = &fixed;
        parts[1].sink = &transient;
        for (StreamPart& part : parts) {
          part.of_chunk = true;
          part.rows.clear();
        }
        if (scores.passes.empty()) return std::vector<float>();
        return contradicting_rays(tree, rays, counting.guard, score_pass,
                                  [&](std::uint32_t slot) { return opacity_while_there(evidence[slot]); });
      },
      [&](RayCloud& rays, const std::vector<float>& of_passes, std::vector<StreamPart>& parts) {
        writer.write(rays, of_passes, parts[0].rows, parts[1].rows);
        counts.fixed += parts[0].size();
        counts.transient += parts[1].size();
      });
  return counts;
}

}  // namespace ray
