#pragma once
/// The streaming shape with several sinks: chunks flow from a RaySource through a computation that sorts
/// their rays into parts, and each part flows on to a sink of its own.

#include <raycloud/exec/stream.h>

#include <type_traits>
#include <utility>
#include <vector>

namespace ray {

/// Rays on their way to one sink: rows of the chunk, or rays of its own. Kept from chunk to chunk, so that
/// what it has allocated is used again.
struct StreamPart {
  RaySink* sink = nullptr;
  bool of_chunk = false;            ///< `rows` says which; otherwise they are in `rays`
  std::vector<std::uint32_t> rows;  ///< of the chunk, in any order
  RayCloud rays;
  RawChunk raw;

  [[nodiscard]] std::size_t size() const { return of_chunk ? rows.size() : rays.size(); }
};

/// For each chunk: `map(rays, parts)`, or `map(rays, raw, parts)`, on any thread, which may change the chunk
/// and returns a value; then, in file order and one at a time, `fold(value, parts)`; then the sink of every
/// part encodes on any thread and writes in order, the parts of a chunk one after the other. `parts` holds
/// what an earlier chunk left there: both functions must set what they use. A fold may take the chunk, too:
/// `fold(rays, value, parts)`. Does not finish the sinks. Memory: pipeline_slots(context) chunks with their
/// parts.
template <class Map, class Fold>
StreamCounts stream_parts(const Context& context, RaySource& source, const Map& map, const Fold& fold) {
  using Value =
      std::decay_t<decltype(map_piece(map, std::declval<RayCloud&>(), std::declval<const RawChunk&>(),
                                      std::declval<std::vector<StreamPart>&>()))>;
  struct Item {
    RawChunk raw;
    RayCloud rays;
    Value value{};
    std::vector<StreamPart> parts;
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
                      item.value = map_piece(map, item.rays, item.raw, item.parts);
                    }});
  stages.push_back({Mode::ordered, [&](std::size_t slot) {
                      Item& item = items[slot];
                      counts.rays_in += item.rays_in;
                      counts.dropped += item.dropped;
                      if constexpr (std::is_invocable_v<Fold, RayCloud&, Value&, std::vector<StreamPart>&>)
                        fold(item.rays, item.value, item.parts);
                      else
                        fold(item.value, item.parts);
                      for (const StreamPart& part : item.parts)
                        counts.rays_out += part.size();
                      if (context.progress != nullptr) context.progress->advance(item.raw.rows);
                    }});
  stages.push_back({Mode::parallel, [&](std::size_t slot) {
                      // The first part comes last and may take the chunk.
                      std::vector<StreamPart>& parts = items[slot].parts;
                      for (std::size_t i = parts.size(); i-- > 0;) {
                        StreamPart& part = parts[i];
                        if (!part.of_chunk)
                          part.sink->consume(part.rays, part.raw);
                        else if (i > 0)
                          part.sink->encode_rows(items[slot].rays, part.rows, part.raw);
                        else
                          part.sink->consume_rows(items[slot].rays, part.rows, part.raw);
                      }
                    }});
  stages.push_back({Mode::ordered, [&](std::size_t slot) {
                      for (const StreamPart& part : items[slot].parts)
                        part.sink->write(part.raw);
                    }});
  if (context.progress != nullptr) context.progress->begin("rays", source.info().ray_count.value_or(0));
  pipeline(
      context, items.size(), [&](std::size_t slot) { return source.fetch(items[slot].raw); }, stages);
  if (context.progress != nullptr) context.progress->end();
  return counts;
}

}  // namespace ray
