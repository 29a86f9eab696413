#pragma once
/// Opening a result for --view.

#include <filesystem>

namespace ray::cli {

/// Starts the command in $RAYCLOUD_VIEWER (it may have arguments), or else the first of CloudCompare and
/// MeshLab that is found, with the file as its last argument, without waiting for it. False if there is none
/// that starts.
[[nodiscard]] bool open_viewer(const std::filesystem::path& file);

}  // namespace ray::cli
