#include "split.h"

#include "split_words.h"
#include "steps.h"

#include <raycloud/core/error.h>

#include <set>

namespace ray::tools {
namespace {

using namespace ray::cli;

std::vector<Usage> usages() {
  std::vector<Usage> all = ray::tools::split_in_two_usages();
  all.push_back({.name = "colours",
                 .words = {cloud(), literal("colour")},
                 .help = "a cloud for each colour, CLOUD_R_G_B.ply",
                 .example = "raysplit cloud.ply colour"});
  all.push_back({.name = "segments",
                 .words = {cloud(), literal("seg_colour")},
                 .help = "a cloud for each colour, CLOUD_N.ply, N = R + 256 G + 65536 B",
                 .example = "raysplit cloud_segmented.ply seg_colour"});
  all.push_back(
      {.name = "grid",
       .words = {cloud(), literal("grid"), vector("WX,WY,WZ[,WT]", kNonNegative),
                 optional(number("OVERLAP", kNonNegative))},
       .help = "a cloud for each cell, CLOUD_X_Y_Z_T.ply; widths in m and s, 0 for an axis not split",
       .example = "raysplit cloud.ply grid 10,10,0 0.5"});
  return all;
}

const Command kCommand{
    .name = "raysplit",
    .summary = "split a ray cloud in two, or into cells",
    .description =
        R"(Splits a cloud into an inside and an outside, or into a cloud for each cell of a grid or each colour.
Every end point is in exactly one of them. A plane, a box, a capsule and a grid are regions of space:
rays that cross the border are cut there. Each piece keeps all columns; those without the end of the ray
become unbounded. The extra column `clipped` marks pieces (1: cut at the start, 2: at the end, 3: at both,
0: a whole ray), and `raycombine --join` makes them rays again. The other forms are properties of a ray
or of its end point and sort rays whole.

Grid cells are centred on the origin: cell i spans (i - 1/2) w to (i + 1/2) w, and the names of the files have
the indices of the axes that are split. With an overlap each cell grows by half of it on every side, so
rays near a border are in several clouds. The distance from a mesh has a sign: above an open mesh and outside
a closed one it is positive, so what lies within half a metre above a ground is outside of `distance 0.5`.
In `gap`, unbounded rays are outside. `colour` and `raydir`
compare the part of the vector along the one given: half of red is `colour 0.5,0,0`, rays steeper than 53
degrees upwards are outside of `raydir 0,0,0.8`.)",
    .usages = usages(),
    .options = {output_option("CLOUD_inside.ply"), view_option()},
    .writes = "CLOUD_inside.ply and CLOUD_outside.ply, or a cloud for each cell or colour",
    .memory =
        "Less than 200 MB for any cloud, and some kilobytes for each cloud written. `gap` takes 96 bytes "
        "for each bounded ray, a mesh 400 bytes for each face.",
    .see_also = {"raycombine", "raydecimate"}};

StepReport run(const Match& match, const Context& context, RaySource& source, const SinkMaker& make) {
  if (splits_in_parts(match))
    throw Error(ErrorCode::usage,
                "split " + match.usage() + " makes many clouds, so it is no step of a pipe");
  StepReport report;
  const SplitRulePtr rule = split_rule(match, context, source, report.notes);
  CloudInfo info = source.info();
  info.extras = rule->columns(std::move(info.extras));
  RaySink& inside = make(0, info);
  const SplitCounts counts = split_cloud(context, source, *rule, inside, make(1, info));
  report.counts = counts.stream;
  report.rays_out = {counts.inside, counts.outside};
  return report;
}

/// Whether rays are judged by what the match says alone; other rules are made from the whole cloud first, or
/// from a file, which would be read again for each piece.
bool by_ray(const Match& match) {
  static const std::set<std::string, std::less<>> kNot{"time_share", "gap", "shape"};
  return !splits_in_parts(match) && !kNot.contains(match.usage());
}

/// The other forms cut those that cross a border.
bool sorts_whole_rays(const Match& match) {
  static const std::set<std::string, std::less<>> kCutting{"plane", "box", "capsule"};
  return !kCutting.contains(match.usage());
}

}  // namespace

bool splits_in_parts(const Match& match) {
  return match.usage() == "grid" || match.usage() == "colours" || match.usage() == "segments";
}

const Step kSplitStep{.command = kCommand,
                      .outputs = {{"inside", "_inside"}, {"outside", "_outside"}},
                      .run = run,
                      .by_ray = by_ray,
                      .keeps_places = sorts_whole_rays};

}  // namespace ray::tools
