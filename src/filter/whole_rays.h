#pragma once
/// Rules that sort rays whole.

#include "ray_pieces.h"

#include <raycloud/filter/split.h>

#include <utility>

namespace ray {

/// `inside(rays, row)` decides.
template <class Test>
class WholeRays final : public SplitRule {
 public:
  explicit WholeRays(Test inside) : inside_(std::move(inside)) {}

  std::vector<ColumnInfo> columns(std::vector<ColumnInfo> source) const override { return source; }

  void apply(const RayCloud& rays, RayCloud& inside, RayCloud& outside) const override {
    std::vector<std::uint8_t> mask(rays.size());
    for (std::size_t i = 0; i < mask.size(); ++i)
      mask[i] = inside_(rays, i) ? 1 : 0;
    sort_rows(rays, mask, inside, outside);
  }

 private:
  Test inside_;
};

template <class Test>
[[nodiscard]] SplitRulePtr whole_rays(Test inside) {
  return std::make_unique<WholeRays<Test>>(std::move(inside));
}

}  // namespace ray
