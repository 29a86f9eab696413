#pragma once
/// The parallel verbs: the only place of the project that knows how threads are run. Every verb gives the
/// same result for every thread count, polls for cancellation and throws what a body throws.

#include <raycloud/exec/context.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <vector>

namespace ray {

/// Calls `body(begin, end)` for consecutive ranges that cover [0, count), each at most `grain` long and cut
/// at multiples of it whatever the thread count. Bodies run at the same time, in any order.
void parallel_for(const Context& context, std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Maps each range as parallel_for cuts it to a T and combines the Ts in order, from the left:
/// `combine(combine(map(0, g), map(g, 2g)), …)`; so floating-point sums do not depend on the threads.
template <class T, class Map, class Combine>
[[nodiscard]] T parallel_reduce(const Context& context, std::size_t count, std::size_t grain, T initial,
                                const Map& map, const Combine& combine) {
  std::vector<T> parts((count + grain - 1) / grain, initial);
  parallel_for(context, count, grain,
               [&](std::size_t begin, std::size_t end) { parts[begin / grain] = map(begin, end); });
  for (T& part : parts) {
    initial = combine(std::move(initial), std::move(part));
  }
  return initial;
}

/// Stable sort of a random-access range: equal elements keep their order, so the result is unique. O(n log n)
/// time, n extra elements.
template <class Iterator, class Less = std::less<>>
void parallel_sort(const Context& context, Iterator first, Iterator last, Less less = {}) {
  constexpr std::size_t kRun = 1 << 15;
  using Value = typename std::iterator_traits<Iterator>::value_type;
  const auto count = static_cast<std::size_t>(last - first);
  const auto at = [](auto begin, std::size_t i) { return begin + static_cast<std::ptrdiff_t>(i); };
  parallel_for(context, count, kRun, [&](std::size_t begin, std::size_t end) {
    std::stable_sort(at(first, begin), at(first, end), less);
  });
  if (count <= kRun) return;
  std::vector<Value> other(count);
  bool in_other = false;
  for (std::size_t run = kRun; run < count; run *= 2, in_other = !in_other) {
    const auto merge_into = [&](auto from, auto to) {
      parallel_for(context, count, 2 * run, [&](std::size_t begin, std::size_t end) {
        const std::size_t middle = std::min(begin + run, end);
        std::merge(std::make_move_iterator(at(from, begin)), std::make_move_iterator(at(from, middle)),
                   std::make_move_iterator(at(from, middle)), std::make_move_iterator(at(from, end)),
                   at(to, begin), less);
      });
    };
    in_other ? merge_into(other.begin(), first) : merge_into(first, other.begin());
  }
  if (in_other) std::move(other.begin(), other.end(), first);
}

/// One stage of a pipeline, called with the number of a slot that holds the item.
struct PipelineStage {
  enum class Mode {
    ordered,  ///< one item at a time, in order
    parallel  ///< several items at once
  };
  Mode mode;
  std::function<void(std::size_t slot)> run;
};

/// Read, compute and write at the same time. `read(slot)` fills a slot and returns false at the end; then the
/// stages follow, the last of which must be `ordered`. At most `slot_count` items are under way, and a slot
/// is free again when the last stage has left it. An exception of any stage stops the pipeline and is
/// rethrown.
void pipeline(const Context& context, std::size_t slot_count,
              const std::function<bool(std::size_t slot)>& read, const std::vector<PipelineStage>& stages);

/// The number of slots that keeps `thread_count(context)` threads busy.
[[nodiscard]] std::size_t pipeline_slots(const Context& context);

}  // namespace ray
