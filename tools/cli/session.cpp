#include "cli/session.h"

#include "cli/command.h"
#include "cli/grouped.h"
#include "cli/terminal_progress.h"
#include "cli/viewer.h"

#include <unistd.h>

#include <cstdio>
#include <system_error>

namespace ray::cli {
namespace {

std::string described(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  return file.string() + (error ? "" : " (" + file_size(bytes) + ")");
}

std::string joined(const std::vector<std::string>& parts, const std::string& last) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    text += (i == 0 ? "" : i + 1 < parts.size() ? ", " : last) + parts[i];
  }
  return text;
}

}  // namespace

std::string summary_line(const Summary& summary, double seconds) {
  std::vector<std::string> parts;
  if (summary.rays_in)
    parts.push_back(grouped(*summary.rays_in) + (*summary.rays_in == 1 ? " ray in" : " rays in"));
  if (summary.rays_out) {
    const std::string noun = summary.rays_in ? "" : *summary.rays_out == 1 ? " ray" : " rays";
    parts.push_back(grouped(*summary.rays_out) + noun + " out");
  }
  constexpr std::size_t kNamed = 4;  // more files than that are only counted
  std::vector<std::string> files;
  for (const std::filesystem::path& file : summary.files)
    files.push_back(described(file));
  if (files.size() > kNamed) {
    parts.push_back("wrote " + grouped(files.size()) + " files from " + summary.files.front().string() +
                    " to " + summary.files.back().string());
  } else if (!files.empty()) {
    parts.push_back("wrote " + joined(files, " and "));
  }
  char took[32];
  std::snprintf(took, sizeof took, " in %.1f s", seconds);
  return joined(parts, ", ") + took;
}

Session::Session(const Command& command, const Match& match)
    : name_(command.name),
      history_(match.history()),
      quiet_(match.has("--quiet")),
      started_(std::chrono::steady_clock::now()) {
  for (const Option& option : command.options)
    wants_view_ = wants_view_ || option.name == "view";
  wants_view_ = wants_view_ && match.has("--view");
  const bool show = !quiet_ && ::isatty(STDERR_FILENO) == 1;
  progress_ = std::make_unique<TerminalProgress>(show ? TerminalProgress::Show::line
                                                      : TerminalProgress::Show::nothing);
  if (match.has("--threads")) context_.threads = static_cast<unsigned>(match.integer("--threads"));
  if (match.has("--memory")) context_.memory = static_cast<std::size_t>(match.integer("--memory"));
  context_.progress = progress_.get();
}

Session::~Session() = default;

void Session::note(std::string_view line) {
  if (quiet_) return;
  print(name_ + ": " + std::string(line) + "\n");
}

void Session::warn(std::string_view line) {
  progress_->clear();
  const std::string text = name_ + ": " + std::string(line) + "\n";
  std::fwrite(text.data(), 1, text.size(), stderr);
}

void Session::print(std::string_view text) {
  progress_->clear();
  std::fwrite(text.data(), 1, text.size(), stdout);  // main checks the stream at the end
}

void Session::summary(const Summary& summary) {
  progress_->stop();
  if (viewed_.empty() && !summary.files.empty()) viewed_ = summary.files.front();
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - started_;
  note(summary_line(summary, taken.count()));
}

void Session::finish() {
  progress_->stop();
  if (!wants_view_ || viewed_.empty()) return;
  if (!open_viewer(viewed_)) warn("no viewer found for --view: set RAYCLOUD_VIEWER to the command of one");
}

}  // namespace ray::cli
