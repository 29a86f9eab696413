#include "read_ends.h"

#include <raycloud/spatial/point_spacing.h>

#include <algorithm>

namespace ray {

ReadEnds read_ends(const Context& context, RaySource& source, std::size_t most) {
  struct OfChunk {
    std::vector<SeenPoint> points;
    double first, last;
    std::uint64_t last_row;
  };
  ReadEnds ends;
  blocks::EndSampler sampler;
  if (source.info().ray_count) ends.points.reserve(std::min<std::uint64_t>(*source.info().ray_count, most));
  const StreamCounts counts = stream(
      context, source, nullptr,
      [](const RayCloud& rays, const RawChunk& raw) {
        OfChunk chunk{blocks::extract_all<SeenPoint>(rays, seen_end), 0.0, 0.0, raw.first_row + raw.rows};
        const auto [first, last] = std::minmax_element(rays.times.begin(), rays.times.end());
        if (first != rays.times.end()) chunk.first = *first, chunk.last = *last;
        return chunk;
      },
      [&](const RayCloud& rays, const OfChunk& chunk) {
        sampler.add(rays, chunk.points.size());
        if (sampler.sample().bounded <= most)
          ends.points.insert(ends.points.end(), chunk.points.begin(), chunk.points.end());
        else
          ends.points = std::vector<SeenPoint>();
        ends.rows = chunk.last_row;
        if (rays.empty()) return;
        ends.rays += rays.size();
        ends.first_time = std::min(ends.first_time, chunk.first);
        ends.last_time = std::max(ends.last_time, chunk.last);
      });
  source.rewind();
  ends.sample = sampler.sample();
  ends.dropped = counts.dropped;
  ends.spacing = estimate_spacing(ends.sample.ends, ends.sample.bounded).value;
  // As far as where there is a hundredth of the usual density.
  constexpr double kSpacings = 32.0;
  constexpr std::size_t kFew = 8;  // have no spacing
  if (ends.sample.ends.size() >= kFew) ends.reach = kSpacings * ends.spacing;
  return ends;
}

}  // namespace ray
