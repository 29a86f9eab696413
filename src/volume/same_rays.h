#pragma once
/// Which rays of several clouds are the same.

#include "numbered_cloud.h"
#include "ray_key.h"

#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/parallel.h>
#include <raycloud/exec/spilled_rows.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace ray {

struct NumberedRay {
  RayKey key;
  std::uint32_t number = 0;
  friend auto operator<=>(const NumberedRay&, const NumberedRay&) = default;
};

/// The rays of all clouds, with numbers that go on from cloud to cloud: ray `i` of a chunk is number
/// `clouds()[cloud].first_of(raw) + i`. Some numbers may have no ray.
class NumberedRays {
 public:
  /// Reads every cloud once and rewinds it. 48 bytes a ray; where that is more than context.memory, the rays
  /// go to temporary files, parted by their keys. About 0.3 µs of one core a ray. Throws Error(out_of_range)
  /// for more than 4 billion rays.
  NumberedRays(const Context& context, std::span<RaySource* const> sources, const RayKeyRule& rule);

  [[nodiscard]] const std::vector<NumberedCloud>& clouds() const { return clouds_; }
  /// The number after the last.
  [[nodiscard]] std::uint64_t numbers() const { return numbers_; }
  [[nodiscard]] std::uint64_t rays() const { return count_; }
  /// The number after the last of the cloud that this ray is of.
  [[nodiscard]] std::uint64_t end_of_cloud_with(std::uint32_t number) const;

  /// `see(same)` for all rays of each key: a span of NumberedRay, in order of their numbers. Called once.
  template <class See>
  void each_group(const Context& context, const See& see) {
    if (!parted_) return each_group_of(context, rays_, see);
    for (std::size_t part = 0; part < kParts; ++part) {
      check_cancelled(context);
      rays_ = parted_->read_all(part);
      parted_->drop(part);
      each_group_of(context, rays_, see);
    }
  }

 private:
  static constexpr std::size_t kParts = 256;

  void add_cloud(const Context& context, RaySource& source, const RayKeyRule& rule);
  void add(std::span<const RayKey> keys, std::uint64_t first);
  void part();
  template <class See>
  static void each_group_of(const Context& context, std::vector<NumberedRay>& rays, const See& see) {
    parallel_sort(context, rays.begin(), rays.end());
    for (std::size_t begin = 0, end = 0; begin < rays.size(); begin = end) {
      while (end < rays.size() && rays[end].key == rays[begin].key)
        ++end;
      see(std::span<const NumberedRay>(rays).subspan(begin, end - begin));
    }
  }

  std::vector<NumberedCloud> clouds_;
  std::uint64_t numbers_ = 0, count_ = 0;
  std::size_t memory_, most_;  ///< rays in memory
  std::vector<NumberedRay> rays_;
  std::unique_ptr<SpilledRows<NumberedRay>> parted_;  ///< by the highest bits of the keys
};

/// For each number that of the ray that stands for it: the first of all clouds that is the same. Rays that
/// come several times in one cloud stand for as many in another, each for one. 4 bytes a ray.
[[nodiscard]] std::vector<std::uint32_t> leaders_of(const Context& context, NumberedRays& numbered);

/// What two clouds must agree in to have the same rays.
[[nodiscard]] RayKeyRule key_rule(std::span<RaySource* const> clouds, std::vector<std::string> columns);

}  // namespace ray
