#include "decimation_note.h"
#include "steps.h"

#include <raycloud/filter/decimate.h>

#include <cstdint>
#include <limits>

namespace ray::tools {
namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "raydecimate",
    .summary = "thin a ray cloud",
    .description =
        R"(Keeps fewer rays, each of them exactly as it was, with all its columns. In the first form the rays
are those that come first in the file in each cube of a grid with the given width, so that what was
seen often and what was seen rarely become equally dense. The grid is fixed in space: cubes start at
multiples of the width. The end of an unbounded ray counts as any other. The edits that are made to
such a cloud, or to one of every Nth ray, `rayrestore` brings back to the full cloud.

With `points`, as many rays stay in each cube. With `cm/ray`, a ray goes if other rays crossed every
cube on its way before it: all the space that was seen stays seen. With `cm/m`, the width of the cubes
goes with the range of each ray, in steps of two: what was near the sensor stays dense.)",
    .usages = {{.name = "width",
                .words = {cloud(), length("WIDTH")},
                .help = "the first ray that ends in each cube of this width",
                .example = "raydecimate cloud.ply 4 cm"},
               {.name = "every",
                .words = {cloud(), count("N", "ray")},
                .help = "every Nth ray, starting with the first",
                .example = "raydecimate cloud.ply 10 rays"},
               {.name = "count",
                .words = {cloud(), length("WIDTH"), count("N", "point")},
                .help = "the first N rays that end in each cube",
                .example = "raydecimate cloud.ply 20 cm 64 points"},
               {.name = "paths",
                .words = {cloud(), length_per("WIDTH", "ray")},
                .help = "the rays that cross a cube which none before them crossed",
                .example = "raydecimate cloud.ply 20 cm/ray"},
               {.name = "range",
                .words = {cloud(), length_per("WIDTH", "m")},
                .help = "a spacing in proportion to the range of the ray",
                .example = "raydecimate cloud.ply 3 cm/m"}},
    .options = {output_option("CLOUD_decimated.ply"), view_option()},
    .writes = "CLOUD_decimated.ply",
    .memory =
        R"(At most 18 bytes for each ray that is kept with a width, 27 for each cube with `points`, 36 for each 4
by 4 by 4 cubes that are crossed with `cm/ray`, about 40 for each ray that is kept with `cm/m`; less than
200 MB besides. Where that is more than --memory allows, the cloud is read several times, and every ray
takes one bit.)",
    .see_also = {"rayrestore", "rayinfo", "rayrender"}};

StreamCounts decimate(const Match& match, const Context& context, RaySource& source, RaySink& sink) {
  const std::string& usage = match.usage();
  const auto n = [&] { return static_cast<std::uint64_t>(match.integer("N")); };
  if (usage == "every") return decimate_every(context, source, sink, n());
  const Metres width = match.length("WIDTH");
  if (usage == "count") return decimate_to_count(context, source, sink, width, n());
  if (usage == "paths") return decimate_paths(context, source, sink, width);
  if (usage == "range") return decimate_by_range(context, source, sink, width.value);
  return decimate_voxels(context, source, sink, width);
}

StepReport run(const Match& match, const Context& context, RaySource& source, const SinkMaker& make) {
  constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (match.usage() == "count" && match.integer("N") > kMost)
    match.reject("N", "a cube keeps at most " + std::to_string(kMost) + " points");
  CloudInfo info = source.info();
  const std::string note = decimation_note(match, info.ray_count);
  info.comments.push_back(note);
  RaySink& sink = make(0, info);
  const StreamCounts counts = decimate(match, context, source, sink);
  if (!info.ray_count) sink.amend(note, decimation_note(match, counts.rays_in + counts.dropped));
  return report_of(counts);
}

}  // namespace

const Step kDecimateStep{.command = kCommand,
                         .outputs = {{"", "_decimated"}},
                         .run = run,
                         .keeps_places = [](const Match&) { return true; },
                         .tells_count = true};

}  // namespace ray::tools
