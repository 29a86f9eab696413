#include <raycloud/exec/parallel.h>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <cassert>
#include <mutex>

namespace ray {

namespace {

/// Runs `work` with exactly the context's number of threads, also where that is more than the machine's cores
/// (tests on small machines rely on it).
template <class Work>
void run_in_arena(const Context& context, const Work& work) {
  const unsigned threads = thread_count(context);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  tbb::task_arena arena(static_cast<int>(threads));
  arena.execute(work);
}

/// The slots that no item has. The one freed last comes first: its memory is still near a core.
class FreeSlots {
 public:
  explicit FreeSlots(std::size_t count) {
    for (std::size_t slot = count; slot-- > 0;)
      slots_.push_back(slot);
  }
  /// Precondition: fewer items than slots are under way.
  std::size_t take() {
    const std::lock_guard lock(mutex_);
    assert(!slots_.empty());
    const std::size_t slot = slots_.back();
    slots_.pop_back();
    return slot;
  }
  void put(std::size_t slot) {
    const std::lock_guard lock(mutex_);
    slots_.push_back(slot);
  }

 private:
  std::mutex mutex_;
  std::vector<std::size_t> slots_;
};

}  // namespace

void parallel_for(const Context& context, std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  assert(grain > 0);
  const std::size_t chunks = (count + grain - 1) / grain;
  const auto run_chunk = [&](std::size_t chunk) {
    check_cancelled(context);
    body(chunk * grain, std::min(count, (chunk + 1) * grain));
  };
  if (chunks <= 1 || thread_count(context) == 1) {
    for (std::size_t chunk = 0; chunk < chunks; ++chunk)
      run_chunk(chunk);
    return;
  }
  run_in_arena(context, [&] { tbb::parallel_for(std::size_t{0}, chunks, run_chunk); });
}

void pipeline(const Context& context, std::size_t slot_count, const std::function<bool(std::size_t)>& read,
              const std::vector<PipelineStage>& stages) {
  assert(slot_count > 0 && !stages.empty() && stages.back().mode == PipelineStage::Mode::ordered);
  if (thread_count(context) == 1) {
    while (check_cancelled(context), read(0)) {
      for (const PipelineStage& stage : stages)
        stage.run(0);
    }
    return;
  }
  FreeSlots free(slot_count);
  auto chain = tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order,
                                                   [&](tbb::flow_control& control) -> std::size_t {
                                                     check_cancelled(context);
                                                     const std::size_t slot = free.take();
                                                     if (!read(slot)) control.stop();
                                                     return slot;
                                                   });
  for (const PipelineStage& stage : stages) {
    const auto mode = stage.mode == PipelineStage::Mode::ordered ? tbb::filter_mode::serial_in_order
                                                                 : tbb::filter_mode::parallel;
    chain = chain & tbb::make_filter<std::size_t, std::size_t>(mode, [&stage](std::size_t slot) {
              stage.run(slot);
              return slot;
            });
  }
  const auto last = chain & tbb::make_filter<std::size_t, void>(tbb::filter_mode::parallel,
                                                                [&](std::size_t slot) { free.put(slot); });
  run_in_arena(context, [&] { tbb::parallel_pipeline(slot_count, last); });
}

std::size_t pipeline_slots(const Context& context) {
  return thread_count(context) == 1 ? 1 : 2 * std::size_t{thread_count(context)} + 2;
}

}  // namespace ray
