#include <raycloud/core/error.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/progress.h>

#include <unistd.h>

#include <algorithm>
#include <thread>

namespace ray {

unsigned thread_count(const Context& context) {
  return context.threads != 0 ? context.threads : std::max(1U, std::thread::hardware_concurrency());
}

std::size_t memory_budget(const Context& context) {
  if (context.memory != 0) return context.memory;
  const long pages = sysconf(_SC_PHYS_PAGES);
  const long page_size = sysconf(_SC_PAGESIZE);
  constexpr std::size_t kUnknown = std::size_t{2} << 30;
  return pages > 0 && page_size > 0
             ? static_cast<std::size_t>(pages) * static_cast<std::size_t>(page_size) / 2
             : kUnknown;
}

void check_cancelled(const Context& context) {
  if (context.progress != nullptr && context.progress->cancelled()) {
    throw Error(ErrorCode::cancelled, "interrupted");
  }
}

}  // namespace ray
