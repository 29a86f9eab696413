#pragma once
/// Ctrl-C and SIGTERM as a flag that a running command polls.

namespace ray::cli {

/// From now on the first SIGINT or SIGTERM sets the flag and the second one kills; SIGPIPE is ignored, so
/// that a closed pipe is a failed write like any other. Clears the flag.
void catch_interrupts();

/// Whether the user asked to stop.
[[nodiscard]] bool interrupted() noexcept;

}  // namespace ray::cli
