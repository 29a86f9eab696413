#pragma once
/// An even sample of the ends of a cloud, from which blocks of space are cut and spacings are estimated.

#include <raycloud/core/ray_cloud.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ray {

/// An even sample of the ends of the bounded rays: the same for a cloud however it is read and worked on.
struct EndSample {
  std::vector<Eigen::Vector3d> ends;  ///< every so many, in order; all of a small cloud
  std::uint64_t bounded = 0;          ///< rays of the cloud
};

namespace blocks {

/// Takes every so many of the ends of the bounded rays that it is shown.
class EndSampler {
 public:
  /// `bounded` of the rays are.
  void add(const RayCloud& rays, std::size_t bounded) {
    const std::uint64_t before = sample_.bounded;
    sample_.bounded += bounded;
    std::size_t row = 0;
    std::uint64_t passed = before;  // bounded rays in front of the row
    while (next_ < sample_.bounded) {
      if (sample_.ends.size() == kMost) thin();
      if (bounded == rays.size())
        row = static_cast<std::size_t>(next_ - before);
      else
        while (rays.bounded[row] == 0 || passed++ < next_)
          ++row;
      sample_.ends.push_back(rays.ends[row++]);
      next_ += stride_;
    }
  }
  [[nodiscard]] const EndSample& sample() const { return sample_; }

 private:
  static constexpr std::size_t kMost = 1 << 16;
  void thin() {
    for (std::size_t i = 0; i < kMost / 2; ++i)
      sample_.ends[i] = sample_.ends[2 * i];
    sample_.ends.resize(kMost / 2);
    stride_ *= 2;
  }
  EndSample sample_;
  std::uint64_t stride_ = 1;
  /// The bounded ray to be taken next. Stays so when the sample is thinned, being kMost strides from the
  /// first.
  std::uint64_t next_ = 0;
};

}  // namespace blocks

}  // namespace ray
