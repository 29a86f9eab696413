#include "cli/cli.h"
#include "cloud_to_cloud.h"

#include <raycloud/io/image_file.h>
#include <raycloud/io/ray_cloud_file.h>
#include <raycloud/render/render_ends.h>

#include <cstdio>
#include <map>

namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "rayrender",
    .summary = "picture a ray cloud",
    .description =
        R"(Draws the end points of the bounded rays, seen from one side without perspective; nearer points hide
those behind them, and what nothing was seen of is transparent. From the `top` x is to the right and
y up; the other views stand around the cloud, whose front faces -y.

`ends` shows the colours of the rays, or their intensity where there are no colours; `height` goes
from blue (low) over green to yellow (high).)",
    .usages = {{.words = {cloud(), choice("VIEW", {"top", "left", "right", "front", "back"}),
                          choice("STYLE", {"ends", "height"})},
                .help = "an image of the surfaces",
                .example = "rayrender cloud.ply top ends"}},
    .options = {{.name = "resolution",
                 .value = integer("PIXELS", kPositive),
                 .help = "pixels of the longer side",
                 .fallback = "512"},
                {.name = "pixel_width",
                 .value = number("METRES", kPositive),
                 .help = "metres that one pixel spans, instead of the resolution"},
                output_option("CLOUD_VIEW_STYLE.png"),
                view_option()},
    .writes = "CLOUD_VIEW_STYLE.png",
    .memory = "22 bytes a pixel; less than 200 MB besides.",
    .see_also = {"rayinfo", "raydecimate"}};

void run(const Match& match, Session& session) {
  static const std::map<std::string, ray::View> kViews{{"top", ray::View::top},
                                                       {"left", ray::View::left},
                                                       {"right", ray::View::right},
                                                       {"front", ray::View::front},
                                                       {"back", ray::View::back}};
  const std::string& input = match.text("CLOUD");
  const std::string suffix = "_" + match.text("VIEW") + "_" + match.text("STYLE");
  const auto output = main_output(match, input, suffix, ".png");
  if (match.has("--resolution") && match.has("--pixel_width")) {
    match.reject("--pixel_width", "give either a resolution or a pixel width");
  }
  ray::RenderOptions options;
  options.view = kViews.at(match.text("VIEW"));
  options.style = match.text("STYLE") == "height" ? ray::EndsStyle::height : ray::EndsStyle::ends;
  options.resolution = static_cast<std::size_t>(match.integer("--resolution"));
  if (match.has("--pixel_width")) options.pixel_width = ray::Metres{match.number("--pixel_width")};

  const auto source = ray::open_ray_cloud(input);
  const ray::Rendering rendering = render_ends(session.context(), *source, options);
  write_png(output, rendering.image);

  ray::tools::note_dropped(session, rendering.counts.dropped);
  char size[96];
  std::snprintf(size, sizeof size, "%zu x %zu pixels of %.3g m", rendering.image.width,
                rendering.image.height, rendering.pixel_width.value);
  session.note(size);
  session.summary({.rays_in = rendering.counts.rays_in, .files = {output}});
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
