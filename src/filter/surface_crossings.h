#pragma once
/// Flat patches fitted to end points, and which rays cross them on their way: private to the origin audit.

#include <raycloud/exec/context.h>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace ray {

/// Patches in cubes of 0.25 m: at least 6 ends, thinner than a tenth of the cube. O(n log n) time for n
/// ends, 24 bytes each.
class SurfacePatches {
 public:
  SurfacePatches(const Context& context, std::span<const Eigen::Vector3d> ends);

  /// True if the way from `start` to `end`, without its first half metre and its last metre (or 5 %), crosses
  /// a patch at more than 17 degrees. At most the last 100 m are looked at.
  [[nodiscard]] bool blocks(const Eigen::Vector3d& start, const Eigen::Vector3d& end) const;

  [[nodiscard]] std::size_t size() const { return patches_.size(); }

 private:
  struct Patch {
    Eigen::Vector3d centre;
    Eigen::Vector3d normal;
    double radius_squared;
  };
  [[nodiscard]] static std::optional<Patch> fit(std::span<const Eigen::Vector3d> ends);
  [[nodiscard]] bool maybe(std::uint64_t hash) const {
    return (filter_[(hash >> 6) % filter_.size()] >> (hash & 63) & 1) != 0;
  }

  std::unordered_map<std::uint64_t, Patch> patches_;
  std::vector<std::uint64_t> filter_;  // a bit for each cube that may have a patch, by hash
};

}  // namespace ray
