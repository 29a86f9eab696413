#include "cli/cli.h"
#include "cloud_to_cloud.h"
#include "combine_maps.h"

#include <raycloud/core/error.h>
#include <raycloud/filter/combine.h>
#include <raycloud/io/ray_cloud_file.h>

#include <utility>

namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "raycombine",
    .summary = "put ray clouds together",
    .description =
        R"(Writes one cloud of several, one after the other, each ray as it was. `all` takes every ray. The other
words merge maps: where N rays of one cloud, divided by the opacity of the place, have seen through what
another cloud holds, one of the two gives way:

  min     what was seen through goes: what stays is in all of them
  max     the rays that saw through it go: everything that is in one of them stays
  oldest  what was seen earlier at that place stays
  newest  what was seen later there stays
  order   what an earlier cloud of the command line says stays

What gave way is in the second file. A ray that several clouds have comes once. The clouds must lie on each
other to better than 5 cm; what is 5 cm apart counts as changed.

With a BASE, the map from which both clouds were made, rays that both still have stay, rays that one of
them removed are gone, and what the two added is put together. A ray of which anything was changed, its
colour too, is a new one; where both changed it in different ways, both stay. `raycloud git install` makes
git merge maps so.

The clouds may have different columns: the result has the columns of all, and where a cloud lacks one it
is filled with 0, or NaN for real numbers. It is in double precision if one of the clouds is.

With `--join` the pieces of rays that `raysplit` cut become whole rays again: ends and all columns exactly,
starts to rounding. The column `clipped` goes away with the last piece.)",
    .usages = {{.name = "all",
                .words = {optional(literal("all")), clouds()},
                .help = "every ray of every cloud",
                .example = "raycombine cloud1.ply cloud2.ply -o both.ply"},
               {.name = "merge",
                .words = {choice("KIND", {"min", "max", "oldest", "newest", "order"}), clouds(),
                          count("N", "ray")},
                .help = "one map; N rays of another cloud see through what has changed",
                .example = "raycombine newest monday.ply tuesday.ply 10 rays"},
               {.name = "three",
                .words = {cloud("BASE"), literal("all"), cloud("CLOUD1"), cloud("CLOUD2")},
                .help = "what two people have made of one map",
                .example = "raycombine map.ply all mine.ply yours.ply"},
               {.name = "three by rays",
                .words = {cloud("BASE"), choice("KIND", {"min", "max", "oldest", "newest", "order"}),
                          cloud("CLOUD1"), cloud("CLOUD2"), count("N", "ray")},
                .help = "the same; what they have added is merged as above",
                .example = "raycombine map.ply newest mine.ply yours.ply 10 rays"}},
    .options = {output_option("CLOUD1_combined.ply"),
                {.name = "join",
                 .help = "make whole rays of the pieces that raysplit cut",
                 .usages = {"all"}},
                view_option(),
                {.name = "paper",
                 .help = "the plain rule of the paper: every ray that crosses a place counts, and each place "
                         "by itself",
                 .advanced = true,
                 .usages = {"merge", "three by rays"}}},
    .writes =
        "CLOUD1_combined.ply, after the name of the first file; merging by rays also "
        "CLOUD1_differences.ply, unless the result takes the place of one of the clouds",
    .memory =
        "Less than 200 MB for any number of clouds of any size. `--join` takes 200 bytes for each piece "
        "besides. Merging takes 140 bytes for each ray of the largest cloud, or if that is more than --memory "
        "allows, that and 40 to 80 MB, in temporary files; and 8 bytes for each ray of all clouds, with BASE all "
        "5.",
    .see_also = {"raysplit", "raytransients", "rayrestore"}};

std::string number_of(std::uint64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

void combine(const Match& match, Session& session) {
  const std::vector<std::string>& files = match.files("CLOUDS");
  const std::filesystem::path output = main_output(match, files.front(), "_combined");
  ray::CombinedSource source = ray::tools::open_all(files);
  ray::tools::tell_of(source, session);
  ray::CloudInfo info = source.info();
  info.history.push_back(session.history());

  std::shared_ptr<const ray::JoinPlan> plan;
  if (match.has("--join")) {
    plan = plan_join(session.context(), source);
    info.extras = join_columns(*plan, std::move(info.extras));
    source.rewind();
  }
  ray::JoinCounts counts;
  const auto write_once = [&] {
    const auto sink = ray::create_ray_cloud(output, info);
    if (plan) {
      counts = join_pieces(session.context(), source, *sink, *plan);
    } else {
      counts.stream = stream_each(session.context(), source, *sink, [](const ray::RayCloud&) {});
    }
    sink->finish();
  };
  try {
    write_once();
  } catch (const ray::PrecisionLoss&) {
    source.rewind();
    info.precision = ray::Precision::double_;
    write_once();
  }
  ray::tools::note_dropped(session, counts.stream.dropped);
  if (plan) {
    session.note(number_of(counts.joined, "ray") + " joined, " + number_of(counts.left, "piece") +
                 " without a neighbour left");
  }
  session.summary({.rays_in = counts.stream.rays_in, .rays_out = counts.stream.rays_out, .files = {output}});
}

void merge(const Match& match, Session& session) {
  const std::vector<std::string>& files = match.files("CLOUDS");
  const std::string& kind = match.text("KIND");
  if (files.size() == 1)
    match.reject("CLOUDS", kind + " merges two clouds or more; within one it is for raytransients");
  ray::tools::merge_files(match, session, files,
                          {.merge = ray::tools::merge_of(kind),
                           .rays = static_cast<double>(match.integer("N")),
                           .paper = match.has("--paper")});
}

void merge_three(const Match& match, Session& session) {
  const bool by_rays = match.usage() != "three";
  ray::MergeRule rule{.merge = ray::CloudMerge::all};
  if (by_rays)
    rule = {.merge = ray::tools::merge_of(match.text("KIND")),
            .rays = static_cast<double>(match.integer("N")),
            .paper = match.has("--paper")};
  ray::tools::merge_branches(match, session, {match.text("BASE"), match.text("CLOUD1"), match.text("CLOUD2")},
                             rule);
}

void run(const Match& match, Session& session) {
  if (match.usage() == "all")
    combine(match, session);
  else if (match.usage() == "merge")
    merge(match, session);
  else
    merge_three(match, session);
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
