#pragma once
/// The evidence of neighbours brought together where the ellipsoids lie in blocks.

#include "ellipsoid_blocks.h"
#include "transient_regions.h"

#include <raycloud/exec/context.h>
#include <raycloud/exec/spilled_rows.h>

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace ray {

/// The numbers that transient_regions gives the ellipsoids of all blocks, on disk. Cells of space of which
/// any evidence can matter are judged in groups, each with what it depends on, of as many ellipsoids as the
/// memory holds; the rest has 0. No rays are needed.
class BlockRegions {
 public:
  BlockRegions(EllipsoidBlocks& blocks, const SpreadSteps& steps);

  /// Of a block: where something is awake. Called for each that has ellipsoids, before judge.
  void see(std::size_t part, std::span<const RegionSeed> seeds, std::span<const PackedEllipsoid> ellipsoids);
  /// `seeds_of(part)` gives the seeds again, by the numbers of the ellipsoids. About 1 µs of one core for
  /// each ellipsoid that a group depends on.
  void judge(const Context& context,
             const std::function<std::vector<RegionSeed>(std::size_t part)>& seeds_of);
  /// By the numbers of the ellipsoids. Called once for each block, in the order of blocks.
  [[nodiscard]] std::vector<float> scores(std::size_t part);

 private:
  /// 72 bytes.
  struct Member {
    PackedEllipsoid ellipsoid;
    RegionSeed seed;
    std::uint32_t owned = 0;  ///< 0: the group depends on it only
  };
  void send(std::size_t part, const std::vector<RegionSeed>& seeds);
  void judge_group(const Context& context, std::size_t group);

  EllipsoidBlocks& blocks_;
  SpreadSteps steps_;
  std::vector<CellState> states_;
  CellGroups groups_;
  std::unique_ptr<SpilledRows<Member>> members_;  ///< by group, in the order of blocks
  std::unique_ptr<SpilledRows<float>> scores_;    ///< of those that are owned, likewise
};

}  // namespace ray
