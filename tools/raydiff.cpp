#include "cli/cli.h"
#include "cloud_to_cloud.h"
#include "combine_maps.h"
#include "diff_report.h"
#include "step.h"

#include <raycloud/core/error.h>
#include <raycloud/io/ray_cloud_file.h>

#include <system_error>

namespace {

using namespace ray::cli;
using std::filesystem::path;
using Sources = std::vector<std::unique_ptr<ray::RaySource>>;

const Command kCommand{
    .name = "raydiff",
    .summary = "what came and what went between two ray clouds",
    .description =
        R"(Compares two clouds of one place, aligned with each other, and gives each end one of four classes:

  same        an end of the other cloud is within the distance D
  removed     only the first cloud has it, and the rays of the second one saw through its place
  added       only the second cloud has it, and the rays of the first one saw through its place
  unobserved  only one has it, and the other one did not look there: that is no difference

A place is seen through as for `raycombine min`: by 10 rays, divided by its opacity, that go on well behind
it. D is three times the mean spacing of the points, or 5 cm if that is more, unless given.

The result is one cloud with all rays of both. What was removed has turned towards (255,0,127), what was
added towards (0,255,127), half of it at D from the other cloud and all at 2 D; what is unobserved is grey
and what is the same has its own colour. The column `difference` is 1 for same, 2 for removed, 3 for added
and 4 for unobserved. Rays that hit nothing have no class: they keep their colour, and 0.

The table tells, for each class, how many rays end there, the area of the surfaces and the volume of the
cubes of width D that hold the ends. The similarity is the area of what is the same, as the mean of both
clouds, as a part of that and the area of what was removed and added. With `--json` it is one object,
with the keys `same`, `removed`, `added` and `unobserved`, each with `rays`, `area` and `volume`, and
`similarity`, null where neither cloud saw the places of the other, `distance` and `left_out`.)",
    .usages = {{.words = {cloud("CLOUD1"), cloud("CLOUD2")},
                .help = "from the first to the second",
                .example = "raydiff monday.ply tuesday.ply"}},
    .options = {{.name = "distance",
                 .value = length("D"),
                 .help = "ends that are as near to the other cloud are the same"},
                {.name = "individual",
                 .help = "a cloud for each: CLOUD1_diff.ply and CLOUD2_diff.ply, with their own columns"},
                {.name = "json", .help = "print a JSON object instead of the table, and nothing else"},
                output_option("CLOUD1_diff.ply"),
                view_option(),
                {.name = "rays",
                 .value = integer("N", {.least = 1}),
                 .help = "so many rays must see through what is removed or added",
                 .fallback = "10",
                 .advanced = true}},
    .writes = "CLOUD1_diff.ply, after the name of the first cloud, and a table to standard output",
    .memory =
        "140 bytes for each ray of the larger cloud and 20 for each of both, or if that is more than --memory allows, "
        "that and 40 to 80 MB, in temporary files, and 6 bytes for each ray of both.",
    .see_also = {"raycombine", "raytransients", "rayinfo"}};

bool same_place(const path& a, const path& b) {
  return std::filesystem::weakly_canonical(a) == std::filesystem::weakly_canonical(b);
}

/// No output takes the place of a cloud or of the other output.
std::vector<path> outputs_of(const Match& match) {
  const path first = match.text("CLOUD1"), second = match.text("CLOUD2");
  if (match.has("--individual") && match.has("--output"))
    match.reject("--output", "with --individual there are two clouds, named after the two that are read");
  std::vector<path> outputs{main_output(match, first, "_diff")};
  if (match.has("--individual")) {
    outputs.push_back(output_name(second, "_diff"));
    if (same_place(outputs[0], outputs[1])) outputs[1] = output_name(second, "_diff_2");
  }
  for (const path& output : outputs)
    for (const char* word : {"CLOUD1", "CLOUD2"}) {
      std::error_code error;
      if (same_place(output, match.text(word)) ||
          std::filesystem::equivalent(output, match.text(word), error))
        match.reject(match.has("--output") ? "--output" : word,
                     "the result would take the place of " + match.text(word) +
                         (match.has("--individual") ? "" : ": choose another name with --output"));
    }
  return outputs;
}

/// The differences of both clouds, into one file or into one for each.
ray::StreamCounts write(const ray::CloudComparison& comparison, const std::vector<ray::CloudInfo>& infos,
                        const Sources& sources, const std::vector<path>& outputs, Session& session) {
  ray::tools::OutputPrecision precision(outputs.size());
  while (true) {
    try {
      std::vector<std::unique_ptr<ray::RaySink>> sinks;
      for (std::size_t i = 0; i < outputs.size(); ++i)
        sinks.push_back(
            precision.watch(i, ray::create_ray_cloud(outputs[i], precision.widened(i, infos[i]))));
      ray::StreamCounts counts;
      for (std::size_t i = 0; i < sources.size(); ++i) {
        ray::RaySink& sink = *sinks[outputs.size() == 1 ? 0 : i];
        const ray::StreamCounts of_cloud = write_differences(session.context(), *sources[i],
                                                             comparison.clouds[i], comparison.distance, sink);
        counts.rays_in += of_cloud.rays_in;
        counts.rays_out += of_cloud.rays_out;
      }
      for (const auto& sink : sinks)
        sink->finish();
      return counts;
    } catch (const ray::PrecisionLoss&) {
      for (const auto& source : sources)
        source->rewind();  // each time one more of the outputs is double
    }
  }
}

void run(const Match& match, Session& session) {
  const std::vector<path> outputs = outputs_of(match);
  const std::vector<std::string> files{match.text("CLOUD1"), match.text("CLOUD2")};
  const ray::CombinedSource both = ray::tools::open_all(files);
  for (const std::string& warning : both.warnings())
    session.warn(warning);
  Sources sources;
  std::vector<ray::CloudInfo> infos;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const bool alone = outputs.size() > 1;
    sources.push_back(alone ? ray::open_ray_cloud(files[i]) : both.alone(i));
    infos.push_back(alone ? sources.back()->info() : both.info());
    infos.back().extras = ray::difference_columns(std::move(infos.back().extras));
    infos.back().history.push_back(session.history());
  }
  const ray::CloudComparison comparison =
      compare_clouds(session.context(), *sources[0], *sources[1],
                     {.distance = match.has("--distance") ? match.length("--distance").value : 0.0,
                      .rays = static_cast<double>(match.integer("--rays"))});
  const ray::StreamCounts counts = write(comparison, infos, sources, outputs, session);
  session.print(match.has("--json") ? ray::tools::as_json(comparison) : ray::tools::as_text(comparison));
  session.view(outputs.front());
  if (match.has("--json")) return;
  ray::tools::note_dropped(session, comparison.dropped);
  session.summary({.rays_in = counts.rays_in, .rays_out = counts.rays_out, .files = outputs});
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
