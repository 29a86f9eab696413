#pragma once
/// Reads a source to its end and holds it to what every source promises.

#include <raycloud/core/memory_stream.h>
#include <raycloud/core/ray_stream.h>

#include <cstdlib>

namespace ray::fuzz {

/// Aborts where decode yields a ray that is not finite, more rays than were fetched, or columns that info()
/// does not have.
inline void drain(RaySource& source) {
  RawChunk raw;
  RayCloud rays;
  while (source.fetch(raw)) {
    const std::size_t dropped = source.decode(raw, rays);
    if (rays.size() + dropped > raw.rows || schema_of(rays) != source.info().extras) std::abort();
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (!is_finite_ray(rays, i)) std::abort();
  }
}

}  // namespace ray::fuzz
