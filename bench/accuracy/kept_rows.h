#pragma once
/// Which rays denoising leaves in.

#include <raycloud/core/memory_stream.h>
#include <raycloud/filter/denoise.h>

#include <cstdint>
#include <vector>

namespace bench {

/// One byte a ray: 1 for those that `remove_noise` keeps. It keeps their order and every bit, so the rays
/// tell which they are.
[[nodiscard]] inline std::vector<std::uint8_t> kept_rows(const ray::RayCloud& rays, const ray::Noise& noise) {
  ray::MemorySource source(rays);
  ray::MemorySink sink;
  ray::remove_noise({}, source, sink, noise);
  sink.finish();
  const ray::RayCloud& left = sink.cloud();
  std::vector<std::uint8_t> kept(rays.size());
  for (std::size_t i = 0, next = 0; i < rays.size() && next < left.size(); ++i)
    if (left.ends[next] == rays.ends[i] && left.times[next] == rays.times[i]) kept[i] = 1, ++next;
  return kept;
}

}  // namespace bench
