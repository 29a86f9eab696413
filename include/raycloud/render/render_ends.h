#pragma once
/// Pictures of the surfaces of a cloud (paper, section VIII-H).

#include <raycloud/core/bounds.h>
#include <raycloud/core/image.h>
#include <raycloud/core/ray_stream.h>
#include <raycloud/core/units.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/stream.h>
#include <raycloud/render/camera.h>

#include <cstddef>
#include <optional>

namespace ray {

enum class EndsStyle {
  /// The colour of the end. Where all ends have the same colour, it is shaded by the rank of their intensity,
  /// from a fifth for the weakest to full for the strongest; where the intensity is the same everywhere too,
  /// the style is `height`.
  ends,
  /// z from blue (low) over green to yellow (high), see height_colour. The range is that of the ends without
  /// the lowest and highest 0.5 %, so that a stray point does not flatten the rest.
  height,
};

struct RenderOptions {
  View view = View::top;
  EndsStyle style = EndsStyle::ends;
  std::size_t resolution = 512;       ///< pixels of the longer side, ≥ 1
  std::optional<Metres> pixel_width;  ///< instead of the resolution, > 0
};

struct Rendering {
  Image image;  ///< transparent (alpha 0) where no end is, else opaque
  Metres pixel_width;
  Bounds bounds;  ///< of the bounded ends; its low corner (in the view) is the image's bottom left corner
  StreamCounts counts;  ///< of one pass; rays_out is the number of ends drawn
};

/// Draws the bounded ends, each on the one pixel it falls on; where several do, the nearest to the viewer is
/// seen (of ends as near as each other to 1e-12 of the cloud's depth, the one with the larger red, then
/// green, then blue). The ends of unbounded rays are no surface and never drawn.
///
/// Streaming, in two passes: reads `source` from where it stands, rewinds it and reads it again. Memory: 12
/// bytes a pixel besides the chunks. The result depends on neither threads nor chunks. Throws Error(no_data)
/// if there is no bounded ray, Error(out_of_range) before taking memory if the image exceeds the memory of
/// the context or 2^31 − 1 pixels, Error(usage) for options out of range.
[[nodiscard]] Rendering render_ends(const Context& context, RaySource& source, const RenderOptions& options);

/// The ramp of the style `height` for 0 (low) to 1 (high), clamped outside: lightness rises evenly in OKLab
/// (Ottosson 2020), so that it reads in grey too.
[[nodiscard]] Pixel height_colour(double fraction);

}  // namespace ray
