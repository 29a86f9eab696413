#include "own_hits.h"

#include <raycloud/exec/fresh_memory.h>
#include <raycloud/exec/parallel.h>
#include <raycloud/exec/stream.h>

namespace ray {

std::vector<std::uint16_t> end_ticks(const Context& context, RaySource& source, const TimeScale& scale) {
  std::vector<std::uint16_t> ticks;
  if (source.info().ray_count) ticks.reserve(*source.info().ray_count);
  stream(
      context, source, nullptr,
      [&](const RayCloud& rays) {
        std::vector<std::uint16_t> of_chunk;
        for (std::size_t i = 0; i < rays.size(); ++i)
          if (rays.bounded[i] != 0) of_chunk.push_back(scale.tick(rays.times[i]));
        return of_chunk;
      },
      [&](const RayCloud&, const std::vector<std::uint16_t>& of_chunk) {
        ticks.insert(ticks.end(), of_chunk.begin(), of_chunk.end());
      });
  source.rewind();
  return ticks;
}

OwnHits::OwnHits(const Context& context, const PointTree& points, const std::vector<std::uint16_t>& ticks,
                 double look_ticks)
    : ticks_(points.size()),
      look_ticks_(look_ticks),
      hits_(touched_vector<HitEpisodes>(context, points.size())) {
  parallel_for(context, points.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t place = begin; place < end; ++place)
      ticks_[place] = ticks[points.index(place)];
  });
}

void OwnHits::find(NeighbourSearch& search, std::size_t place, const Ellipsoid& ellipsoid,
                   std::uint32_t slot) {
  thread_local std::vector<std::uint16_t> ticks;
  ticks.clear();
  const PlacesInside inside = search.inside(place, {ellipsoid.centre, ellipsoid.shape});
  for (const std::uint32_t other : inside.surely)
    ticks.push_back(ticks_[other]);
  for (const std::uint32_t other : inside.perhaps)
    if (is_inside(ellipsoid, search.tree().point(other))) ticks.push_back(ticks_[other]);
  hits_[slot] = episodes_of(ticks, look_ticks_);
}

}  // namespace ray
