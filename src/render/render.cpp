#include "canvas.h"

#include <raycloud/core/error.h>
#include <raycloud/render/render.h>

namespace ray {
namespace {

double bytes_per_pixel(RenderStyle style, Purpose purpose) {
  const bool sums = style == RenderStyle::mean || style == RenderStyle::sum;
  return (sums ? 32.0 : 8.0) + (purpose == Purpose::eye ? sizeof(Pixel) : sizeof(FloatPixel));
}

std::unique_ptr<Canvas> canvas_for(const RenderOptions& options, Purpose purpose, const Frame& frame,
                                   const Survey& survey) {
  switch (options.style) {
    case RenderStyle::mean:
    case RenderStyle::sum:
      return make_sums(options.style, purpose, frame, survey);
    case RenderStyle::rays:
      return make_lines(frame);
    default:
      return make_nearest(options.style, purpose, frame, survey);
  }
}

struct Drawn {
  RenderFacts facts;
  std::unique_ptr<Canvas> canvas;
};

Drawn drawn(const Context& context, RaySource& source, const RenderOptions& options, Purpose purpose) {
  check(options);
  const Survey survey = survey_cloud(context, source, options.style);
  if (survey.bounds.empty()) {
    throw Error(ErrorCode::no_data, survey.counts.rays_in == 0
                                        ? "there is nothing to render, as there are no rays"
                                        : "there is nothing to render, as no ray is bounded");
  }
  const Frame frame = frame_of(context, options, survey.bounds, bytes_per_pixel(options.style, purpose));
  std::unique_ptr<Canvas> canvas = canvas_for(options, purpose, frame, survey);
  source.rewind();
  static_cast<void>(stream(
      context, source, nullptr,
      [&](const RayCloud& rays) {
        canvas->draw(rays);
        return Nothing{};
      },
      [](const RayCloud&, Nothing) {}));
  return {{{frame.pixel_width}, survey.bounds, survey.counts}, std::move(canvas)};
}

}  // namespace

Rendering render(const Context& context, RaySource& source, const RenderOptions& options) {
  const Drawn drawing = drawn(context, source, options, Purpose::eye);
  return {drawing.facts, drawing.canvas->image(), drawing.canvas->shown()};
}

ValueRendering render_values(const Context& context, RaySource& source, const RenderOptions& options) {
  const Drawn drawing = drawn(context, source, options, Purpose::values);
  return {drawing.facts, drawing.canvas->values()};
}

}  // namespace ray
