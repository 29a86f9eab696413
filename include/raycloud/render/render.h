#pragma once
/// Pictures and maps of a cloud seen from one side (paper, section VIII-H).

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

/// What is drawn. *Ends* are those of bounded rays: the end of an unbounded one is no surface. A *value* is
/// what render_values gives; `render` turns it into 8 bits for the eye.
enum class RenderStyle {
  /// The nearest end of each pixel, in its colour; value: the colour, 0 to 1. Where all ends have the same
  /// colour, `render` shades it by the rank of their intensity, from a fifth for the weakest to full for the
  /// strongest; where the intensity is the same everywhere too, it shows the style `height`.
  ends,
  /// The nearest end of each pixel by z, from blue (low) over green to yellow (high), see height_colour. The
  /// range shown is that of the ends without the lowest and highest 0.5 %, so that a stray point does not
  /// flatten the rest. Value: metres above the lowest end of the cloud, to 2^-24 of its height.
  height,
  /// The trajectory: the nearest start of each pixel, of all rays, bounded or not, with colours and values as
  /// in `ends`. `render` draws each as a dot of 3 × 3 pixels, to be seen where it is alone.
  starts,
  /// The mean colour of the ends of each pixel, as `ends` colours them; value: the mean of their colours, 0
  /// to 1.
  mean,
  /// The sum of the colours of the ends of each pixel; value: that sum, where a channel of 255 counts 1, so
  /// that the values of a white cloud are numbers of ends. `render` shows it linearly up to the sum that 5 %
  /// of the pixels with ends exceed, which is 255.
  sum,
  /// Free space: the lengths of all rays, bounded or not, within each pixel, by exact coverage: the value is
  /// the sum over the rays of the metres that the ray, projected onto the picture, runs inside the pixel's
  /// square. The values of all pixels add up to the projected lengths of all rays. `render` shows it by
  /// height_colour on a logarithmic scale between the values that 1 % of the pixels fall below and 1 %
  /// exceed.
  rays,
};

struct RenderOptions {
  View view = View::top;
  RenderStyle style = RenderStyle::ends;
  std::size_t resolution = 512;           ///< pixels of the longer side, ≥ 1
  std::optional<Metres> pixel_width;      ///< instead of the resolution, > 0
  std::size_t longest_side = 0x7fffffff;  ///< pixels; an image with a longer one is refused
};

/// What is known about either kind of picture.
struct RenderFacts {
  Metres pixel_width;
  /// Of what is drawn: ends, starts, or for `rays` both of all rays. Its low corner (in the view) is the
  /// image's bottom left corner.
  Bounds bounds;
  StreamCounts counts;  ///< of one pass; rays_out is the number of rays drawn
};

/// The values of the darkest and of the brightest colour of a picture that shows values.
struct ValueRange {
  double darkest = 0.0;
  double brightest = 1.0;
};

struct Rendering : RenderFacts {
  Image image;  ///< transparent (alpha 0) where nothing is drawn, else opaque
  /// What the colours mean in `height` (z in metres), `sum` and `rays` (as the values); else nothing.
  std::optional<ValueRange> shown;
};

struct ValueRendering : RenderFacts {
  FloatImage image;  ///< 0 where nothing is drawn
};

/// Draws a picture to look at. Of ends (or starts) on the same pixel the nearest to the viewer is seen; of
/// those as near as each other to 1e-12 of the cloud's depth, the one with the larger red, then green, then
/// blue.
///
/// Streaming, in two passes: reads `source` from where it stands, rewinds it and reads it again. Cost: O(1) a
/// ray; for `rays`, O(pixels crossed). Memory besides the chunks: 12 bytes a pixel; 36 for `mean` and `sum`.
/// All sums are of integers: the result depends on neither threads nor chunks. Throws Error(no_data) if
/// there is nothing to draw, Error(out_of_range) before taking memory if the image exceeds the memory of the
/// context, 2^31 − 1 pixels or the longest side, Error(usage) for options out of range.
[[nodiscard]] Rendering render(const Context& context, RaySource& source, const RenderOptions& options);

/// The same with real, unscaled values, for measuring. Memory: 8 bytes a pixel more.
[[nodiscard]] ValueRendering render_values(const Context& context, RaySource& source,
                                           const RenderOptions& options);

}  // namespace ray
