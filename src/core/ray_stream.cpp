#include <raycloud/core/ray_stream.h>

#include <cassert>
#include <utility>

namespace ray {

std::size_t RaySource::decode_times(const RawChunk& raw, std::vector<double>& times) const {
  RayCloud rays;
  const std::size_t dropped = decode(raw, rays);
  times = std::move(rays.times);
  return dropped;
}

void RaySink::amend(std::string_view, std::string_view) {
  assert(false);
}

void RaySink::encode_rows(const RayCloud& rays, std::span<const std::uint32_t> rows, RawChunk& raw) const {
  RayCloud gathered;
  gathered.assign_rows(rays, rows);
  consume(gathered, raw);
}

}  // namespace ray
