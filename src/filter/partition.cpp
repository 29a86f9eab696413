#include "part_sorter.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/stream_parts.h>
#include <raycloud/filter/partition.h>

#include <algorithm>
#include <string>
#include <unordered_map>

namespace ray {
namespace {

constexpr std::size_t kBatch = 4096;          // rays worth a write
constexpr std::size_t kMostWaiting = 500000;  // rays, of all parts

/// The rays of each part wait here until there are enough of them to be worth a write.
class WaitingRooms {
 public:
  using MakeSink = std::function<std::unique_ptr<RaySink>(const PartKey&)>;
  explicit WaitingRooms(const MakeSink& make_sink) : make_sink_(make_sink) {}

  /// Replaces `ready` by the batches that are.
  void add(const PartitionedChunk& chunk, std::vector<StreamPart>& ready) {
    std::size_t used = 0;
    std::size_t begin = 0;
    for (const PartitionedChunk::Part& part : chunk.parts) {
      Room& room = room_of(part.key);
      append_rows(room.waiting, chunk.rays, begin, part.end);
      room.rays += part.end - begin;
      waiting_ += part.end - begin;
      begin = part.end;
      if (room.waiting.size() >= kBatch) release(room, ready, used);
    }
    if (waiting_ > kMostWaiting) release_largest(ready, used);
    ready.resize(used);
  }

  /// All that is left, part by part.
  void write_rest(const Context& context) {
    for (Room* room : by_size()) {
      check_cancelled(context);
      if (room->waiting.empty()) continue;
      RawChunk raw;
      room->sink->encode(room->waiting, raw);
      room->sink->write(raw);
      room->waiting = {};
    }
  }

  [[nodiscard]] std::map<PartKey, Partition::Part> take() {
    std::map<PartKey, Partition::Part> parts;
    for (auto& [key, room] : rooms_)
      parts[key] = {room.rays, std::move(room.sink)};
    return parts;
  }

 private:
  struct Room {
    std::uint64_t rays = 0;
    std::unique_ptr<RaySink> sink;
    RayCloud waiting;
  };

  Room& room_of(const PartKey& key) {
    const auto found = rooms_.find(key);
    if (found != rooms_.end()) return found->second;
    if (rooms_.size() == kMostParts) {
      throw Error(ErrorCode::out_of_range, "the split would make more than " + std::to_string(kMostParts) +
                                               " clouds: use wider cells");
    }
    Room& room = rooms_[key];
    room.sink = make_sink_(key);
    return room;
  }

  void release(Room& room, std::vector<StreamPart>& ready, std::size_t& used) {
    if (used == ready.size()) ready.emplace_back();
    StreamPart& batch = ready[used++];
    batch.sink = room.sink.get();
    waiting_ -= room.waiting.size();
    batch.rays = std::move(room.waiting);
    room.waiting = {};
  }

  [[nodiscard]] std::vector<Room*> by_size() {
    std::vector<Room*> rooms;
    rooms.reserve(rooms_.size());
    for (auto& [key, room] : rooms_)
      rooms.push_back(&room);
    std::sort(rooms.begin(), rooms.end(),
              [](const Room* a, const Room* b) { return a->waiting.size() > b->waiting.size(); });
    return rooms;
  }

  void release_largest(std::vector<StreamPart>& ready, std::size_t& used) {
    for (Room* room : by_size()) {
      if (waiting_ <= kMostWaiting / 2) return;
      release(*room, ready, used);
    }
  }

  const MakeSink& make_sink_;
  std::unordered_map<PartKey, Room, PartKeyHash> rooms_;
  std::size_t waiting_ = 0;
};

std::size_t colour_index(const Colour& colour) {
  return std::size_t{colour.red} << 16 | std::size_t{colour.green} << 8 | colour.blue;
}

class ColourRule final : public PartitionRule {
 public:
  std::vector<ColumnInfo> columns(std::vector<ColumnInfo> source) const override { return source; }

  void apply(const RayCloud& rays, PartitionedChunk& parts) const override {
    PartSorter sorter;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Colour& colour = rays.colours[i];
      sorter.add(sorter.part({colour.red, colour.green, colour.blue, 0}), i);
    }
    sorter.gather(rays, false, parts);
  }
};

}  // namespace

PartitionRulePtr partition_by_colour() {
  return std::make_unique<ColourRule>();
}

std::size_t count_colours(const Context& context, RaySource& source) {
  std::vector<bool> seen(std::size_t{1} << 24);
  std::size_t count = 0;
  stream(
      context, source, nullptr, [](const RayCloud&) { return Nothing{}; },
      [&](const RayCloud& rays, Nothing) {
        for (const Colour& colour : rays.colours) {
          if (seen[colour_index(colour)]) continue;
          seen[colour_index(colour)] = true;
          ++count;
        }
      });
  return count;
}

Partition partition_cloud(const Context& context, RaySource& source, const PartitionRule& rule,
                          const std::function<std::unique_ptr<RaySink>(const PartKey&)>& make_sink) {
  Partition partition;
  WaitingRooms rooms(make_sink);
  partition.stream = stream_parts(
      context, source,
      [&](const RayCloud& rays, std::vector<StreamPart>&) {
        PartitionedChunk chunk;
        rule.apply(rays, chunk);
        return chunk;
      },
      [&](const PartitionedChunk& chunk, std::vector<StreamPart>& ready) { rooms.add(chunk, ready); });
  rooms.write_rest(context);
  partition.parts = rooms.take();
  partition.stream.rays_out = 0;
  for (const auto& [key, part] : partition.parts)
    partition.stream.rays_out += part.rays;
  return partition;
}

}  // namespace ray
