#include "cloud_conflicts.h"
#include "raise.h"
#include "same_rays.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/stream_parts.h>
#include <raycloud/volume/merge_clouds.h>

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

std::vector<std::string> names_of(const std::vector<ColumnInfo>& columns) {
  std::vector<std::string> names;
  for (const ColumnInfo& column : columns)
    names.push_back(column.name);
  return names;
}

class CloudMerger {
 public:
  CloudMerger(const Context& context, std::span<RaySource* const> clouds, const MergeRule& rule)
      : context_(context), clouds_(clouds), rule_(rule) {
    NumberedRays numbered(context, clouds, key_rule(clouds, names_of(clouds.front()->info().extras)));
    leaders_ = leaders_of(context, numbered);
    numbered_ = numbered.clouds();
    for (const NumberedCloud& cloud : numbered_)
      all_times_.add(cloud.times);
  }

  void find_conflicts() {
    const bool by_time = rule_.merge == CloudMerge::oldest || rule_.merge == CloudMerge::newest;
    if (by_time && all_times_.first == all_times_.last && clouds_with_own_rays() > 1)
      throw Error(ErrorCode::no_data,
                  "all rays of all clouds have the same time: nothing is older or newer than the rest");
    scores_.assign(leaders_.size(), 0.0F);
    const auto raise_all = [this](std::span<const std::uint32_t> numbers, std::span<const float> scores) {
      for (std::size_t i = 0; i < numbers.size(); ++i)
        if (scores[i] > 0.0F) raise(scores_[leaders_[numbers[i]]], scores[i]);
    };
    for (std::size_t own = 0; own < clouds_.size(); ++own) {
      const std::vector<bool> has = rays_of(own);
      ray::find_conflicts(context_,
                          {.clouds = numbered_,
                           .own = own,
                           .rule = rule_,
                           .is_shared = [&](std::uint32_t number) { return has[leaders_[number]]; }},
                          {.ends = raise_all, .passes = raise_all});
    }
  }

  MergeCounts write(RaySink& combined, RaySink* differences) const {
    MergeCounts counts;
    for (std::size_t cloud = 0; cloud < clouds_.size(); ++cloud)
      write_cloud(cloud, combined, differences, counts);
    return counts;
  }

 private:
  [[nodiscard]] std::uint64_t end_of(std::size_t cloud) const {
    return cloud + 1 < numbered_.size() ? numbered_[cloud + 1].first : leaders_.size();
  }

  /// By leaders: 1 for the rays that the cloud has.
  [[nodiscard]] std::vector<bool> rays_of(std::size_t cloud) const {
    std::vector<bool> has(leaders_.size());
    for (std::uint64_t i = numbered_[cloud].first; i < end_of(cloud); ++i)
      has[leaders_[i]] = true;
    return has;
  }

  /// How many have rays that no cloud before them has.
  [[nodiscard]] std::size_t clouds_with_own_rays() const {
    std::size_t count = 0;
    for (std::size_t cloud = 0; cloud < clouds_.size(); ++cloud) {
      bool any = false;
      for (std::uint64_t i = numbered_[cloud].first; i < end_of(cloud) && !any; ++i)
        any = leaders_[i] == i;
      count += any ? 1 : 0;
    }
    return count;
  }

  [[nodiscard]] bool gives_way(float score) const { return static_cast<double>(score) > rule_.rays; }

  void write_cloud(std::size_t cloud, RaySink& combined, RaySink* differences, MergeCounts& counts) const {
    const StreamCounts streamed = stream_parts(
        context_, *clouds_[cloud],
        [&](const RayCloud& rays, const RawChunk& raw, std::vector<StreamPart>& parts) {
          parts.resize(differences == nullptr ? 1 : 2);
          parts.front().sink = &combined;
          parts.back().sink = differences == nullptr ? &combined : differences;
          for (StreamPart& part : parts) {
            part.of_chunk = true;
            part.rows.clear();
          }
          const std::uint32_t first = numbered_[cloud].first_of(raw);
          std::uint64_t gone = 0;
          for (std::uint32_t row = 0; row < rays.size(); ++row) {
            if (leaders_[first + row] != first + row) continue;
            const bool stays = scores_.empty() || !gives_way(scores_[first + row]);
            gone += stays ? 0 : 1;
            if (stays)
              parts[0].rows.push_back(row);
            else if (differences != nullptr)
              parts[1].rows.push_back(row);
          }
          return gone;
        },
        [&](const RayCloud& rays, std::uint64_t gone, const std::vector<StreamPart>& parts) {
          counts.combined += parts[0].size();
          counts.differences += gone;
          counts.repeated += rays.size() - parts[0].size() - gone;
        });
    clouds_[cloud]->rewind();
    counts.stream.rays_in += streamed.rays_in;
    counts.stream.rays_out += streamed.rays_out;
    counts.stream.dropped += streamed.dropped;
  }

  const Context& context_;
  std::span<RaySource* const> clouds_;
  const MergeRule& rule_;
  std::vector<NumberedCloud> numbered_;
  std::vector<std::uint32_t> leaders_;
  TimeSpan all_times_;
  std::vector<float> scores_;  ///< by the numbers of leaders: the number of rays up to which it gives way
};

}  // namespace

MergeCounts merge_clouds(const Context& context, std::span<RaySource* const> clouds, RaySink& combined,
                         RaySink* differences, const MergeRule& rule) {
  if (!(rule.rays > 0.0) || !std::isfinite(rule.rays))
    throw Error(ErrorCode::usage, "the number of rays must be above 0");
  if (clouds.empty()) throw Error(ErrorCode::usage, "there is no cloud to merge");
  CloudMerger merger(context, clouds, rule);
  if (rule.merge != CloudMerge::all) merger.find_conflicts();
  return merger.write(combined, differences);
}

}  // namespace ray
