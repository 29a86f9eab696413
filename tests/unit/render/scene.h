#pragma once
/// Small clouds to look at, and the views in the test's own words.

#include <raycloud/core/memory_stream.h>
#include <raycloud/render/render.h>

#include <array>
#include <vector>

namespace ray::test {

inline constexpr std::array kViews = {View::top, View::left, View::right, View::front, View::back};
inline constexpr std::array kStyles = {RenderStyle::ends, RenderStyle::height, RenderStyle::starts,
                                       RenderStyle::mean, RenderStyle::sum,    RenderStyle::rays};
inline constexpr Pixel kNothing{};
inline constexpr Pixel kRed{255, 0, 0, 255};
inline constexpr Pixel kGreen{0, 255, 0, 255};
inline constexpr Pixel kBlue{0, 0, 255, 255};

inline Rendering rendered(const RayCloud& cloud, const RenderOptions& options, unsigned threads = 1,
                          std::size_t chunk_rays = 64) {
  MemorySource source(cloud, chunk_rays);
  return render({.threads = threads}, source, options);
}

inline FloatImage values_of(const RayCloud& cloud, const RenderOptions& options, unsigned threads = 1,
                            std::size_t chunk_rays = 64) {
  MemorySource source(cloud, chunk_rays);
  return render_values({.threads = threads}, source, options).image;
}

inline const Pixel& pixel(const Image& image, std::size_t column, std::size_t row_from_top) {
  return image.pixels.at(row_from_top * image.width + column);
}

struct Dot {
  Eigen::Vector3d end;
  Pixel colour;
  bool bounded = true;
};

inline RayCloud cloud_of(const std::vector<Dot>& dots) {
  RayCloud cloud;
  cloud.resize(dots.size());
  for (std::size_t i = 0; i < dots.size(); i++) {
    cloud.starts[i] = {0, 0, 0};
    cloud.ends[i] = dots[i].end;
    cloud.times[i] = 0.0;
    cloud.colours[i] = {dots[i].colour.red, dots[i].colour.green, dots[i].colour.blue, 100};
    cloud.bounded[i] = dots[i].bounded ? 1 : 0;
  }
  return cloud;
}

/// Written from the table in camera.h.
inline Eigen::Vector3d seen_from(View view, const Eigen::Vector3d& p) {  // right, up, nearness
  switch (view) {
    case View::top:
      return {p.x(), p.y(), p.z()};
    case View::front:
      return {p.x(), p.z(), -p.y()};
    case View::back:
      return {-p.x(), p.z(), p.y()};
    case View::left:
      return {-p.y(), p.z(), -p.x()};
    case View::right:
      break;
  }
  return {p.y(), p.z(), p.x()};
}

}  // namespace ray::test
