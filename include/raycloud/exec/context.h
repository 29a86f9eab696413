#pragma once
/// How to run: handed by const reference to every algorithm that computes.

#include <cstddef>
#include <cstdint>

namespace ray {

class Progress;

/// Resources and settings of one run. None of them, except `seed`, changes a result.
struct Context {
  unsigned threads = 0;          ///< most threads to use; 0 means all cores
  std::size_t memory = 0;        ///< bytes the algorithms may hold; 0 means half of the machine's memory
  std::uint64_t seed = 1;        ///< of every random stream (exec/random.h)
  Progress* progress = nullptr;  ///< not owned; nullptr hears nothing and never cancels
};

/// `context.threads`, or the number of cores where that is 0. Never 0.
[[nodiscard]] unsigned thread_count(const Context& context);

/// `context.memory`, or half of the physical memory where that is 0. Bytes.
[[nodiscard]] std::size_t memory_budget(const Context& context);

/// Throws Error(cancelled, "interrupted") if the context's progress asks to stop.
void check_cancelled(const Context& context);

}  // namespace ray
