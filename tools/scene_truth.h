#pragma once
/// What `raycreate --truth` writes beside a cloud.

#include <raycloud/synth/scene.h>
#include <raycloud/synth/simulate.h>

#include <filesystem>
#include <string>
#include <vector>

namespace ray::tools {

/// The files of the truth beside `cloud`: CLOUD_scene.ply, CLOUD_ground.ply (outdoors), CLOUD_trees.txt
/// (where there are trees), CLOUD_truth.yaml.
[[nodiscard]] std::vector<std::filesystem::path> truth_files(const Scene& scene,
                                                             const std::filesystem::path& cloud);

/// Writes them. `command` is the line of the history.
void write_truth(const Scene& scene, const SimulationOptions& options, const std::string& command,
                 const std::filesystem::path& cloud);

}  // namespace ray::tools
