#pragma once
/// Rules that sort rays whole.

#include <raycloud/filter/split.h>

#include <utility>

namespace ray {

/// `inside(rays, row)` decides.
template <class Test>
class WholeRays final : public SplitRule {
 public:
  explicit WholeRays(Test inside) : inside_(std::move(inside)) {}

  std::vector<ColumnInfo> columns(std::vector<ColumnInfo> source) const override { return source; }

  /// Every row is written to both sides and stays in one: a branch would be mispredicted as often as not.
  void apply(RayCloud& rays, std::vector<std::uint32_t>& inside,
             std::vector<std::uint32_t>& outside) const override {
    inside.resize(rays.size());
    outside.resize(rays.size());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      inside[kept] = outside[i - kept] = static_cast<std::uint32_t>(i);
      kept += inside_(rays, i) ? 1 : 0;
    }
    inside.resize(kept);
    outside.resize(rays.size() - kept);
  }

 private:
  Test inside_;
};

template <class Test>
[[nodiscard]] SplitRulePtr whole_rays(Test inside) {
  return std::make_unique<WholeRays<Test>>(std::move(inside));
}

}  // namespace ray
