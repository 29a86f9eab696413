#pragma once
/// What the rays of two clouds, its own and another, tell of ellipsoids.

#include "cloud_conflicts.h"
#include "contradiction.h"
#include "crossing_rays.h"
#include "encounters.h"

#include <raycloud/exec/context.h>

#include <functional>
#include <span>
#include <vector>

namespace ray {

/// Rays, and their numbers.
using SeeRays = std::function<void(const RayCloud& rays, std::span<const std::uint32_t> numbers)>;

/// Those of one cloud that may meet some ellipsoids.
struct MeetingRays {
  const NumberedCloud& cloud;
  std::function<void(const SeeRays&)> each;  ///< in pieces, on any thread
};

/// What a question asks of every ray, whichever ellipsoids it meets.
class ConflictRule {
 public:
  ConflictRule(const Context& context, const ConflictQuestion& question, double range_noise);

  [[nodiscard]] const Sides& sides(std::size_t other) const { return sides_[other]; }
  [[nodiscard]] const CountRule& counting() const { return counting_; }
  [[nodiscard]] bool paper() const { return question_.rule.paper; }
  [[nodiscard]] bool gives_way(float score) const { return static_cast<double>(score) > question_.rule.rays; }

  /// Numbers the rays of a cloud and leaves out those that contradict nothing.
  [[nodiscard]] NumberRays numbering(std::size_t cloud) const;
  /// All of them, from the cloud itself.
  [[nodiscard]] MeetingRays rays_of(std::size_t cloud) const;
  /// Those that are in a block.
  [[nodiscard]] MeetingRays rays_of(std::size_t cloud, CrossingRays& rays, std::size_t part) const;

  /// The slots of the ellipsoids that enough of the rays pass to change a score.
  [[nodiscard]] std::vector<std::uint32_t> passed_slots(const EllipsoidTree& tree,
                                                        const MeetingRays& rays) const;
  /// Whether what the other cloud met can change a score, whatever its own did: as opaque as it may be,
  /// enough passes are left when twice the hits are taken off.
  [[nodiscard]] bool may_contradict(const Encounters& other) const {
    return other.passes >= fewest_ + kOfEachHit * other.hits;
  }
  /// By slot.
  [[nodiscard]] std::vector<Encounters> met_by(const EllipsoidTree& tree, const MeetingRays& rays) const;
  /// As if the other cloud's passes were one run before or after the hits of its own.
  [[nodiscard]] Evidence evidence(const Encounters& own, const Encounters& other) const;

 private:
  static constexpr std::uint64_t kOfEachHit = 2;

  const Context& context_;
  const ConflictQuestion& question_;
  std::uint64_t fewest_;  ///< passes that change a score
  CountRule counting_;
  FineTime times_;
  std::vector<Sides> sides_;
};

/// An ellipsoid whose passes contradict it, and the number of rays up to which they do.
struct PassConflict {
  std::uint32_t ellipsoid = 0;
  float score = 0.0F;
  float opacity = 0.0F;  ///< the share of its own rays that ended in it
};
/// Adds it if the run is longer than it may be by chance.
void add_pass_conflict(std::uint32_t ellipsoid, float score, const Evidence& evidence, bool paper,
                       std::vector<PassConflict>& conflicts);
/// Tells of the rays that pass ellipsoids; conflict `i` is about that at `tree.slot(i)`.
void tell_passes(const EllipsoidTree& tree, std::span<const PassConflict> conflicts, const PassGuard& guard,
                 const MeetingRays& rays, const TellScores& tell);

/// Tells of all ends of a cloud: `scores(rays, first)` are those of the bounded rays of its chunks, in order.
void tell_ends(const Context& context, const NumberedCloud& cloud,
               const std::function<std::span<const float>(const RayCloud& rays)>& scores,
               const TellScores& tell);

}  // namespace ray
