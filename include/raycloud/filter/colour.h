#pragma once
/// New colours for rays: each by itself, or by the surface around its end (paper, section VIII-G).

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

/// What 20 neighbours look like: sphericity in red, cylindricality in green, planarity in blue (`shape_of` in
/// spatial/surfel.h). Grey where they are fewer than 3, or all in one place.
struct ColourByShape {};
/// The normal of the surface, turned to the sensor: (normal + 1) / 2 in red, green and blue. Where there is
/// no surface, the direction to the sensor.
struct ColourByNormal {};
/// What is like a branch: the more 16 neighbours are so, the more their hue stands out of a dark grey, red
/// where they lie flat, over yellow to green where they stand upright.
struct ColourByBranches {};

using Colouring = std::variant<ColourByTime, ColourByHeight, ColourByIntensity, OneColour, SetIntensity,
                               ColourByImage, ColourByShape, ColourByNormal, ColourByBranches>;

enum class Shading {
  none,
  /// The colours of bounded rays, times the light on their surface: from above and one side, and a little
  /// from everywhere; less in hollows, more on ridges. Flat level ground keeps its colour. A point without a
  /// surface is lit as if it faced the sensor.
  lit
};

/// Colours every ray; everything else keeps every bit. Unbounded rays have no surface: black by shape, normal
/// and branches, not shaded where others colour them.
///
/// Streaming, memory: the chunks; for ColourByImage in two passes (reads from where `source` stands, rewinds,
/// reads again). Neighbourhood, where the colour is by shape, normal or branches, or lit: two passes, three
/// where the cloud does not fit; memory: 90 bytes for each bounded ray, at most context.memory
/// (exec/blocks.h). The result depends on none of threads, chunks and memory. Leaves `sink->finish()` to the
/// caller. Throws Error(usage) for an image without pixels.
StreamCounts colour_rays(const Context& context, RaySource& source, RaySink& sink, const Colouring& colouring,
                         Shading shading = Shading::none);

/// Full saturation and value: 0 is red, 1/3 green, 2/3 blue, 1 red again; by the fraction of `turns`.
[[nodiscard]] Colour hue_colour(double turns);

}  // namespace ray
