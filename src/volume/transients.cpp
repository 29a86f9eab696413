#include "cloud_ellipsoids.h"
#include "transience.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/stream_parts.h>
#include <raycloud/volume/free_space.h>
#include <raycloud/volume/transients.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace ray {
namespace {

const std::array<ColumnInfo, 4> kTransientColumns{{{"opacity", ScalarType::float32},
                                                   {"hits", ScalarType::uint16},
                                                   {"passes", ScalarType::uint16},
                                                   {"transience", ScalarType::float32}}};

template <class Work>
void each_chunk(const Context& context, RaySource& source, const Work& work) {
  stream(
      context, source, nullptr,
      [&](const RayCloud& rays) {
        work(rays);
        return Nothing{};
      },
      [](const RayCloud&, Nothing) {});
  source.rewind();
}

/// All that is known of the place of one end.
struct Verdict {
  float opacity = 0.0F;
  std::uint16_t hits = 0;
  std::uint16_t passes = 0;
  float transience = 0.0F;
};

class Judge {
 public:
  Judge(const EllipsoidTree& tree, std::span<const Evidence> evidence, const TransientRule& rule)
      : tree_(tree), evidence_(evidence), rule_(rule) {}

  [[nodiscard]] Verdict verdict(const Eigen::Vector3d& end, std::vector<std::uint32_t>& slots,
                                std::vector<float>& scores) const {
    Verdict verdict;
    tree_.near_point(end, slots);
    scores.clear();
    std::vector<float> opacities;
    for (const std::uint32_t slot : slots) {
      const Ellipsoid e = tree_.at_slot(slot);
      if (!is_inside(e, end)) continue;
      const Transience t = rule_.paper ? paper_transience(evidence_[slot]) : transience_of(evidence_[slot]);
      scores.push_back(std::max(t.before, t.after));
      opacities.push_back(opacity_of(evidence_[slot]));
      verdict.hits = evidence_[slot].hits;
      verdict.passes = evidence_[slot].crossings;
    }
    if (scores.empty()) return verdict;
    const auto middle = scores.begin() + static_cast<std::ptrdiff_t>(scores.size() / 2);
    std::nth_element(scores.begin(), middle, scores.end());
    verdict.transience = *middle;
    std::nth_element(opacities.begin(), opacities.begin() + opacities.size() / 2, opacities.end());
    verdict.opacity = opacities[opacities.size() / 2];
    return verdict;
  }

 private:
  const EllipsoidTree& tree_;
  std::span<const Evidence> evidence_;
  const TransientRule& rule_;
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
  if (cloud.tree->size() > 1 && !(cloud.first_time < cloud.last_time))
    throw Error(ErrorCode::no_data,
                "all rays have the same time: what came or went is told by the order in time");
  const EllipsoidTree& tree = *cloud.tree;
  std::vector<Evidence> evidence(tree.size());
  CountRule counting;
  if (rule.paper) {
    counting.guard = kEveryPass;
  } else {
    counting.guard.beyond = counting.guard.depth = std::max(0.05, 3.0 * cloud.range_noise);
  }
  each_chunk(context, source, [&](const RayCloud& rays) { add_hits(tree, rays, evidence); });
  each_chunk(context, source, [&](const RayCloud& rays) { add_passes(tree, rays, counting, evidence); });
  const Judge judge(tree, evidence, rule);
  TransientCounts counts;
  const std::vector<ColumnInfo> schema = transient_columns(source.info().extras);
  counts.stream = stream_parts(
      context, source,
      [&](RayCloud& rays, std::vector<StreamPart>& parts) {
        parts.resize(2);
        parts[0].sink = &fixed;
        parts[1].sink = &transient;
        for (StreamPart& part : parts) {
          part.of_chunk = true;
          part.rows.clear();
        }
        for (const ColumnInfo& column : schema)
          if (rays.extra(column.name) == nullptr) rays.extras.emplace_back(column, rays.size());
        const auto opacity = rays.extra("opacity")->values<float>();
        const auto hits = rays.extra("hits")->values<std::uint16_t>();
        const auto passes = rays.extra("passes")->values<std::uint16_t>();
        const auto transience = rays.extra("transience")->values<float>();
        std::vector<std::uint32_t> slots;
        std::vector<float> scores;
        for (std::size_t i = 0; i < rays.size(); ++i) {
          const Verdict v = rays.bounded[i] != 0 ? judge.verdict(rays.ends[i], slots, scores) : Verdict{};
          opacity[i] = v.opacity;
          hits[i] = v.hits;
          passes[i] = v.passes;
          transience[i] = v.transience;
          parts[v.transience > static_cast<float>(rule.rays) ? 1 : 0].rows.push_back(
              static_cast<std::uint32_t>(i));
        }
        return Nothing{};
      },
      [&](Nothing, const std::vector<StreamPart>& parts) {
        counts.fixed += parts[0].size();
        counts.transient += parts[1].size();
      });
  return counts;
}

}  // namespace ray
