#include "git_driver.h"

#include "cli/shell_words.h"

#include <raycloud/core/error.h>
#include <raycloud/io/atomic_file.h>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace ray::tools {
namespace {

constexpr std::string_view kAttribute = "*.ply merge=plymerge";

struct GitAnswer {
  int status = 0;
  std::string text;  ///< what it printed, without the last newline
};

GitAnswer git(std::vector<std::string> words) {
  words.insert(words.begin(), "git");
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw Error(ErrorCode::file_access, "git: no pipe can be opened");
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, ends[1], STDERR_FILENO);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, "git", &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  ::close(ends[1]);
  GitAnswer answer;
  std::array<char, 4096> buffer;
  for (ssize_t got = 0; failed == 0 && (got = ::read(ends[0], buffer.data(), buffer.size())) > 0;)
    answer.text.append(buffer.data(), static_cast<std::size_t>(got));
  ::close(ends[0]);
  if (failed != 0) throw Error(ErrorCode::file_access, "git: " + std::generic_category().message(failed));
  int status = 0;
  ::waitpid(child, &status, 0);
  answer.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  if (answer.text.ends_with('\n')) answer.text.pop_back();
  return answer;
}

/// The answer, where git must do what it is asked.
std::string git_must(std::vector<std::string> words) {
  GitAnswer answer = git(std::move(words));
  if (answer.status != 0) {
    const std::string first_line = answer.text.substr(0, answer.text.find('\n'));
    throw Error(ErrorCode::file_access, "git: " + (first_line.empty() ? "it failed" : first_line));
  }
  return answer.text;
}

std::string scope_option(GitScope scope) {
  return scope == GitScope::user ? "--global" : "--local";
}

std::filesystem::path from_environment(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? "" : value;
}

std::filesystem::path attributes_file(GitScope scope) {
  if (scope == GitScope::repository) return git_must({"rev-parse", "--git-path", "info/attributes"});
  const GitAnswer chosen = git({"config", "--global", "--type=path", "--get", "core.attributesFile"});
  if (chosen.status == 0 && !chosen.text.empty()) return chosen.text;
  const std::filesystem::path config = from_environment("XDG_CONFIG_HOME");
  return (config.empty() ? from_environment("HOME") / ".config" : config) / "git" / "attributes";
}

bool can_run(const std::filesystem::path& program) {
  return ::access(program.c_str(), X_OK) == 0;
}

/// `raycombine`, or where that would not be found, the one beside this program.
std::string raycombine_program() {
  const std::string path = from_environment("PATH").string();
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find(':', begin), path.size());
    if (end > begin && can_run(std::filesystem::path(path.substr(begin, end - begin)) / "raycombine"))
      return "raycombine";
    begin = end + 1;
  }
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path beside = self.parent_path() / "raycombine";
  if (error || !can_run(beside)) throw Error(ErrorCode::file_access, "raycombine: not found in PATH");
  return cli::shell_quoted(beside.string());
}

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  return lines;
}

void write_lines(const std::filesystem::path& file, const std::vector<std::string>& lines) {
  std::error_code error;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
  AtomicFile output(file);
  for (const std::string& line : lines)
    output.write(line + '\n');
  output.commit();
}

bool is_attribute(const std::string& line) {
  const std::size_t begin = line.find_first_not_of(" \t");
  const std::size_t end = line.find_last_not_of(" \t\r");
  return begin != std::string::npos && line.substr(begin, end - begin + 1) == kAttribute;
}

}  // namespace

std::filesystem::path install_git_driver(GitScope scope) {
  const std::filesystem::path file = attributes_file(scope);
  const std::string driver = raycombine_program() + " %O all %A %B -o %A";
  git_must({"config", scope_option(scope), "merge.plymerge.name", "merge ray clouds"});
  git_must({"config", scope_option(scope), "merge.plymerge.driver", driver});
  std::vector<std::string> lines = lines_of(file);
  if (std::none_of(lines.begin(), lines.end(), is_attribute)) {
    lines.emplace_back(kAttribute);
    write_lines(file, lines);
  }
  return file;
}

std::filesystem::path uninstall_git_driver(GitScope scope) {
  const std::filesystem::path file = attributes_file(scope);
  if (git({"config", scope_option(scope), "--get-regexp", "^merge\\.plymerge\\."}).status == 0)
    git_must({"config", scope_option(scope), "--remove-section", "merge.plymerge"});
  std::vector<std::string> lines = lines_of(file);
  if (std::erase_if(lines, is_attribute) > 0) write_lines(file, lines);
  return file;
}

}  // namespace ray::tools
