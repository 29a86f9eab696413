#include "cli/cli.h"
#include "scene_truth.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/stream.h>
#include <raycloud/io/mesh_file.h>
#include <raycloud/io/ray_cloud_file.h>
#include <raycloud/io/tree_file.h>
#include <raycloud/synth/movers.h>
#include <raycloud/synth/scenes.h>

namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "raycreate",
    .summary = "make a ray cloud of a world that is known exactly",
    .description =
        R"(Builds a scene from a seed, or around the trees or the ground of a file, and scans it: a spinning lidar
is carried through it and each of its beams ends at the first surface. What lies behind is hidden, the
sky gives unbounded rays, and furniture that arrives half-way is seen from then on. The same words give
the same bytes, on every machine.

With `--truth` each ray carries what it hit: `label`, `object_id`, `moving`, the end without noise
`true_x true_y true_z` and the surface's `normal_x normal_y normal_z`; the surfaces, the ground, the
trees and every number of the scene are written beside the cloud.)",
    .usages = {{.name = "seed",
                .words = {choice("WORLD", {"room", "building", "tree", "forest", "terrain", "field"}),
                          integer("SEED", kPositive)},
                .help = "a world of this kind, another for every seed",
                .example = "raycreate building 1"},
               {.name = "trees",
                .words = {literal("forest"), input("TREES", {".txt"})},
                .help = "a forest of these trees, with ground and leaves",
                .example = "raycreate forest trees.txt"},
               {.name = "ground",
                .words = {literal("terrain"), input("MESH", {".ply", ".obj"})},
                .help = "a walk over this ground",
                .example = "raycreate terrain ground.ply"}},
    .options = {output_option("room.ply, building.ply … in this folder"),
                view_option(),
                {.name = "truth", .help = "add columns and files that tell what is true"},
                {.name = "rays",
                 .value = integer("N", kPositive),
                 .help = "how many rays; more scan the same scene more densely",
                 .fallback = "1000000",
                 .advanced = true},
                {.name = "noise",
                 .value = number("METRES", kNonNegative),
                 .help = "standard deviation of the measured range",
                 .fallback = "0.02",
                 .advanced = true},
                {.name = "beams",
                 .value = choice("BEAMS", {"16", "32", "64", "128"}),
                 .help = "of the spinning lidar",
                 .fallback = "32",
                 .advanced = true},
                {.name = "static", .help = "a scanner on a tripod at several stations", .advanced = true},
                {.name = "moving",
                 .value = integer("K", between(1, 100)),
                 .help = "people and vehicles that move, come and go",
                 .advanced = true},
                {.name = "drift",
                 .value = number("METRES", kPositive),
                 .help = "add a slow error of the pose that grows to this",
                 .advanced = true}},
    .writes =
        "room.ply, building.ply … in this folder; with --truth NAME_truth.yaml, NAME_scene.ply, and where there "
        "are such NAME_ground.ply and NAME_trees.txt",
    .memory = "The scene: up to 500 MB for a forest, whatever the number of rays.",
    .see_also = {"rayinfo", "rayrender"}};

/// A number where a file is expected is a seed that is no seed.
void refuse_number(const Match& match, const std::string& word) {
  const bool is_number = match.text(word).find_first_not_of("+-.0123456789") == std::string::npos;
  if (is_number) match.reject(word, "a seed is a whole number of 1 or more");
}

ray::Scene scene_of(const Match& match) {
  if (match.usage() == "trees") {
    refuse_number(match, "TREES");
    const ray::Forest trees = ray::read_trees(match.text("TREES"));
    if (trees.trees.empty())
      throw ray::Error(ray::ErrorCode::no_data, match.text("TREES") + ": has no trees");
    return forest_scene(trees, 1);
  }
  if (match.usage() == "ground") {
    refuse_number(match, "MESH");
    return terrain_scene(ray::read_mesh(match.text("MESH")));
  }
  return make_scene(*ray::scene_kind(match.text("WORLD")), static_cast<std::uint64_t>(match.integer("SEED")));
}

ray::SimulationOptions options_of(const Match& match, const ray::Scene& scene) {
  ray::SimulationOptions options;
  options.rays = static_cast<std::uint64_t>(match.integer("--rays"));
  options.noise = match.number("--noise");
  options.truth = match.has("--truth");
  options.seed = scene.seed;
  if (match.has("--static")) {
    if (match.has("--beams")) match.reject("--beams", "a static scanner has no beams to choose");
    options.scanner = ray::StandingScanner{};
  } else {
    options.scanner = ray::SpinningScanner{.beams = std::stoi(match.text("--beams"))};
  }
  if (match.has("--drift")) {
    const auto& times = scene.path.times;
    options.drift = ray::make_drift({times.front(), times.back()}, match.number("--drift"), scene.seed);
  }
  return options;
}

void refuse_to_replace(const std::filesystem::path& input,
                       const std::vector<std::filesystem::path>& outputs) {
  for (const auto& output : outputs) {
    std::error_code none;
    if (!std::filesystem::equivalent(input, output, none)) continue;
    throw ray::Error(ray::ErrorCode::file_access,
                     output.string() + " is the input: choose another name with --output");
  }
}

std::uint64_t write_scan(const std::filesystem::path& output, const ray::Scene& scene,
                         const ray::SimulationOptions& options, Session& session) {
  const auto scan = simulate(scene, options);
  ray::CloudInfo info = scan->info();
  info.history.push_back(session.history());
  const auto write = [&] {
    const auto sink = create_ray_cloud(output, info);
    const auto counts = stream_each(session.context(), *scan, *sink, [](ray::RayCloud&) {});
    sink->finish();
    return counts.rays_out;
  };
  try {
    return write();
  } catch (const ray::PrecisionLoss&) {
    scan->rewind();
    info.precision = ray::Precision::double_;
    return write();
  }
}

void run(const Match& match, Session& session) {
  ray::Scene scene = scene_of(match);
  const auto output = main_output(match, scene.kind + ".ply", "");
  std::vector<std::filesystem::path> files{output};
  if (match.has("--truth")) {
    for (auto& file : ray::tools::truth_files(scene, output))
      files.push_back(std::move(file));
  }
  if (!match.first_input().empty()) refuse_to_replace(match.first_input(), files);
  if (match.has("--moving")) {
    const auto standing = scene.objects.size();
    const auto wanted = match.integer("--moving");
    const std::uint64_t seed = scene.seed;
    scene = with_movers(std::move(scene), static_cast<int>(wanted), seed);
    const auto placed = static_cast<std::int64_t>(scene.objects.size() - standing);
    if (placed < wanted)
      session.warn("there was room for " + std::to_string(placed) + " of " + std::to_string(wanted) +
                   " movers");
  }
  const ray::SimulationOptions options = options_of(match, scene);
  const std::uint64_t rays = write_scan(output, scene, options, session);
  if (match.has("--truth")) ray::tools::write_truth(scene, options, session.history(), output);
  session.summary({.rays_out = rays, .files = files});
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
