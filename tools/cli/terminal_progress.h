#pragma once
/// Progress of a command as one line on standard error, rewritten ten times a second by a thread of its own.

#include <raycloud/exec/progress.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace ray::cli {

/// `reading  42 %  8.1 M/s  3 s left`, or `reading  1,234,567  8.1 M/s` where the total is unknown.
[[nodiscard]] std::string progress_line(std::string_view stage, std::uint64_t done, std::uint64_t total,
                                        double seconds);

/// Cancelled by Ctrl-C (interrupt.h). `advance` is one atomic addition.
class TerminalProgress : public Progress {
 public:
  enum class Show { nothing, line };
  explicit TerminalProgress(Show show) : show_(show) {}
  ~TerminalProgress() override { stop(); }

  void begin(std::string_view name, std::uint64_t total) override;
  void advance(std::uint64_t count) override { done_.fetch_add(count, std::memory_order_relaxed); }
  void end() override;
  [[nodiscard]] bool cancelled() const override;

  /// Clears the line, so that something else can be printed; it comes back with the next repaint.
  void clear();
  /// Clears the line for good.
  void stop();

 private:
  void repaint_until_stopped();
  void paint(const std::string& line);

  const Show show_;
  std::atomic<std::uint64_t> done_{0};
  std::mutex mutex_;  // guards everything below
  std::condition_variable wake_;
  std::string stage_;
  std::uint64_t total_ = 0;
  std::chrono::steady_clock::time_point started_;
  std::size_t painted_ = 0;
  bool stopped_ = false;
  std::thread painter_;
};

}  // namespace ray::cli
