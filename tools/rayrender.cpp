#include "cli/cli.h"
#include "cloud_to_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/io/image_file.h>
#include <raycloud/io/ray_cloud_file.h>
#include <raycloud/render/render.h>

#include <cstdio>
#include <map>

namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "rayrender",
    .summary = "picture a ray cloud",
    .description =
        R"(Draws a cloud seen from one side without perspective. From the `top` x is to the right and y up; the other
views stand around the cloud, whose front faces -y. What nothing was seen of is transparent.

`ends` shows the nearest end points in their colours, or by their intensity where there are no colours; `height`
the same from blue (low) over green to yellow (high). `starts` shows the trajectory: where the rays come from.
`mean` is the mean colour of all ends of a pixel and `sum` the sum of their colours, so for a white cloud how many
there are. `rays` shows free space: how many metres of rays cross each pixel, on a logarithmic scale. Ends of
unbounded rays are no surface and drawn by no style; their starts and the rays themselves are.

The image is what the extension of its name says: .png, .tga, .jpg or .bmp (the last two without transparency: on
black), or .hdr for the real values, unscaled: colours from 0 to 1, metres above the lowest end, metres of ray.)",
    .usages = {{.words = {cloud(), choice("VIEW", {"top", "left", "right", "front", "back"}),
                          choice("STYLE", {"ends", "mean", "sum", "starts", "rays", "height"})},
                .help = "an image of the cloud",
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
    .memory = "Up to 22 bytes a pixel, 44 for `mean` and `sum`; less than 200 MB besides.",
    .see_also = {"rayinfo", "raydecimate"}};

ray::View view_of(const std::string& word) {
  static const std::map<std::string, ray::View> kViews{{"top", ray::View::top},
                                                       {"left", ray::View::left},
                                                       {"right", ray::View::right},
                                                       {"front", ray::View::front},
                                                       {"back", ray::View::back}};
  return kViews.at(word);
}

ray::RenderStyle style_of(const std::string& word) {
  using ray::RenderStyle;
  static const std::map<std::string, RenderStyle> kStyles{
      {"ends", RenderStyle::ends},     {"mean", RenderStyle::mean}, {"sum", RenderStyle::sum},
      {"starts", RenderStyle::starts}, {"rays", RenderStyle::rays}, {"height", RenderStyle::height}};
  return kStyles.at(word);
}

template <class... Values>
std::string line(const char* format, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// What the colours of a picture mean.
std::string legend(ray::RenderStyle style, const ray::ValueRange& shown) {
  if (style == ray::RenderStyle::sum) {
    return line("full brightness is a sum of %.4g (.hdr has the sums themselves)", shown.brightest);
  }
  if (style == ray::RenderStyle::rays) {
    return line("blue is %.3g m of ray in a pixel, yellow %.3g m", shown.darkest, shown.brightest);
  }
  return line("blue is z = %.2f m, yellow %.2f m", shown.darkest, shown.brightest);
}

void run(const Match& match, Session& session) {
  const std::string& input = match.text("CLOUD");
  const auto output = main_output(match, input, "_" + match.text("VIEW") + "_" + match.text("STYLE"), ".png");
  if (match.has("--resolution") && match.has("--pixel_width")) {
    match.reject("--pixel_width", "give either a resolution or a pixel width");
  }
  ray::RenderOptions options;
  options.view = view_of(match.text("VIEW"));
  options.style = style_of(match.text("STYLE"));
  options.resolution = static_cast<std::size_t>(match.integer("--resolution"));
  if (match.has("--pixel_width")) options.pixel_width = ray::Metres{match.number("--pixel_width")};
  options.longest_side = ray::kLongestImageSide;
  const bool as_values = ray::image_format(output) == ray::ImageFormat::hdr;

  const auto source = ray::open_ray_cloud(input);
  const auto report = [&](const ray::RenderFacts& facts, const auto& image) {
    ray::tools::note_dropped(session, facts.counts.dropped);
    session.note(line("%zu x %zu pixels of %.3g m", image.width, image.height, facts.pixel_width.value));
    session.summary({.rays_in = facts.counts.rays_in, .files = {output}});
  };
  if (as_values) {
    const ray::ValueRendering rendering = render_values(session.context(), *source, options);
    write_image(output, rendering.image);
    report(rendering, rendering.image);
  } else {
    const ray::Rendering rendering = render(session.context(), *source, options);
    write_image(output, rendering.image);
    if (rendering.shown) session.note(legend(options.style, *rendering.shown));
    report(rendering, rendering.image);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
