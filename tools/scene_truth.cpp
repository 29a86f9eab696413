#include "scene_truth.h"

#include <raycloud/io/atomic_file.h>
#include <raycloud/io/mesh_file.h>
#include <raycloud/io/tree_file.h>

#include <charconv>
#include <cmath>
#include <initializer_list>

namespace ray::tools {
namespace {

/// The shortest decimal that reads back to the same bits.
std::string text_of(double value) {
  if (std::isinf(value)) return value < 0.0 ? "-.inf" : ".inf";
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

std::string list_of(std::initializer_list<double> values) {
  std::string text = "[";
  for (const double value : values)
    text += (text.size() > 1 ? ", " : "") + text_of(value);
  return text + "]";
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string labels() {
  std::string text = "labels:\n";
  for (int number = 0; number <= static_cast<int>(SceneLabel::vehicle); ++number)
    text += "  " + std::to_string(number) + ": " + label_name(static_cast<SceneLabel>(number)) + "\n";
  return text;
}

std::string scan_parameters(const Scene& scene, const SimulationOptions& options) {
  std::string text = "scene: " + scene.kind + "\nseed: " + std::to_string(scene.seed) +
                     "\nrays: " + std::to_string(options.rays) + "\n";
  text += "range_limit: " + text_of(options.range) + "  # m; beyond it a ray is unbounded\n";
  text += "range_noise: " + text_of(options.noise) + "  # m, sigma, Gaussian along the ray\n";
  text += "duration: " + text_of(scene.path.times.back() - scene.path.times.front()) + "  # s\n";
  if (const auto* spinning = std::get_if<SpinningScanner>(&options.scanner))
    return text + "scanner: spinning\nbeams: " + std::to_string(spinning->beams) + "\n";
  text += "scanner: standing\nstations:\n";
  for (const Eigen::Vector3d& station : scene.stations)
    text += "  - " + list_of({station.x(), station.y(), station.z()}) + "\n";
  return text;
}

std::string facts(const Scene& scene) {
  std::string text = "facts:\n";
  for (const SceneFact& fact : scene.facts) {
    text +=
        "  " + fact.name + ": " + text_of(fact.value) + (fact.unit.empty() ? "" : "  # " + fact.unit) + "\n";
  }
  return scene.facts.empty() ? "facts: {}\n" : text;
}

std::string motion_of(const SceneObject& object) {
  std::string text =
      "    motion:  # time x y z qw qx qy qz, mesh to world; in the scene's mesh as in the first row\n";
  for (std::size_t i = 0; i < object.motion.size(); ++i) {
    const Eigen::Vector3d& p = object.motion.positions[i];
    const Eigen::Quaterniond q =
        object.motion.orientations.empty() ? Eigen::Quaterniond::Identity() : object.motion.orientations[i];
    text += "      - " + list_of({object.motion.times[i], p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}) +
            "\n";
  }
  return text;
}

std::string objects(const Scene& scene) {
  std::string text = "objects:\n";
  for (const SceneObject& object : scene.objects) {
    text += "  - id: " + std::to_string(object.id) + "\n    label: " + label_name(object.label) +
            "\n    name: " + quoted(object.name) + "\n";
    if (!object.is_transient()) continue;
    text += "    present: " + list_of({object.present.first, object.present.second}) + "  # s, from, until\n";
    if (!object.motion.empty()) text += motion_of(object);
  }
  return text;
}

std::string pose_errors(const Drift& drift) {
  if (drift.empty()) return "pose_errors: []\n";
  std::string text = "pose_errors:  # time dx dy dz (m) yaw (rad) of the written pose, linear in between\n";
  for (std::size_t i = 0; i < drift.times.size(); ++i) {
    const Eigen::Vector3d& offset = drift.offsets[i];
    text += "  - " + list_of({drift.times[i], offset.x(), offset.y(), offset.z(), drift.yaws[i]}) + "\n";
  }
  return text;
}

std::filesystem::path beside(const std::filesystem::path& cloud, const std::string& ending) {
  return cloud.parent_path() / (cloud.stem().string() + ending);
}

}  // namespace

std::vector<std::filesystem::path> truth_files(const Scene& scene, const std::filesystem::path& cloud) {
  std::vector<std::filesystem::path> files{beside(cloud, "_truth.yaml"), beside(cloud, "_scene.ply")};
  if (!scene.ground.empty()) files.push_back(beside(cloud, "_ground.ply"));
  if (!scene.forest.trees.empty()) files.push_back(beside(cloud, "_trees.txt"));
  return files;
}

void write_truth(const Scene& scene, const SimulationOptions& options, const std::string& command,
                 const std::filesystem::path& cloud) {
  write_mesh(beside(cloud, "_scene.ply"), scene_mesh(scene));
  if (!scene.ground.empty()) write_mesh(beside(cloud, "_ground.ply"), scene.ground);
  if (!scene.forest.trees.empty()) write_trees(beside(cloud, "_trees.txt"), scene.forest);
  AtomicFile yaml(beside(cloud, "_truth.yaml"));
  yaml.write("command: " + quoted(command) + "\n" + scan_parameters(scene, options) + labels() +
             facts(scene) + pose_errors(options.drift) + objects(scene));
  yaml.commit();
}

}  // namespace ray::tools
