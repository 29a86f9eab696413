#include "convex_region.h"
#include "ray_pieces.h"
#include "require.h"

#include <raycloud/core/error.h>
#include <raycloud/filter/split.h>

#include <array>
#include <cmath>

namespace ray {
namespace {

template <class Region>
class RegionRule final : public SplitRule {
 public:
  RegionRule(const Region& region, Precision stored) : region_(region), stored_(stored) {}

  std::vector<ColumnInfo> columns(std::vector<ColumnInfo> source) const override {
    return with_clipped(std::move(source));
  }

  void apply(RayCloud& rays, std::vector<std::uint32_t>& inside,
             std::vector<std::uint32_t>& outside) const override {
    const std::array<std::vector<std::uint32_t>*, 2> parts{&inside, &outside};
    for (std::vector<std::uint32_t>* part : parts)
      part->clear();
    std::vector<CutPiece> pieces;
    std::vector<Stretch> way;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::uint32_t part = part_of(rays.starts[i], rays.ends[i], way);
      if (way.empty()) {
        parts[part]->push_back(static_cast<std::uint32_t>(i));
        continue;
      }
      each_piece(rays.starts[i], rays.bounded[i] != 0, way,
                 [&](std::uint32_t piece_part, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                     std::uint8_t flags) {
                   parts[piece_part]->push_back(static_cast<std::uint32_t>(rays.size() + pieces.size()));
                   pieces.push_back({i, start, end, flags});
                 });
    }
    append_pieces(rays, pieces);
  }

 private:
  /// As way_through; most rays are seen at once to stay on one side.
  [[nodiscard]] std::uint32_t part_of(const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                                      std::vector<Stretch>& way) const {
    way.clear();
    const bool starts_inside = region_.contains(start), ends_inside = region_.contains(end);
    if (starts_inside && ends_inside) return 0;
    if (Region::kConvexOutside && !starts_inside && !ends_inside) return 1;
    return way_through(region_, start, end, stored_, way);
  }

  Region region_;
  Precision stored_;
};

}  // namespace

SplitRulePtr split_by_plane(const Eigen::Vector3d& point, Precision stored) {
  const double squared = point.squaredNorm();
  require(std::isnormal(squared),
          "the plane's point is its normal too: it cannot be 0,0,0, nor so small or large that its square is "
          "not a number");
  return std::make_unique<RegionRule<HalfSpace>>(HalfSpace{point}, stored);
}

SplitRulePtr split_by_box(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii, Precision stored) {
  require(centre.allFinite() && radii.allFinite() && (radii.array() > 0.0).all(),
          "the radii of the box must be more than 0");
  return std::make_unique<RegionRule<Box>>(Box{centre - radii, centre + radii}, stored);
}

SplitRulePtr split_by_capsule(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Metres radius,
                              Precision stored) {
  require(from.allFinite() && to.allFinite() && std::isfinite(radius.value) && radius.value > 0.0,
          "the radius of the capsule must be more than 0");
  return std::make_unique<RegionRule<Capsule>>(Capsule{from, to, radius.value}, stored);
}

}  // namespace ray
