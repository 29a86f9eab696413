#pragma once
/// One run of a command: its resources, and everything it says.

#include "cli/match.h"

#include <raycloud/exec/context.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ray::cli {

struct Command;
class TerminalProgress;

/// What the last line of a command reports. Leave out what does not apply.
struct Summary {
  std::optional<std::uint64_t> rays_in = {};
  std::optional<std::uint64_t> rays_out = {};
  std::vector<std::filesystem::path> files = {};  ///< written, the main one first
};

/// Made by `ray::cli::main`. All output of a command goes through here.
class Session {
 public:
  Session(const Command& command, const Match& match);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Threads and memory as the user asked, progress on the terminal, cancelled by Ctrl-C. Valid as long as
  /// the session.
  [[nodiscard]] const Context& context() const { return context_; }

  /// Match::history(), for the header of the output.
  [[nodiscard]] const std::string& history() const { return history_; }

  /// A line for the user on standard output ("37 rows with NaN left out"), starting with the command's name;
  /// nothing with --quiet.
  void note(std::string_view line);

  /// A line on standard error, with --quiet too: the result is there but the user should know something about
  /// it.
  void warn(std::string_view line);

  /// The command's result itself on standard output, as it is, with --quiet too.
  void print(std::string_view text);

  /// The last line, nothing with --quiet:
  /// `raydecimate: 1,234,567 rays in, 12,345 out, wrote cloud_decimated.ply (0.44 MB) in 0.3 s`.
  void summary(const Summary& summary);

  /// The file that --view opens, where it is not the first one of the summary.
  void view(std::filesystem::path file) { viewed_ = std::move(file); }

  /// Called by `main` after the command: clears the progress line, opens the viewer if asked.
  void finish();

 private:
  std::string name_;
  std::string history_;
  bool quiet_ = false;
  bool wants_view_ = false;
  std::filesystem::path viewed_;
  std::chrono::steady_clock::time_point started_;
  std::unique_ptr<TerminalProgress> progress_;
  Context context_;
};

/// The line of Session::summary after the command's name.
[[nodiscard]] std::string summary_line(const Summary& summary, double seconds);

}  // namespace ray::cli
