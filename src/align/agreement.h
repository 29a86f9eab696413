#pragma once
/// Whether two clouds agree when one lies on the other: where both have surfaces these are the same, and
/// neither has any in what the other has seen to be empty.

#include "free_cubes.h"
#include "patches.h"

#include <raycloud/core/pose.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ray::align {

/// Of patches of one cloud, what the other says. Counted apart for upright surfaces, which tell of the turn
/// and the horizontal shift, and others.
struct Agreement {
  struct Counts {
    double same = 0.0;     ///< on a surface that heads the same way
    double other = 0.0;    ///< beside a surface, but not on it or not heading as it does
    double empty = 0.0;    ///< in space that was seen to be empty
    double unknown = 0.0;  ///< where the other cloud tells nothing
    [[nodiscard]] double known() const { return same + other + empty; }
  };
  Counts upright, others;
  /// What speaks against the pose: patches in empty space, and clean upright ones beside a surface, but
  /// without those in the tenth of space where most of them are. There something may have changed; what is
  /// wrong with a pose is wrong everywhere.
  double against = 0.0;
};

struct Observed {
  const PatchLevel& level;
  const FreeCubes& free;
};

/// A patch, and whether it is clean (PatchLevel::is_clean).
struct JudgedPatch {
  Patch patch;
  bool is_clean;
};
[[nodiscard]] std::vector<JudgedPatch> judged_patches(const PatchLevel& level, std::size_t most);

/// An even choice of the patches of a cloud, and in which cell of its space each lies: so wide (m) that what
/// has moved fills few of them.
class Witnesses {
 public:
  Witnesses(const PatchLevel& level, std::size_t most, double cell_width);

  [[nodiscard]] const std::vector<JudgedPatch>& patches() const { return patches_; }
  [[nodiscard]] std::uint32_t cell_of(std::size_t patch) const { return cells_[patch]; }
  [[nodiscard]] std::size_t cells() const { return count_; }

 private:
  std::vector<JudgedPatch> patches_;
  std::vector<std::uint32_t> cells_;
  std::size_t count_ = 0;
};

/// What patches of one cloud say for a pose, cell by cell: a cell counts once however many patches it has, so
/// that much that has moved in one place, or a wall that fits everywhere, is one voice.
struct Evidence {
  /// How much of a cell the other cloud tells something of, from 0 to 1, how much of that speaks against the
  /// pose, and how much is refuted.
  struct Cell {
    float known = 0.0F, against = 0.0F, refuted = 0.0F;
  };
  Agreement::Counts counts;  ///< of patches
  std::vector<Cell> cells;
  double known = 0.0, against = 0.0;  ///< cells
  /// Cells with surfaces in empty space, or with clean ones beside a surface that heads the same way.
  double refuted = 0.0;

  [[nodiscard]] double sum() const { return kGain * known - against; }
  /// What a cell that fits counts for, where one that is refuted counts 1 against. Of simulated worlds 3 to 5
  /// of a hundred cells speak against right poses, where things have moved and at edges, and 7 and more
  /// against most wrong ones.
  static constexpr double kGain = 0.07;
};
[[nodiscard]] Evidence evidence_of(const Witnesses& witnesses, const Pose& pose, const Observed& other,
                                   double tolerance);

/// The same of rays: a clean patch is known where it is on a surface of the other cloud, or `pierced` (1, one
/// number for each witness) by a ray of it, which speaks against the pose.
[[nodiscard]] Evidence evidence_of(const Witnesses& witnesses, std::span<const std::uint8_t> pierced,
                                   const Pose& pose, const PatchLevel& other, double tolerance);

/// `tolerance` (m): how far from a surface is on it.
[[nodiscard]] Agreement agreement_of(std::span<const JudgedPatch> patches, const Pose& pose,
                                     const Observed& other, double tolerance);

}  // namespace ray::align
