#pragma once
/// Makes git merge ray clouds with raycombine (paper, section VI-B).

#include <filesystem>

namespace ray::tools {

enum class GitScope { user, repository };

/// Sets the merge driver `plymerge` in the configuration of git, and `*.ply merge=plymerge` in the file of
/// attributes that goes with it, and returns that file. Whatever else is there stays; doing it again changes
/// nothing. Throws Error(file_access) where git is missing or refuses, or the file cannot be written.
std::filesystem::path install_git_driver(GitScope scope);

/// Takes both out again.
std::filesystem::path uninstall_git_driver(GitScope scope);

}  // namespace ray::tools
