#include "coherent_order.h"
#include "look.h"
#include "ray_path.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/volume/free_space.h>

#include <algorithm>
#include <atomic>

namespace ray {
namespace {

constexpr std::uint16_t kMostCounted = 60000;

void count(std::uint16_t& counter) {
  const std::atomic_ref<std::uint16_t> atomic(counter);
  std::uint16_t known = atomic.load(std::memory_order_relaxed);
  while (known < kMostCounted && !atomic.compare_exchange_weak(known, static_cast<std::uint16_t>(known + 1),
                                                               std::memory_order_relaxed)) {
  }
}

/// Parts hits in order of time at their longest pauses.
void part_hits(std::span<const std::uint16_t> ticks, double look_ticks, HitEpisodes& hits) {
  constexpr std::size_t kPauses = HitEpisodes::kEpisodes - 1;
  std::array<std::size_t, kPauses> after{};  // the hits after which there is a pause, the longest pause first
  std::size_t pauses = 0;
  const auto length = [&](std::size_t i) { return ticks[i + 1] - ticks[i]; };
  for (std::size_t i = 0; i + 1 < ticks.size(); ++i) {
    if (length(i) <= look_ticks) continue;
    std::size_t at = pauses;
    while (at > 0 && length(after[at - 1]) < length(i))
      --at;
    if (at == kPauses) continue;
    pauses = std::min(pauses + 1, kPauses);
    for (std::size_t k = pauses - 1; k > at; --k)
      after[k] = after[k - 1];
    after[at] = i;
  }
  std::sort(after.begin(), after.begin() + static_cast<std::ptrdiff_t>(pauses));
  hits.begins.fill(ticks.back());
  hits.ends.fill(ticks.back());
  hits.begins[0] = ticks.front();
  for (std::size_t k = 0; k < pauses; ++k) {
    hits.ends[k] = ticks[after[k]];
    hits.begins[k + 1] = ticks[after[k] + 1];
  }
}

}  // namespace

HitEpisodes episodes_of(std::vector<std::uint16_t>& ticks, double look_ticks) {
  HitEpisodes hits;
  if (ticks.empty()) return hits;
  hits.hits = static_cast<std::uint16_t>(std::min<std::size_t>(ticks.size(), kMostCounted));
  const auto [first, last] = std::minmax_element(ticks.begin(), ticks.end());
  if (*last - *first <= look_ticks) {
    hits.begins.fill(*last);
    hits.begins[0] = *first;
    hits.ends.fill(*last);
    return hits;
  }
  std::sort(ticks.begin(), ticks.end());
  part_hits(ticks, look_ticks, hits);
  return hits;
}

void HitTimes::add(const EllipsoidTree& tree, const RayCloud& rays, const TimeScale& scale) {
  std::vector<Further> further;
  std::vector<std::uint32_t> slots;
  for (const std::uint32_t i : coherent_order(rays, true)) {
    tree.holding(rays.ends[i], slots);
    const std::uint16_t tick = scale.tick(rays.times[i]);
    for (const std::uint32_t slot : slots)
      __builtin_prefetch(&first_[slot], 1);
    for (const std::uint32_t slot : slots) {
      const std::uint32_t at =
          std::atomic_ref<std::uint32_t>(counts_[slot]).fetch_add(1, std::memory_order_relaxed);
      if (at < kFirst)
        first_[slot][at] = tick;
      else
        further.push_back({slot, tick});
    }
  }
  const std::lock_guard lock(mutex_);
  further_.insert(further_.end(), further.begin(), further.end());
}

void HitTimes::find_episodes(const Context& context, double look_ticks, std::span<Evidence> evidence) {
  parallel_sort(context, further_.begin(), further_.end());
  parallel_for(context, counts_.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint16_t> ticks;
    auto further =
        std::lower_bound(further_.begin(), further_.end(), Further{static_cast<std::uint32_t>(begin), 0});
    for (std::size_t slot = begin; slot < end; ++slot) {
      const std::uint32_t count = counts_[slot];
      if (count == 0) continue;
      const auto first = first_[slot].begin();
      ticks.assign(first, first + std::min<std::ptrdiff_t>(count, kFirst));
      for (; further != further_.end() && further->slot == slot; ++further)
        ticks.push_back(further->tick);
      static_cast<HitEpisodes&>(evidence[slot]) = episodes_of(ticks, look_ticks);
    }
  });
}

void add_passes(const EllipsoidTree& tree, const RayCloud& rays, const CountRule& rule,
                const TimeScale& scale, std::span<Evidence> evidence) {
  std::vector<std::uint32_t> slots, late;
  for (const std::uint32_t i : coherent_order(rays, false)) {
    // What a bounded ray leaves so near its end proves nothing.
    const double beyond = rays.bounded[i] != 0 ? rule.guard.beyond : 0.0;
    tree.near_line(rays.starts[i], rays.ends[i], beyond, slots, late);
    for (const std::uint32_t slot : late)
      __builtin_prefetch(&evidence[slot].crossings, 1);
    for (const std::uint32_t slot : slots)
      __builtin_prefetch(&evidence[slot], 1);
    for (const std::uint32_t slot : late)
      count(evidence[slot].crossings);
    if (slots.empty()) continue;
    const RayPath path(rays, i);
    const std::uint16_t look = look_of(rays.times[i], path.way(), rule.look_time);
    const std::uint16_t tick = scale.tick(rays.times[i]);
    for (const std::uint32_t slot : slots) {
      const Crossing crossing = path.cross(tree.at_slot(slot), rule.guard);
      if (crossing == Crossing::none) continue;
      Evidence& seen = evidence[slot];
      count(seen.crossings);
      if (crossing != Crossing::proves_empty) continue;
      const std::size_t run = seen.run_at(tick);
      if (run == Evidence::kRuns) {
        count(seen.within);
        continue;
      }
      count(seen.passes[run]);
      add_look(seen.looks[run], look);
    }
  }
}

}  // namespace ray
