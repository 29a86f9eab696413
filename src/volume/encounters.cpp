#include "encounters.h"

#include "coherent_order.h"
#include "look.h"
#include "ray_path.h"

#include <raycloud/exec/parallel.h>

#include <atomic>

namespace ray {
namespace {

template <class Counter, class Amount>
void add_to(Counter& counter, Amount amount) {
  std::atomic_ref<Counter>(counter).fetch_add(static_cast<Counter>(amount), std::memory_order_relaxed);
}

void count_to_255(std::uint8_t& counter) {
  const std::atomic_ref<std::uint8_t> atomic(counter);
  std::uint8_t known = atomic.load(std::memory_order_relaxed);
  while (known < 255 && !atomic.compare_exchange_weak(known, static_cast<std::uint8_t>(known + 1),
                                                      std::memory_order_relaxed)) {
  }
}

}  // namespace

void count_passes(const EllipsoidTree& tree, const RayCloud& rays, const PassGuard& guard,
                  std::span<std::uint8_t> passes) {
  std::vector<std::uint32_t> slots;
  for (const std::uint32_t i : coherent_order(rays, false)) {
    tree.near_line(rays.starts[i], rays.ends[i], slots);
    if (slots.empty()) continue;
    const RayPath path(rays, i);
    for (const std::uint32_t slot : slots)
      if (path.cross(tree.at_slot(slot), guard) == Crossing::proves_empty) count_to_255(passes[slot]);
  }
}

void add_encounters(const EllipsoidTree& tree, const RayCloud& rays, std::span<const double> look_times,
                    const CountRule& rule, const FineTime& times, std::span<Encounters> encounters) {
  std::vector<std::uint32_t> slots;
  for (const std::uint32_t i : coherent_order(rays, false)) {
    const std::uint32_t tick = times.tick(rays.times[i]);
    if (rays.bounded[i] != 0) {
      tree.holding(rays.ends[i], slots);
      for (const std::uint32_t slot : slots) {
        add_to(encounters[slot].hits, 1);
        add_to(encounters[slot].hit_ticks, tick);
      }
    }
    tree.near_line(rays.starts[i], rays.ends[i], slots);
    if (slots.empty()) continue;
    const RayPath path(rays, i);
    const std::uint16_t look = look_of(look_times[i], path.way(), rule.look_time);
    for (const std::uint32_t slot : slots) {
      const Crossing crossing = path.cross(tree.at_slot(slot), rule.guard);
      if (crossing == Crossing::none) continue;
      Encounters& met = encounters[slot];
      add_to(met.crossings, 1);
      if (crossing != Crossing::proves_empty) continue;
      add_to(met.passes, 1);
      add_to(met.pass_ticks, tick);
      add_look(met.looks, look);
    }
  }
}

SomeEllipsoids some_of(const Context& context, const EllipsoidTree& whole, std::vector<std::uint32_t> slots) {
  SomeEllipsoids some{std::move(slots), nullptr};
  some.tree = std::make_unique<EllipsoidTree>(
      context, some.slots.size(), [&](std::size_t i) { return whole.at_slot(some.slots[i]).centre; });
  parallel_for(context, some.slots.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      some.tree->set(i, whole.at_slot(some.slots[i]));
  });
  some.tree->close(context);
  return some;
}

}  // namespace ray
