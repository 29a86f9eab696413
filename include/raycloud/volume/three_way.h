#pragma once
/// What two branches have made of a map (paper, section VI-B): what both left as it was, and what each has
/// that the map had not.

#include <raycloud/core/column.h>
#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/context.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace ray {

/// Base, cloud 1, cloud 2.
using ThreeClouds = std::array<RaySource*, 3>;
using ThreeSchemas = std::array<std::vector<ColumnInfo>, 3>;

/// How clouds with different columns are brought together.
struct ThreeWayColumns {
  std::vector<std::string> compared;  ///< those that all three have: rays are the same if these are
  std::vector<std::string> result;    ///< those, and what a branch has added
  std::size_t kept_from = 0;          ///< the cloud that has them all, from which unchanged rays come
};

/// A column that a branch has added is in the result, one that a branch has taken out is not. Throws
/// Error(wrong_content) if both have added columns that the other has not.
[[nodiscard]] ThreeWayColumns three_way_columns(const ThreeSchemas& schemas);

/// A ray is the same in two clouds if all bits of its end, start, time, colour and compared columns are; a
/// ray of which anything was changed is another ray. Of rays that come several times each copy counts.
class ThreeWay {
 public:
  /// Reads each cloud once, O(n log n). 48 bytes a ray meanwhile, in temporary files if that is more than
  /// context.memory; 2 bits after. All three have the same columns, among them the given ones. They must
  /// outlive this and its parts.
  ThreeWay(const Context& context, const ThreeClouds& clouds, ThreeWayColumns columns);

  struct Counts {
    std::uint64_t rays = 0;  ///< of all three
    std::uint64_t base = 0;
    std::uint64_t kept = 0;                ///< rays of the base that both clouds have
    std::array<std::uint64_t, 2> added{};  ///< rays of each cloud that the base has not
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }

  /// The rays that all three clouds have, once.
  [[nodiscard]] std::unique_ptr<RaySource> kept() const;
  /// The rays of cloud 1 (`branch` 0) or 2 that the base has not. To merge them completes the job; those that
  /// both have added are in both.
  [[nodiscard]] std::unique_ptr<RaySource> added(std::size_t branch) const;

 private:
  ThreeClouds clouds_;
  ThreeWayColumns columns_;
  Counts counts_;
  std::vector<std::uint64_t> first_;
  std::vector<bool> kept_, added_;  ///< by number
};

}  // namespace ray
