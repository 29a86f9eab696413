#include "steps.h"

#include <raycloud/filter/smooth.h>

namespace ray::tools {
namespace {

using namespace ray::cli;

const Command kSmoothCommand{
    .name = "raysmooth",
    .summary = "move end points onto the surface they are samples of",
    .description =
        R"(Moves each end to the surface that its nearest neighbours tell of: along the ray where the surface
faces it, as noise of the range is along the ray, else along the normal of the surface. Only neighbours
seen from the same side count, so the two sides of a thin wall stay apart. Round things keep their
radius if their points are several times closer together than that. Starts, and everything else, stay
as they are; so do ends without neighbours.

rayrestore cannot bring this change to a full cloud, unless it is told --nonrigid: smooth the full one.)",
    .usages = {{.name = "smooth", .words = {cloud()}, .help = "all of it", .example = "raysmooth cloud.ply"}},
    .options = {output_option("CLOUD_smooth.ply"), view_option()},
    .writes = "CLOUD_smooth.ply",
    .memory =
        "100 bytes a ray, or what --memory allows: a larger cloud is worked on in blocks, which lie in temporary "
        "files in the folder that TMPDIR names, or in /var/tmp.",
    .see_also = {"raydenoise", "raydecimate"}};

StepReport run_smooth(const Match&, const Context& context, RaySource& source, const SinkMaker& make) {
  return report_of(smooth_rays(context, source, make(0, source.info())));
}

}  // namespace

const Step kSmoothStep{.command = kSmoothCommand, .outputs = {{"", "_smooth"}}, .run = run_smooth};

}  // namespace ray::tools
