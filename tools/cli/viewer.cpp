#include "cli/viewer.h"

#include "cli/shell_words.h"

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>
#include <vector>

namespace ray::cli {
namespace {

bool start(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_t files;
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_init(&files);
  sigset_t defaults;
  sigemptyset(&defaults);
  sigaddset(&defaults, SIGPIPE);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setpgroup(&attributes, 0);  // a Ctrl-C in the terminal later is not meant for it
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  // A viewer's chatter would land in the middle of the next prompt, and keep a pipe open.
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, arguments.front(), &files, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  return failed == 0;
}

}  // namespace

bool open_viewer(const std::filesystem::path& file) {
  const char* chosen = std::getenv("RAYCLOUD_VIEWER");
  std::vector<std::string> viewers{"CloudCompare", "cloudcompare", "cloudcompare.CloudCompare", "meshlab"};
  if (chosen != nullptr && *chosen != '\0') viewers = {chosen};
  for (const std::string& viewer : viewers) {
    std::vector<std::string> words = split_words(viewer);
    if (words.empty()) continue;
    words.push_back(file.string());
    if (start(std::move(words))) return true;
  }
  return false;
}

}  // namespace ray::cli
