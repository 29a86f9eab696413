#include "cli/cli.h"
#include "cloud_to_cloud.h"
#include "decimation_note.h"

#include <raycloud/filter/restore.h>
#include <raycloud/io/ray_cloud_file.h>

#include <algorithm>
#include <sstream>

namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "rayrestore",
    .summary = "apply the edits of a thinned ray cloud to the full one",
    .description =
        R"(Thin a large cloud with `raydecimate`, work on the small result with any commands, and bring what
was done back to the full cloud: the width, or the number of rays, is that of the `raydecimate`. Where a
ray was removed, all rays of its cube go (or, of every Nth ray, the N rays that it stands for); where it
got another colour, intensity or value of a column, or became bounded or unbounded, so do they. Rays that
were added are added as they are. A motion of the cloud, or of some of its rays, is found from all of
them; it must be rigid to 1 cm. Without any edits the result is the full cloud, bit for bit.

Rays are known by their times, which must be as they were. With `--nonrigid` rays that were moved in
different ways, by smoothing say, take those around them along.)",
    .usages = {{.name = "width",
                .words = {cloud("DECIMATED"), length("WIDTH"), cloud("FULL")},
                .help = "DECIMATED was made by `raydecimate FULL WIDTH cm`, and edited",
                .example = "rayrestore cloud_decimated.ply 10 cm cloud.ply"},
               {.name = "every",
                .words = {cloud("DECIMATED"), count("N", "ray"), cloud("FULL")},
                .help = "DECIMATED was made by `raydecimate FULL N rays`, and edited",
                .example = "rayrestore cloud_decimated.ply 10 rays cloud.ply"}},
    .options = {output_option("FULL_restored.ply"),
                {.name = "nonrigid", .help = "interpolate moves that are no rigid motion"},
                view_option()},
    .writes = "FULL_restored.ply",
    .memory =
        R"(About 200 bytes, and three times the extra columns, for each ray that `raydecimate` kept; less than
200 MB besides.)",
    .see_also = {"raydecimate"}};

std::string report(const ray::EditSummary& edits) {
  std::ostringstream text;
  text << edits.kept << " rays found again, " << edits.removed << " removed, " << edits.added << " added";
  const auto tell = [&](std::uint64_t count, const char* what) {
    if (count > 0) text << ", " << count << what;
  };
  tell(edits.moved, edits.nonrigid ? " moved, not rigidly" : " moved");
  tell(edits.recoloured, " recoloured");
  tell(edits.rebounded, " made bounded or unbounded");
  tell(edits.revalued, " with new values");
  return text.str();
}

/// The full cloud's, then what the decimated cloud's tells of the edits.
void join_history(ray::CloudInfo& full, const ray::CloudInfo& decimated, const std::string& restore) {
  full.history.pop_back();  // this command comes last
  const auto common = std::mismatch(full.history.begin(), full.history.end(), decimated.history.begin(),
                                    decimated.history.end());
  full.history.insert(full.history.end(), common.second, decimated.history.end());
  full.history.push_back(restore);
}

void run(const Match& match, Session& session) {
  const std::string& full_name = match.text("FULL");
  const std::string& decimated_name = match.text("DECIMATED");
  const auto decimated = ray::open_ray_cloud(decimated_name);
  const auto full = ray::open_ray_cloud(full_name);
  ray::tools::check_decimation(decimated->info(), decimated_name,
                               ray::tools::decimation_note(match, full->info().ray_count));
  const auto decimation =
      match.usage() == "width"
          ? ray::Decimation{match.length("WIDTH")}
          : ray::Decimation{ray::EveryNth{static_cast<std::uint64_t>(match.integer("N"))}};
  const ray::Restoration restoration(session.context(), *decimated, *full, decimation,
                                     {.nonrigid = match.has("--nonrigid")});
  session.note(report(restoration.edits()));
  ray::tools::run_cloud_to_cloud(session,
                                 {.input = full_name,
                                  .output = main_output(match, full_name, "_restored"),
                                  .describe =
                                      [&](ray::CloudInfo& info) {
                                        info.extras = restoration.extras();
                                        join_history(info, decimated->info(), session.history());
                                      }},
                                 [&](ray::RaySource& source, ray::RaySink& sink) {
                                   return restoration.apply(session.context(), source, sink);
                                 });
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
