#include "cli/terminal_progress.h"

#include "cli/grouped.h"
#include "cli/interrupt.h"
#include "cli/shell_words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace ray::cli {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kRepaint = std::chrono::milliseconds(100);

std::string per_second(double rate) {
  char text[32];
  if (rate >= 1e6) {
    std::snprintf(text, sizeof text, "%.1f M/s", rate / 1e6);
  } else if (rate >= 1e3) {
    std::snprintf(text, sizeof text, "%.0f k/s", rate / 1e3);
  } else {
    std::snprintf(text, sizeof text, "%.0f /s", rate);
  }
  return text;
}

std::string duration(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::ceil(std::min(seconds, 3.6e8)));
  if (whole < 100) return std::to_string(whole) + " s";
  if (whole < 6000) return std::to_string((whole + 59) / 60) + " min";
  return std::to_string((whole + 3599) / 3600) + " h";
}

}  // namespace

std::string progress_line(std::string_view stage, std::uint64_t done, std::uint64_t total, double seconds) {
  const std::uint64_t shown = total > 0 ? std::min(done, total) : done;
  const double rate = seconds > 0.0 ? static_cast<double>(shown) / seconds : 0.0;
  std::string line(stage);
  if (total == 0) {
    line += "  " + grouped(done);
  } else {
    const double share = static_cast<double>(shown) / static_cast<double>(total);
    line += "  " + std::to_string(static_cast<int>(std::floor(share * 100.0))) + " %";
  }
  if (rate > 0.0) line += "  " + per_second(rate);
  if (rate > 0.0 && total > 0) line += "  " + duration(static_cast<double>(total - shown) / rate) + " left";
  return line;
}

void TerminalProgress::begin(std::string_view name, std::uint64_t total) {
  done_ = 0;
  if (show_ == Show::nothing) return;
  const std::scoped_lock lock(mutex_);
  stage_ = name;
  total_ = total;
  started_ = Clock::now();
  if (!painter_.joinable() && !stopped_) painter_ = std::thread([this] { repaint_until_stopped(); });
}

void TerminalProgress::end() {
  if (show_ == Show::nothing) return;
  const std::scoped_lock lock(mutex_);
  stage_.clear();
}

bool TerminalProgress::cancelled() const {
  return interrupted();
}

void TerminalProgress::clear() {
  if (show_ == Show::nothing) return;
  const std::scoped_lock lock(mutex_);
  if (painted_ > 0) paint("");
}

void TerminalProgress::stop() {
  if (show_ == Show::nothing) return;
  {
    const std::scoped_lock lock(mutex_);
    stopped_ = true;
  }
  wake_.notify_all();
  if (painter_.joinable()) painter_.join();
  clear();
}

void TerminalProgress::repaint_until_stopped() {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, kRepaint, [this] { return stopped_; })) {
    if (stage_.empty()) continue;
    const double seconds = std::chrono::duration<double>(Clock::now() - started_).count();
    paint(progress_line(stage_, done_.load(std::memory_order_relaxed), total_, seconds));
  }
}

/// Overwrites what is there with the line and enough spaces; no escape codes, so any terminal will do.
void TerminalProgress::paint(const std::string& line) {
  const std::size_t width = columns(line);
  const std::string blank(painted_ > width ? painted_ - width : 0, ' ');
  const std::string text = "\r" + line + blank + (line.empty() ? "\r" : "");
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
  painted_ = width;
}

}  // namespace ray::cli
