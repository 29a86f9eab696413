#include "cli/grouped.h"
#include "steps.h"

#include <raycloud/filter/denoise.h>

#include <cstdint>
#include <limits>

namespace ray::tools {
namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "raydenoise",
    .summary = "take noise out of a ray cloud",
    .description =
        R"(Leaves out the rays that end in noise; the others stay exactly as they were, with all their columns.
Rays that hit nothing stay too. In the first form noise is what ends alone: no other end is within the
distance. With `sigmas` it is what lies further from the surface of its neighbours than so many
standard deviations of that surface: 3 take one in 400 of good points. Ends that are part of no surface
or wire are noise, too, where nearly all rays pass them by.

With `range`, it is what ends between two surfaces because one beam met both: its range differs by more
than the distance from those of the beams on both sides of it and is between them. Which beams are next
to each other follows from their times and angles, so the whole cloud must be given, before it is
thinned; where a cloud does not tell, neighbours in space are compared, which finds less.)",
    .usages = {{.name = "distance",
                .words = {cloud(), length("DISTANCE")},
                .help = "ends with no other end within the distance",
                .example = "raydenoise cloud.ply 4 cm"},
               {.name = "sigmas",
                .words = {cloud(), quantity("N", "sigma")},
                .help = "ends off the surface of their neighbours",
                .example = "raydenoise cloud.ply 3 sigmas"},
               {.name = "range",
                .words = {cloud(), literal("range"), length("DISTANCE")},
                .help = "ends between two surfaces that one beam met",
                .example = "raydenoise cloud.ply range 4 cm"}},
    .options = {{.name = "min_neighbours",
                 .value = integer("N", Range{.least = 1.0, .most = std::numeric_limits<unsigned>::max()}),
                 .help = "how many others must be within the distance",
                 .fallback = "1",
                 .usages = {"distance"}},
                output_option("CLOUD_denoised.ply"),
                view_option()},
    .writes = "CLOUD_denoised.ply",
    .memory =
        R"(40 bytes a ray with a distance, 90 with `sigmas`, or what --memory allows: a larger cloud is worked on in
blocks, which lie in temporary files in the folder that TMPDIR names, or in /var/tmp. 90 to 130 bytes a
ray with `range`, whatever --memory allows.)",
    .see_also = {"raydecimate", "raysplit", "rayinfo"}};

Noise noise_of(const Match& match) {
  if (match.usage() == "sigmas") return OutsideNeighbours{match.number("N")};
  const Metres distance = match.length("DISTANCE");
  if (match.usage() == "range") return OnRangeEdges{distance};
  return FarFromOthers{distance, static_cast<unsigned>(match.integer("--min_neighbours"))};
}

StepReport run(const Match& match, const Context& context, RaySource& source, const SinkMaker& make) {
  const Denoised denoised = remove_noise(context, source, make(0, source.info()), noise_of(match));
  StepReport report = report_of(denoised.counts);
  if (!denoised.in_scan_order)
    report.notes.emplace_back(
        "the rays do not tell which beams are next to each other; neighbours in space were compared");
  const std::uint64_t removed = denoised.counts.rays_in - denoised.counts.rays_out;
  report.notes.push_back(grouped(removed) + (removed == 1 ? " ray" : " rays") + " taken out");
  return report;
}

}  // namespace

const Step kDenoiseStep{.command = kCommand, .outputs = {{"", "_denoised"}}, .run = run};

}  // namespace ray::tools
