#pragma once
/// Which kept ray stands for each ray of a cloud that was thinned.

#include <raycloud/filter/restore.h>
#include <raycloud/spatial/key_table.h>

#include <cstdint>
#include <functional>
#include <vector>

namespace ray {

/// Groups are numbered in the order in which their first rays come, which is the order of the decimated
/// cloud.
class RayGroups {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  explicit RayGroups(const Decimation& decimation);

  /// Reads the full cloud; calls `see(rays)` with the first rays of the groups, in order, some at a time.
  void gather(const Context& context, RaySource& full, const std::function<void(const RayCloud&)>& see);
  [[nodiscard]] std::uint32_t count() const { return count_; }

  /// Of consecutive rays, the first of which is number `row` of the cloud. Thread-safe.
  [[nodiscard]] std::vector<std::uint32_t> of(const RayCloud& rays, std::uint64_t row) const;

  /// Whether `of` looks at the number of the row and not at the place.
  [[nodiscard]] bool by_row() const { return every_ != 0; }
  [[nodiscard]] std::uint64_t every() const { return every_; }
  [[nodiscard]] Metres width() const { return width_; }

  /// The group of a cube, or kNone. Precondition: not by_row().
  [[nodiscard]] std::uint32_t at(const VoxelIndex& cube) const;

 private:
  std::vector<std::uint8_t> first_of_each(const VoxelKeys& cubes);
  std::vector<std::uint8_t> first_of_each(std::uint64_t row, std::size_t count);

  Metres width_;
  std::uint64_t every_ = 0;  // 0: by cubes
  std::uint32_t count_ = 0;
  VoxelTable<std::uint32_t> cubes_;
};

}  // namespace ray
