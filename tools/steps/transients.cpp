#include "cli/grouped.h"
#include "steps.h"

#include <raycloud/volume/transients.h>

#include <algorithm>
#include <array>

namespace ray::tools {
namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "raytransients",
    .summary = "take out what came, went or moved while the cloud was scanned",
    .description =
        R"(Sorts the rays of a cloud into what is fixed and what is transient: what other rays have seen through,
before it came or after it had gone. N rays, divided by the opacity of the place, must have passed in a
row. More rays make it more careful: hedges and wire fences stay, as nearly all rays pass them all the
time. What to do where rays contradict each other is one word:

  min     take out what was seen through: what stays was there all the time
  max     take out the rays that saw through: everything that was ever there stays
  oldest  as it was at first: take out what came later, and the rays that saw through what had gone
  newest  as it was at last: take out what had gone, and the rays that saw through what came later

Every ray gets the columns `opacity`, `hits` and `passes` of the place where it ends, and `transience`, the
number N above which it would be fixed: to see what another N gives, sort by that column.

The rays must have their times. A ray that proves a place empty goes on well behind it, so the noise of the
scanner and some centimetres of error in the map do no harm.)",
    .usages = {{.name = "transients",
                .words = {choice("KIND", {"min", "max", "oldest", "newest"}), cloud(), count("N", "ray")},
                .help = "N rays in a row see through what is transient",
                .example = "raytransients min cloud.ply 10 rays"}},
    .options = {{.name = "colour",
                 .help = "show the evidence: red for passes, green for opacity, blue for transience"},
                output_option("CLOUD_fixed.ply; the other gets the same name with _transient"),
                view_option(),
                {.name = "paper",
                 .help = "the plain rule of the paper: every ray that crosses a place counts, and each place "
                         "by itself",
                 .advanced = true}},
    .writes = "CLOUD_fixed.ply and CLOUD_transient.ply",
    .memory =
        "130 bytes a ray. Where that is more than --memory allows, ellipsoids and rays go to temporary files in "
        "TMPDIR or /var/tmp, 300 bytes a ray or so, and blocks of space are worked on one after the other; the "
        "result is the same. Then some 10 bytes a ray are needed besides, 14 for max, oldest and newest.",
    .see_also = {"raydenoise", "raycombine", "raysplit"}};

TransientRule rule_of(const Match& match) {
  static constexpr std::array kWords{"min", "max", "oldest", "newest"};
  const auto word = std::find(kWords.begin(), kWords.end(), match.text("KIND")) - kWords.begin();
  return {.merge = static_cast<Merge>(word),
          .rays = static_cast<double>(match.integer("N")),
          .paper = match.has("--paper"),
          .colour = match.has("--colour")};
}

StepReport run(const Match& match, const Context& context, RaySource& source, const SinkMaker& make) {
  CloudInfo info = source.info();
  info.extras = transient_columns(std::move(info.extras));
  RaySink& fixed = make(0, info);
  const TransientCounts counts = split_transients(context, source, fixed, make(1, info), rule_of(match));
  return {.counts = counts.stream, .rays_out = {counts.fixed, counts.transient}, .notes = {}};
}

}  // namespace

const Step kTransientsStep{
    .command = kCommand, .outputs = {{"fixed", "_fixed"}, {"transient", "_transient"}}, .run = run};

}  // namespace ray::tools
