#pragma once
/// Colours that each ray gets by itself (paper, section VIII-G).

#include <raycloud/core/bounds.h>
#include <raycloud/core/colour.h>
#include <raycloud/core/image.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/stream.h>

#include <cstdint>
#include <variant>

namespace ray {

/// Hue by time: pure red at every whole minute of the clock, green 20 s later, blue after 40 s.
struct ColourByTime {};
/// Hue by the height of the end: red at every 10 m of z, green a third of that higher, blue at two thirds.
struct ColourByHeight {};
/// Grey: the intensity.
struct ColourByIntensity {};
/// The same red, green and blue for all; the intensity of `colour` is not looked at.
struct OneColour {
  Colour colour;
};
/// The colours stay. Bounded rays get this intensity; 0 makes them unbounded, as alpha 0 in a file means.
/// What is unbounded stays so, as nothing was hit there.
struct SetIntensity {
  std::uint8_t intensity = 255;
};
/// The image as a map seen from above: its lower left corner lies on that of the bounds of the ends of
/// bounded rays, and it is as large as it must be to cover them without being stretched. So the picture that
/// `render_ends` draws from the top falls back onto the cloud pixel by pixel. Where the image is transparent
/// (alpha below 128), the colour stays.
struct ColourByImage {
  Image image;
};

using Colouring =
    std::variant<ColourByTime, ColourByHeight, ColourByIntensity, OneColour, SetIntensity, ColourByImage>;

/// Colours every ray, unbounded ones too; everything else keeps every bit.
///
/// Streaming, memory: the chunks; for ColourByImage in two passes (reads from where `source` stands, rewinds,
/// reads again). The result depends on neither threads nor chunks. Leaves `sink->finish()` to the caller.
/// Throws Error(usage) for an image without pixels.
StreamCounts colour_rays(const Context& context, RaySource& source, RaySink& sink,
                         const Colouring& colouring);

/// Full saturation and value: 0 is red, 1/3 green, 2/3 blue, 1 red again; by the fraction of `turns`.
[[nodiscard]] Colour hue_colour(double turns);

}  // namespace ray
