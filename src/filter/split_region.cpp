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
    // Of a convex region a ray has at most one piece inside and two outside.
    inside.resize(rays.size());
    outside.resize(2 * rays.size());
    const std::array<std::uint32_t*, 2> parts{inside.data(), outside.data()};
    std::array<std::size_t, 2> counts{};
    const Region region = region_;  // in registers
    std::vector<CutPiece> pieces;
    std::vector<Stretch> way;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool starts_inside = region.contains(rays.starts[i]), ends_inside = region.contains(rays.ends[i]);
      std::uint32_t part = ends_inside ? 0 : 1;
      const bool stays = starts_inside == ends_inside && (ends_inside || Region::kConvexOutside);
      if (!stays) part = way_through(region, rays.starts[i], rays.ends[i], stored_, way);
      if (stays || way.empty()) {
        parts[part][counts[part]++] = static_cast<std::uint32_t>(i);
        continue;
      }
      each_piece(rays.starts[i], rays.bounded[i] != 0, way,
                 [&](std::uint32_t piece_part, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                     std::uint8_t flags) {
                   parts[piece_part][counts[piece_part]++] =
                       static_cast<std::uint32_t>(rays.size() + pieces.size());
                   pieces.push_back({i, start, end, flags});
                 });
    }
    inside.resize(counts[0]);
    outside.resize(counts[1]);
    append_pieces(rays, pieces);
  }

 private:
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
