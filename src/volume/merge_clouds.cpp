#include "cloud_conflicts.h"
#include "cloud_ellipsoids.h"
#include "contradicting_rays.h"
#include "count_rule.h"
#include "each_chunk.h"
#include "raise.h"
#include "same_rays.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/stream_parts.h>
#include <raycloud/volume/merge_clouds.h>

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

/// Some rays of a chunk.
struct PieceOfCloud {
  RayCloud& rays;
  std::vector<std::uint32_t> numbers;
  std::vector<double> look_times;
};

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
    NumberedRays numbered =
        number_rays(context, clouds, key_rule(clouds, names_of(clouds.front()->info().extras)));
    leaders_ = leaders_of(numbered);
    first_ = std::move(numbered.first);
    times_ = std::move(numbered.times);
    for (const TimeSpan& of_cloud : times_) {
      all_times_.first = std::min(all_times_.first, of_cloud.first);
      all_times_.last = std::max(all_times_.last, of_cloud.last);
    }
  }

  void find_conflicts() {
    const bool by_time = rule_.merge == CloudMerge::oldest || rule_.merge == CloudMerge::newest;
    if (by_time && all_times_.first == all_times_.last && clouds_with_own_rays() > 1)
      throw Error(ErrorCode::no_data,
                  "all rays of all clouds have the same time: nothing is older or newer than the rest");
    scores_.assign(leaders_.size(), 0.0F);
    for (std::size_t own = 0; own < clouds_.size(); ++own)
      find_conflicts_of(own);
  }

  MergeCounts write(RaySink& combined, RaySink* differences) const {
    MergeCounts counts;
    for (std::size_t cloud = 0; cloud < clouds_.size(); ++cloud)
      write_cloud(cloud, combined, differences, counts);
    return counts;
  }

 private:
  [[nodiscard]] std::uint32_t number_of(std::size_t cloud, const RawChunk& raw) const {
    return static_cast<std::uint32_t>(first_[cloud] + raw.first_row);
  }

  /// By leaders: 1 for the rays that the cloud has.
  [[nodiscard]] std::vector<bool> rays_of(std::size_t cloud) const {
    std::vector<bool> has(leaders_.size());
    for (std::uint64_t i = first_[cloud]; i < first_[cloud + 1]; ++i)
      has[leaders_[i]] = true;
    return has;
  }

  /// `work(piece)` for the rays of a cloud; without those in `but`, if it is not empty.
  template <class Work>
  void each_piece(std::size_t cloud, const std::vector<bool>& but, const Work& work) const {
    each_chunk(context_, *clouds_[cloud], [&](RayCloud& rays, const RawChunk& raw) {
      PieceOfCloud piece{rays, {}, {}};
      std::vector<std::uint32_t> rows;
      const std::uint32_t first = number_of(cloud, raw);
      for (std::uint32_t row = 0; row < rays.size(); ++row) {
        if (!but.empty() && but[leaders_[first + row]]) continue;
        rows.push_back(row);
        piece.numbers.push_back(first + row);
        piece.look_times.push_back(look_time(cloud, rays.times[row], first + row));
      }
      if (rows.size() < rays.size()) rays.keep_rows(rows);
      if (!rays.empty()) work(piece);
    });
  }

  /// Where a cloud has no times, a thousand rays in its order are one look.
  [[nodiscard]] double look_time(std::size_t cloud, double time, std::uint32_t number) const {
    constexpr std::uint32_t kOneLook = 1000;
    const bool timed = times_[cloud].first < times_[cloud].last;
    return timed ? time : CountRule{}.look_time * (0.5 + number / kOneLook);
  }

  /// How many have rays that no cloud before them has.
  [[nodiscard]] std::size_t clouds_with_own_rays() const {
    std::size_t count = 0;
    for (std::size_t cloud = 0; cloud < clouds_.size(); ++cloud) {
      bool any = false;
      for (std::uint64_t i = first_[cloud]; i < first_[cloud + 1] && !any; ++i)
        any = leaders_[i] == i;
      count += any ? 1 : 0;
    }
    return count;
  }

  [[nodiscard]] bool gives_way(float score) const { return static_cast<double>(score) > rule_.rays; }

  void find_conflicts_of(std::size_t own) {
    const CloudEllipsoids cloud = cloud_ellipsoids(context_, *clouds_[own]);
    if (cloud.tree->size() == 0) return;
    const EllipsoidTree& tree = *cloud.tree;
    const CountRule counting = count_rule(rule_.paper, cloud.range_noise);
    const std::vector<bool> own_rays = rays_of(own);
    std::vector<float> ends;
    std::vector<std::pair<std::size_t, std::vector<PassConflict>>> passes;
    for (std::size_t other = 0; other < clouds_.size(); ++other) {
      if (other == own) continue;
      CloudConflicts conflicts = conflicts_with(own, other, tree, counting, own_rays);
      if (ends.empty()) {
        ends = std::move(conflicts.ends);
      } else if (!conflicts.ends.empty()) {
        for (std::size_t i = 0; i < ends.size(); ++i)
          ends[i] = std::max(ends[i], conflicts.ends[i]);
      }
      if (!conflicts.passes.empty()) passes.emplace_back(other, std::move(conflicts.passes));
    }
    for (auto& [other, conflicts] : passes) {
      // What itself gives way contradicts nobody.
      std::erase_if(conflicts, [&](const PassConflict& conflict) {
        return !gives_way(conflict.score) || (!ends.empty() && gives_way(ends[conflict.slot]));
      });
      score_passes(other, tree, counting, own_rays, conflicts);
    }
    if (!ends.empty()) score_ends(own, tree, ends);
  }

  CloudConflicts conflicts_with(std::size_t own, std::size_t other, const EllipsoidTree& tree,
                                const CountRule& counting, const std::vector<bool>& own_rays) const {
    const int fewest = rule_.paper ? 1 : 2;  // fewer change no score
    std::vector<std::uint32_t> touched;
    {
      std::vector<std::uint8_t> passes(tree.size());
      each_piece(other, own_rays,
                 [&](const PieceOfCloud& piece) { count_passes(tree, piece.rays, counting.guard, passes); });
      for (std::uint32_t slot = 0; slot < passes.size(); ++slot)
        if (passes[slot] >= fewest) touched.push_back(slot);
    }
    if (touched.empty()) return {};
    const SomeEllipsoids some = some_of(context_, tree, std::move(touched));
    const FineTime times(all_times_.first, all_times_.last);
    const auto met_by = [&](std::size_t cloud, const std::vector<bool>& but) {
      std::vector<Encounters> met(some.slots.size());
      each_piece(cloud, but, [&](const PieceOfCloud& piece) {
        add_encounters(*some.tree, piece.rays, piece.look_times, counting, times, met);
      });
      return met;
    };
    return cloud_conflicts(context_, tree, some, met_by(own, {}), met_by(other, own_rays), rule_, own, other);
  }

  void score_passes(std::size_t other, const EllipsoidTree& tree, const CountRule& counting,
                    const std::vector<bool>& own_rays, const std::vector<PassConflict>& conflicts) {
    if (conflicts.empty()) return;
    std::vector<std::uint32_t> slots;
    for (const PassConflict& conflict : conflicts)
      slots.push_back(conflict.slot);
    const SomeEllipsoids some = some_of(context_, tree, std::move(slots));
    std::vector<PassConflict> by_slot(conflicts.size());
    for (std::size_t i = 0; i < conflicts.size(); ++i)
      by_slot[some.tree->slot(i)] = conflicts[i];
    each_piece(other, own_rays, [&](const PieceOfCloud& piece) {
      const std::vector<float> scores = contradicting_rays(
          *some.tree, piece.rays, counting.guard,
          [&](std::uint32_t slot, double) { return by_slot[slot].score; },
          [&](std::uint32_t slot) { return by_slot[slot].opacity; });
      for (std::size_t i = 0; i < scores.size(); ++i)
        if (scores[i] > 0.0F) raise(scores_[leaders_[piece.numbers[i]]], scores[i]);
    });
  }

  void score_ends(std::size_t own, const EllipsoidTree& tree, std::span<const float> ends) {
    std::size_t next = 0;
    stream(
        context_, *clouds_[own], nullptr,
        [&](const RayCloud&, const RawChunk& raw) { return number_of(own, raw); },
        [&](const RayCloud& rays, std::uint32_t first) {
          for (std::uint32_t row = 0; row < rays.size(); ++row)
            if (rays.bounded[row] != 0) raise(scores_[leaders_[first + row]], ends[tree.slot(next++)]);
        });
    clouds_[own]->rewind();
  }

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
          const std::uint32_t first = number_of(cloud, raw);
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
  std::vector<std::uint64_t> first_;
  std::vector<std::uint32_t> leaders_;
  std::vector<TimeSpan> times_;
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
