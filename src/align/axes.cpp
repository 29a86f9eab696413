#include "ground.h"
#include "walls.h"

#include <raycloud/align/axes.h>
#include <raycloud/core/error.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

namespace ray {
namespace {

using namespace align;

constexpr double kMostSlope = 10.0 * std::numbers::pi / 180.0;  // of a floor

/// The outermost strong line at one end of an axis.
struct OuterWall {
  double offset = 0.0;
  double area = 0.0;
};

/// Of the lines normal to an axis, those at its low and high end that have a sixth of the area of the
/// strongest: what is outside is often seen less than corridors are.
std::array<OuterWall, 2> outer_walls(const std::vector<WallLine>& lines) {
  constexpr double kShare = 1.0 / 6.0;
  double most = 0.0;
  for (const WallLine& line : lines)
    most = std::max(most, line.area);
  const auto is_strong = [&](const WallLine& line) { return line.area >= kShare * most; };
  const auto low = std::find_if(lines.begin(), lines.end(), is_strong);
  const auto high = std::find_if(lines.rbegin(), lines.rend(), is_strong);
  return {OuterWall{low->offset, low->area}, OuterWall{high->offset, high->area}};
}

/// Where the corner is, and by how many quarter turns the building must be turned so that it lies in the
/// quadrant of positive x and y.
struct Corner {
  Eigen::Vector2d place;
  int quarters = 0;
};

Corner corner_of(const WallGrid& grid) {
  const std::array<std::array<OuterWall, 2>, 2> walls{outer_walls(grid.lines[0]), outer_walls(grid.lines[1])};
  std::size_t strongest = 0;
  const auto area = [&](std::size_t axis, std::size_t end) { return walls[axis][end].area; };
  for (std::size_t i = 1; i < 4; ++i)
    if (area(i / 2, i % 2) > area(strongest / 2, strongest % 2)) strongest = i;
  const std::size_t axis = strongest / 2, other = 1 - axis;
  std::array<std::size_t, 2> ends{};
  ends[axis] = strongest % 2;
  ends[other] = area(other, 1) > area(other, 0) ? 1 : 0;
  // Seen from the corner (low, low) the building is where it should be; from the others in turn it must be
  // turned back by one, two or three quarters.
  constexpr std::array<std::array<int, 2>, 2> kQuarters{{{0, 1}, {3, 2}}};
  return {{walls[0][ends[0]].offset, walls[1][ends[1]].offset}, kQuarters[ends[0]][ends[1]]};
}

Eigen::Matrix3d turn(double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

Eigen::Matrix3d quarter_turns(int quarters) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  constexpr std::array<int, 4> kCosine{1, 0, -1, 0}, kSine{0, 1, 0, -1};
  const auto at = static_cast<std::size_t>(quarters);
  rotation.topLeftCorner<2, 2>() << kCosine[at], -kSine[at], kSine[at], kCosine[at];
  return rotation;
}

void turn_uprights(std::vector<Upright>& patches, const Eigen::Matrix3d& rotation, const PatchLevel& level) {
  patches.clear();
  for (Patch patch : level.patches()) {
    patch.normal = rotation * patch.normal;
    patch.mean = rotation * patch.mean;
    if (patch.is_flat() && patch.is_upright()) patches.push_back(upright_of(patch));
  }
}

}  // namespace

AxesAlignment align_to_axes(const Context& context, RaySource& source, const AxesRule& rule) {
  constexpr double kLeastPoints = 6.0;
  constexpr double kLeastShare = 0.3;  // 0.067 where walls head anywhere
  AxesAlignment alignment;
  const Survey survey = survey_ends(context, source);
  alignment.dropped = survey.dropped;
  if (survey.bounded == 0) throw Error(ErrorCode::no_data, "no ray is bounded, so there is nothing to align");
  if (!(survey.spacing > 0.0)) throw Error(ErrorCode::no_data, "there are too few points to align to");
  const Surfaces surfaces = gather_surfaces(context, source, survey, patch_width(survey));
  const PatchLevel fine(context, surfaces, 2, kLeastPoints), coarse(context, surfaces, 4, kLeastPoints);

  Eigen::Matrix3d level = Eigen::Matrix3d::Identity();
  std::vector<Floor> floors = floor_patches(fine, rule.level ? 2.0 * kMostSlope : kMostSlope);
  if (rule.level) {
    const auto found = levelling(floors);
    if (!found)
      throw Error(ErrorCode::no_data, "no level surface is seen from above, so there is no ground to level");
    level = *found;
    for (Floor& floor : floors)
      floor.place = level * floor.place, floor.normal = level * floor.normal;
    std::erase_if(floors, [](const Floor& floor) { return floor.normal.z() < std::cos(kMostSlope); });
  }
  const auto ground = ground_of(floors);
  if (!ground) throw Error(ErrorCode::no_data, "no level surface is seen from above, so there is no ground");
  alignment.ground_area = ground->area;

  std::vector<Upright> uprights;
  turn_uprights(uprights, level, coarse);
  const Heading heading = heading_of(uprights);
  turn_uprights(uprights, level, fine);
  const WallGrid grid = fit_walls(uprights, heading.angle, fine.width());
  alignment.wall_share = heading.share;
  alignment.wall_area = heading.area;
  if (heading.share < kLeastShare || grid.lines[0].empty() || grid.lines[1].empty())
    throw Error(ErrorCode::no_data, "there are no walls along two orthogonal directions to align to (" +
                                        std::to_string(std::lround(100.0 * heading.share)) +
                                        " % of the upright surfaces agree)");
  alignment.wall_residual = grid.residual;
  alignment.yaw_sigma = grid.sigma;

  const Corner corner = corner_of(grid);
  const Eigen::Matrix3d quarters = quarter_turns(corner.quarters);
  alignment.pose.rotation = quarters * turn(-grid.angle) * level;
  const Eigen::Vector3d origin(corner.place.x(), corner.place.y(), ground->height);
  alignment.pose.translation = -(quarters * origin) - alignment.pose.rotation * survey.origin;
  return alignment;
}

}  // namespace ray
