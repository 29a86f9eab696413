#include "steps.h"

#include <raycloud/filter/colour.h>
#include <raycloud/io/image_file.h>

#include <algorithm>
#include <cmath>

namespace ray::tools {
namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "raycolour",
    .summary = "colour a ray cloud",
    .description =
        R"(Gives every ray a new colour; nothing else changes. `time` goes once around the hues each minute,
from red (at whole minutes) over green to blue, `height` once each 10 metres of z, and `alpha` shows
the intensity in grey.

`shape`, `normal` and `branches` look at the nearest neighbours of each point: red is what is equally
thick in all directions, green what is long, blue what is flat; or the direction of the surface, x, y
and z from -1 to 1 in red, green and blue; or what is like a branch or a thin trunk, in red where it
lies flat, over yellow to green where it stands upright, and dark grey elsewhere. There, rays that
hit nothing become black. `--lit` puts light on the surfaces, whatever their colours are: from above
and one side, with darker hollows and brighter ridges.

`alpha V` leaves the colours and sets the intensity, where something was hit; as intensity 0 means
that nothing was, `alpha 0` makes all rays unbounded. `image` lays a picture over the cloud as seen
from above, as large as it must be to cover it without being stretched: what `rayrender CLOUD top`
drew, and you painted over, falls back into place. Transparent places leave the colour.)",
    .usages = {{.name = "by",
                .words = {cloud(), choice("BY", {"time", "height", "alpha"})},
                .help = "by the time, the height or the intensity of each ray",
                .example = "raycolour cloud.ply time"},
               {.name = "surface",
                .words = {cloud(), choice("BY", {"shape", "normal", "branches"})},
                .help = "by what the surface around each point is like",
                .example = "raycolour cloud.ply normal --lit"},
               {.name = "intensity",
                .words = {cloud(), literal("alpha"), number("V", between(0.0, 1.0))},
                .help = "sets the intensity, from 0 to 1",
                .example = "raycolour cloud.ply alpha 1"},
               {.name = "one",
                .words = {cloud(), colour()},
                .help = "red, green and blue from 0 to 1",
                .example = "raycolour cloud.ply 1,0.5,0"},
               {.name = "image",
                .words = {cloud(), literal("image"), input("FILE", {".png", ".jpg", ".bmp", ".tga"})},
                .help = "the colours of an image that lies on the cloud, seen from above",
                .example = "raycolour cloud.ply image map.png"}},
    .options = {{.name = "lit", .help = "shade the colours by light from above, hollows and ridges"},
                output_option("CLOUD_coloured.ply"),
                view_option()},
    .writes = "CLOUD_coloured.ply",
    .memory =
        R"(Less than 200 MB for any cloud, and the image. By `shape`, `normal`, `branches` and with `--lit`, 90
bytes for each ray that hit something besides; where that is more than --memory allows, the cloud goes
block by block through temporary files in the folder that TMPDIR names, or in /var/tmp.)",
    .see_also = {"rayrender", "rayinfo"}};

std::uint8_t to_byte(double fraction) {
  return static_cast<std::uint8_t>(std::lround(255.0 * fraction));
}

Colouring colouring_of(const Match& match) {
  if (match.usage() == "intensity") {
    // Only 0 itself means that nothing was hit.
    const double value = match.number("V");
    const std::uint8_t least = value > 0.0 ? 1 : 0;
    return SetIntensity{std::max(to_byte(value), least)};
  }
  if (match.usage() == "one") {
    const Eigen::Vector3d rgb = match.vector("R,G,B");
    return OneColour{{to_byte(rgb.x()), to_byte(rgb.y()), to_byte(rgb.z())}};
  }
  if (match.usage() == "image") return ColourByImage{read_image(match.text("FILE"))};
  const std::string& by = match.text("BY");
  if (by == "time") return ColourByTime{};
  if (by == "height") return ColourByHeight{};
  if (by == "shape") return ColourByShape{};
  if (by == "normal") return ColourByNormal{};
  if (by == "branches") return ColourByBranches{};
  return ColourByIntensity{};
}

StepReport run(const Match& match, const Context& context, RaySource& source, const SinkMaker& make) {
  const Colouring colouring = colouring_of(match);
  const Shading shading = match.has("--lit") ? Shading::lit : Shading::none;
  return report_of(colour_rays(context, source, make(0, source.info()), colouring, shading));
}

bool by_ray(const Match& match) {
  return match.usage() != "image" && match.usage() != "surface" && !match.has("--lit");
}

}  // namespace

const Step kColourStep{.command = kCommand,
                       .outputs = {{"", "_coloured"}},
                       .run = run,
                       .by_ray = by_ray,
                       .keeps_places = [](const Match&) { return true; }};

}  // namespace ray::tools
