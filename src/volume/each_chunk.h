#pragma once
/// One reading of a cloud.

#include <raycloud/exec/stream.h>

namespace ray {

/// `work(rays)`, or `work(rays, raw)`, on any thread, for every chunk; then rewinds the source.
template <class Work>
void each_chunk(const Context& context, RaySource& source, const Work& work) {
  stream(
      context, source, nullptr,
      [&](RayCloud& rays, const RawChunk& raw) {
        map_piece(work, rays, raw);
        return Nothing{};
      },
      [](const RayCloud&, Nothing) {});
  source.rewind();
}

}  // namespace ray
