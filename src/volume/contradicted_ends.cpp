#include "contradicted_ends.h"

#include "cloud_conflicts.h"
#include "cloud_ellipsoids.h"
#include "count_rule.h"
#include "each_chunk.h"

#include <algorithm>
#include <cstdint>

namespace ray {
namespace {

/// Where a cloud has no times, a thousand rays in its order are one look.
std::vector<double> times_of_looks(const TimedCloud& cloud, const RayCloud& rays, const RawChunk& raw) {
  constexpr std::uint64_t kOneLook = 1000;
  std::vector<double> times = rays.times;
  if (cloud.first < cloud.last) return times;
  for (std::size_t i = 0; i < times.size(); ++i)
    times[i] = CountRule{}.look_time * (0.5 + static_cast<double>((raw.first_row + i) / kOneLook));
  return times;
}

/// The ellipsoids that enough rays of the cloud pass.
std::vector<std::uint32_t> passed_slots(const Context& context, const EllipsoidTree& tree, RaySource& rays_of,
                                        const PassGuard& guard) {
  constexpr int kFewest = 2;  // fewer change no score
  std::vector<std::uint8_t> passes(tree.size());
  each_chunk(context, rays_of, [&](const RayCloud& rays) { count_passes(tree, rays, guard, passes); });
  std::vector<std::uint32_t> slots;
  for (std::uint32_t slot = 0; slot < passes.size(); ++slot)
    if (passes[slot] >= kFewest) slots.push_back(slot);
  return slots;
}

}  // namespace

std::vector<float> contradicted_ends(const Context& context, const TimedCloud& own, const TimedCloud& other) {
  const CloudEllipsoids cloud = cloud_ellipsoids(context, *own.source);
  const EllipsoidTree& tree = *cloud.tree;
  if (tree.size() == 0) return {};
  const CountRule counting = count_rule(false, cloud.range_noise);
  std::vector<std::uint32_t> passed = passed_slots(context, tree, *other.source, counting.guard);
  if (passed.empty()) return {};
  const SomeEllipsoids some = some_of(context, tree, std::move(passed));
  const FineTime times(std::min(own.first, other.first), std::max(own.last, other.last));
  const auto met_by = [&](const TimedCloud& by) {
    std::vector<Encounters> met(some.slots.size());
    each_chunk(context, *by.source, [&](const RayCloud& rays, const RawChunk& raw) {
      add_encounters(*some.tree, rays, times_of_looks(by, rays, raw), counting, times, met);
    });
    return met;
  };
  const CloudConflicts conflicts =
      cloud_conflicts(context, tree, some, met_by(own), met_by(other), {.merge = CloudMerge::min}, 0, 1);
  if (conflicts.ends.empty()) return {};
  std::vector<float> scores(tree.size());
  for (std::size_t i = 0; i < scores.size(); ++i)
    scores[i] = conflicts.ends[tree.slot(i)];
  return scores;
}

}  // namespace ray
