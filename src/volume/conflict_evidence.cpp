#include "conflict_evidence.h"

#include "contradicting_rays.h"
#include "count_rule.h"
#include "each_chunk.h"
#include "transience.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ray {
namespace {

Sides sides_of(CloudMerge merge, bool own_is_earlier) {
  const Contradiction any, before{.between = false, .after = false}, after{.before = false, .between = false};
  switch (merge) {
    case CloudMerge::all:
      return {};
    case CloudMerge::min:
      return {any, {}};
    case CloudMerge::max:
      return {{}, any};
    case CloudMerge::oldest:
      return {before, after};
    case CloudMerge::newest:
      return {after, before};
    case CloudMerge::order:
      return own_is_earlier ? Sides{{}, any} : Sides{any, {}};
  }
  return {};
}

FineTime fine_time(std::span<const NumberedCloud> clouds) {
  TimeSpan all;
  for (const NumberedCloud& cloud : clouds)
    all.add(cloud.times);
  return {all.first, all.last};
}

/// -1, 0 or 1: the passes came, on average, before, with or after the hits.
int order_in_time(const Encounters& own, const Encounters& other) {
  const double hit = static_cast<double>(own.hit_ticks) / own.hits;
  const double pass = static_cast<double>(other.pass_ticks) / other.passes;
  return pass < hit ? -1 : pass > hit ? 1 : 0;
}

std::uint16_t counter(double count) {
  constexpr double kMostCounted = 60000.0;
  return static_cast<std::uint16_t>(std::clamp(count, 0.0, kMostCounted));
}

}  // namespace

ConflictRule::ConflictRule(const Context& context, const ConflictQuestion& question, double range_noise)
    : context_(context),
      question_(question),
      fewest_(question.rule.paper ? 1 : 2),
      counting_(count_rule(question.rule.paper, range_noise)),
      times_(fine_time(question.clouds)) {
  for (std::size_t other = 0; other < question.clouds.size(); ++other)
    sides_.push_back(sides_of(question.rule.merge, question.own < other));
}

NumberRays ConflictRule::numbering(std::size_t cloud) const {
  return [this, cloud](RayCloud& rays, const RawChunk& raw) {
    std::vector<std::uint32_t> numbers(rays.size());
    std::iota(numbers.begin(), numbers.end(), question_.clouds[cloud].first_of(raw));
    if (cloud == question_.own || !question_.is_shared) return numbers;
    std::vector<std::uint32_t> rows, of_rows;
    for (std::uint32_t row = 0; row < numbers.size(); ++row) {
      if (question_.is_shared(numbers[row])) continue;
      rows.push_back(row);
      of_rows.push_back(numbers[row]);
    }
    if (rows.size() < rays.size()) rays.keep_rows(rows);
    return of_rows;
  };
}

MeetingRays ConflictRule::rays_of(std::size_t cloud) const {
  return {question_.clouds[cloud], [this, cloud](const SeeRays& see) {
            each_chunk(context_, *question_.clouds[cloud].source,
                       [&, number = numbering(cloud)](RayCloud& rays, const RawChunk& raw) {
                         const std::vector<std::uint32_t> numbers = number(rays, raw);
                         if (!numbers.empty()) see(rays, numbers);
                       });
          }};
}

MeetingRays ConflictRule::rays_of(std::size_t cloud, CrossingRays& rays, std::size_t part) const {
  return {question_.clouds[cloud], [this, &rays, part](const SeeRays& see) {
            each_chunk(context_, *rays.crossing(part),
                       [&](const RayCloud& of_chunk) { see(of_chunk, numbers_of(of_chunk)); });
          }};
}

std::vector<std::uint32_t> ConflictRule::passed_slots(const EllipsoidTree& tree,
                                                      const MeetingRays& rays) const {
  std::vector<std::uint8_t> passes(tree.size());
  rays.each([&](const RayCloud& piece, std::span<const std::uint32_t>) {
    count_passes(tree, piece, counting_.guard, passes);
  });
  std::vector<std::uint32_t> slots;
  for (std::uint32_t slot = 0; slot < passes.size(); ++slot)
    if (passes[slot] >= fewest_) slots.push_back(slot);
  return slots;
}

std::vector<Encounters> ConflictRule::met_by(const EllipsoidTree& tree, const MeetingRays& rays) const {
  std::vector<Encounters> met(tree.size());
  rays.each([&](const RayCloud& piece, std::span<const std::uint32_t> numbers) {
    add_encounters(tree, piece, rays.cloud.look_times(piece, numbers), counting_, times_, met);
  });
  return met;
}

Evidence ConflictRule::evidence(const Encounters& own, const Encounters& other) const {
  Evidence evidence;
  if (own.hits == 0 || other.passes == 0) return evidence;
  const CloudMerge merge = question_.rule.merge;
  const int order = order_in_time(own, other);
  if (order == 0 && (merge == CloudMerge::oldest || merge == CloudMerge::newest)) return evidence;
  evidence.hits = counter(own.hits);
  evidence.crossings = counter(own.crossings);
  evidence.within = counter(own.passes);
  const double opacity = static_cast<double>(opacity_while_there(evidence));
  const std::size_t run = order < 0 ? 0 : Evidence::kRuns - 1;
  evidence.passes[run] =
      counter(std::floor(other.passes - static_cast<double>(kOfEachHit) * other.hits / opacity));
  evidence.looks[run] = other.looks;
  return evidence;
}

void add_pass_conflict(std::uint32_t ellipsoid, float score, const Evidence& evidence, bool paper,
                       std::vector<PassConflict>& conflicts) {
  constexpr float kLongestByChance = 3.0F;
  if (!(score > 0.0F)) return;
  const float opacity = opacity_while_there(evidence);
  const auto passes = static_cast<float>(std::max(evidence.passes.front(), evidence.passes.back()));
  if (paper || passes * opacity > kLongestByChance) conflicts.push_back({ellipsoid, score, opacity});
}

void tell_passes(const EllipsoidTree& tree, std::span<const PassConflict> conflicts, const PassGuard& guard,
                 const MeetingRays& rays, const TellScores& tell) {
  std::vector<PassConflict> by_slot(conflicts.size());
  for (std::size_t i = 0; i < conflicts.size(); ++i)
    by_slot[tree.slot(i)] = conflicts[i];
  rays.each([&](const RayCloud& piece, std::span<const std::uint32_t> numbers) {
    tell(numbers, contradicting_rays(
                      tree, piece, guard, [&](std::uint32_t slot, double) { return by_slot[slot].score; },
                      [&](std::uint32_t slot) { return by_slot[slot].opacity; }));
  });
}

void tell_ends(const Context& context, const NumberedCloud& cloud,
               const std::function<std::span<const float>(const RayCloud& rays)>& scores,
               const TellScores& tell) {
  stream(
      context, *cloud.source, nullptr,
      [&](const RayCloud& rays, const RawChunk& raw) {
        std::vector<std::uint32_t> numbers;
        for (std::uint32_t row = 0; row < rays.size(); ++row)
          if (rays.bounded[row] != 0) numbers.push_back(cloud.first_of(raw) + row);
        return numbers;
      },
      [&](const RayCloud& rays, const std::vector<std::uint32_t>& numbers) { tell(numbers, scores(rays)); });
  cloud.source->rewind();
}

}  // namespace ray
