#pragma once
/// The streaming shape of algorithm: chunks flow from a RaySource through a computation to a RaySink, in
/// bounded memory, with reading, computing and writing overlapped.

#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/parallel.h>
#include <raycloud/exec/progress.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace ray {

struct StreamCounts {
  std::uint64_t rays_in = 0;   ///< valid rays read
  std::uint64_t rays_out = 0;  ///< rays written
  std::uint64_t dropped = 0;   ///< rows left out because of a NaN or infinite value
};

/// The rows where a mask is not 0.
[[nodiscard]] std::vector<std::uint32_t> rows_of(std::span<const std::uint8_t> mask);

/// A map that wants to know where in the source its rays are takes the fetched piece too.
template <class Map, class... More>
decltype(auto) map_piece(const Map& map, RayCloud& rays, const RawChunk& raw, More&... more) {
  if constexpr (std::is_invocable_v<const Map&, RayCloud&, const RawChunk&, More&...>)
    return map(rays, raw, more...);
  else
    return map(rays, more...);
}

/// For each chunk: `map(rays)`, or `map(rays, raw)`, on any thread, which may change the chunk and returns a
/// value; then, in file
/// order and one at a time, `fold(rays, value)`, which may change the chunk too; then the sink, if there is
/// one, encodes on any thread and writes in order. A fold that returns a mask, one byte for each ray, sends
/// only the rays on where it is not 0, at no cost in the serial part. Does not call `sink->finish()`. The
/// result depends neither on threads nor on how the source cuts its chunks if `map` looks at one ray at a
/// time and `fold` goes through the rows in order. Memory: pipeline_slots(context) chunks.
template <class Map, class Fold>
StreamCounts stream(const Context& context, RaySource& source, RaySink* sink, const Map& map,
                    const Fold& fold) {
  using Value =
      std::decay_t<decltype(map_piece(map, std::declval<RayCloud&>(), std::declval<const RawChunk&>()))>;
  constexpr bool kMasks = !std::is_void_v<decltype(fold(std::declval<RayCloud&>(), std::declval<Value&>()))>;
  struct Item {
    RawChunk raw;
    RayCloud rays;
    Value value{};
    std::vector<std::uint8_t> mask;
    std::size_t dropped = 0;
    std::size_t rays_in = 0;
  };
  std::vector<Item> items(pipeline_slots(context));
  StreamCounts counts;
  using Mode = PipelineStage::Mode;
  std::vector<PipelineStage> stages;
  stages.push_back({Mode::parallel, [&](std::size_t slot) {
                      Item& item = items[slot];
                      item.dropped = source.decode(item.raw, item.rays);
                      item.rays_in = item.rays.size();
                      item.value = map_piece(map, item.rays, item.raw);
                    }});
  stages.push_back({Mode::ordered, [&](std::size_t slot) {
                      Item& item = items[slot];
                      std::size_t rays_out = 0;
                      if constexpr (kMasks) {
                        item.mask = fold(item.rays, item.value);
                        rays_out = item.mask.size() - static_cast<std::size_t>(
                                                          std::count(item.mask.begin(), item.mask.end(), 0));
                      } else {
                        fold(item.rays, item.value);
                        rays_out = item.rays.size();
                      }
                      counts.rays_in += item.rays_in;
                      counts.dropped += item.dropped;
                      counts.rays_out += rays_out;
                      if (context.progress != nullptr) context.progress->advance(item.raw.rows);
                    }});
  if (sink != nullptr) {
    stages.push_back({Mode::parallel, [&](std::size_t slot) {
                        Item& item = items[slot];
                        if constexpr (kMasks)
                          sink->consume_rows(item.rays, rows_of(item.mask), item.raw);
                        else
                          sink->consume(item.rays, item.raw);
                      }});
    stages.push_back({Mode::ordered, [&](std::size_t slot) { sink->write(items[slot].raw); }});
  }
  if (context.progress != nullptr) context.progress->begin("rays", source.info().ray_count.value_or(0));
  pipeline(
      context, items.size(), [&](std::size_t slot) { return source.fetch(items[slot].raw); }, stages);
  if (context.progress != nullptr) context.progress->end();
  return counts;
}

/// A value for maps that only change the chunk.
struct Nothing {};

/// `change(rays)` on every chunk, on any thread, from source to sink.
template <class Change>
StreamCounts stream_each(const Context& context, RaySource& source, RaySink& sink, const Change& change) {
  return stream(
      context, source, &sink,
      [&](RayCloud& rays) {
        change(rays);
        return Nothing{};
      },
      [](RayCloud&, Nothing&) {});
}

/// Reads a whole stream into one cloud. Memory: the cloud, 61 bytes a ray plus extras.
[[nodiscard]] RayCloud read_all(const Context& context, RaySource& source);

}  // namespace ray
