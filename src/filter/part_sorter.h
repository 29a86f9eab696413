#pragma once
/// Brings the pieces of a chunk into the order of their parts.

#include "ray_pieces.h"

#include <raycloud/filter/partition.h>

#include <unordered_map>
#include <vector>

namespace ray {

struct PartKeyHash {
  std::size_t operator()(const PartKey& key) const {
    std::uint64_t hash = 0;
    for (const std::int64_t index : key) {
      hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 32;
    }
    return static_cast<std::size_t>(hash);
  }
};

class PartSorter {
 public:
  /// The number of the part in this chunk.
  [[nodiscard]] std::uint32_t part(const PartKey& key);
  void add(std::uint32_t part, std::size_t row) { pieces_.push_back({part, row, {}, {}, 0}); }
  void add(std::uint32_t part, std::size_t row, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
           std::uint8_t flags) {
    pieces_.push_back({part, row, start, end, flags});
  }
  /// Parts that have pieces, in the order in which they came first; pieces of a part in that of add.
  void gather(const RayCloud& rays, bool marked, PartitionedChunk& out) const;

 private:
  struct Piece {
    std::uint32_t part;
    std::size_t row;
    Eigen::Vector3d start;
    Eigen::Vector3d end;
    std::uint8_t flags;
  };
  std::vector<PartKey> keys_;
  std::unordered_map<PartKey, std::uint32_t, PartKeyHash> numbers_;
  std::uint32_t latest_ = 0;
  std::vector<Piece> pieces_;
};

}  // namespace ray
