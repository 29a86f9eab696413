#include "cli/interrupt.h"

#include <atomic>
#include <csignal>

namespace ray::cli {
namespace {

// A signal handler can reach nothing but a global.
std::atomic<bool> g_interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void raycloud_cli_interrupt(int) {
  g_interrupted.store(true, std::memory_order_relaxed);
}

}  // namespace

void catch_interrupts() {
  g_interrupted = false;
  struct sigaction action {};
  action.sa_handler = raycloud_cli_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigemptyset(&ignore.sa_mask);
  sigaction(SIGPIPE, &ignore, nullptr);
}

bool interrupted() noexcept {
  return g_interrupted.load(std::memory_order_relaxed);
}

}  // namespace ray::cli
