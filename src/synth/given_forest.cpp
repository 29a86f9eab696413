/// The world around the trees of a file.

#include "grow_tree.h"
#include "outdoors.h"

#include <raycloud/core/error.h>
#include <raycloud/synth/scenes.h>

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

void check(const Tree& tree, std::size_t number) {
  const auto fail = [&](std::size_t segment, const std::string& what) {
    throw Error(ErrorCode::wrong_content,
                "tree " + std::to_string(number) + ", segment " + std::to_string(segment + 1) + ": " + what);
  };
  if (tree.segments.empty())
    throw Error(ErrorCode::wrong_content, "tree " + std::to_string(number) + " has no segments");
  for (std::size_t i = 0; i < tree.segments.size(); ++i) {
    const TreeSegment& segment = tree.segments[i];
    if (!segment.position.allFinite() || !std::isfinite(segment.radius)) fail(i, "a number is not finite");
    if (segment.radius <= 0.0) fail(i, "the radius must be positive");
    if (segment.parent != TreeSegment::kNoParent && segment.parent >= i)
      fail(i, "the parent must be before it");
  }
}

// The attribute of a tree; nothing if the file has none or one that is not positive.
std::optional<double> attribute(const Forest& forest, const Tree& tree, const char* name) {
  const auto& names = forest.tree_attributes;
  const auto place = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  if (place >= tree.attributes.size() || !(tree.attributes[place] >= 0.0)) return std::nullopt;
  return tree.attributes[place];
}

std::vector<Eigen::Vector3d> feet_of(const Forest& forest) {
  std::vector<Eigen::Vector3d> feet;
  for (const Tree& tree : forest.trees)
    feet.push_back(tree.segments.front().position);
  return feet;
}

// Passes through all feet, level with the nearest where there is none (Shepard 1968, power 4).
double height_between(const std::vector<Eigen::Vector3d>& feet, double x, double y) {
  double weights = 0.0;
  double sum = 0.0;
  for (const Eigen::Vector3d& foot : feet) {
    const double squared = (foot.head<2>() - Eigen::Vector2d(x, y)).squaredNorm();
    if (squared < 1e-6) return foot.z();
    weights += 1 / (squared * squared);
    sum += foot.z() / (squared * squared);
  }
  return sum / weights;
}

Mesh ground_under(const std::vector<Eigen::Vector3d>& feet) {
  constexpr double kRimOfTrees = 12.0;
  constexpr double kCells = 300.0;  // at most, a side
  Area area{feet.front().head<2>(), feet.front().head<2>()};
  for (const Eigen::Vector3d& foot : feet) {
    area.low = area.low.cwiseMin(foot.head<2>());
    area.high = area.high.cwiseMax(foot.head<2>());
  }
  area.low.array() -= kRimOfTrees;
  area.high.array() += kRimOfTrees;
  const double cell = std::max(0.5, area.size().maxCoeff() / kCells);
  return height_field(area, cell, [&](double x, double y) { return height_between(feet, x, y); });
}

Tree with_branches(const Tree& tree, std::optional<double> given_height, const RandomStream& random) {
  const bool has_branches =
      std::any_of(tree.segments.begin(), tree.segments.end(),
                  [](const TreeSegment& segment) { return segment.parent != TreeSegment::kNoParent; });
  if (has_branches) return tree;
  const TreeSegment& foot = tree.segments.front();
  const double height =
      given_height.value_or(0.0) > 0.0 ? *given_height : 2 * foot.radius * broadleaf().slenderness;
  Tree grown = grow_tree(broadleaf(), {foot.position, height, foot.radius}, random);
  for (TreeSegment& segment : grown.segments)
    segment.attributes = foot.attributes;
  grown.attributes = tree.attributes;
  return grown;
}

Foliage foliage_for(const Tree& tree, std::optional<double> leaf_area) {
  Foliage foliage{.leaves_per_end = 6, .leaf_area = 0.0025, .leaf_length = 0.08};
  if (!leaf_area) return foliage;
  if (*leaf_area == 0.0) foliage.leaves_per_end = 0;
  if (foliage.leaves_per_end == 0) return foliage;
  foliage.leaf_area = *leaf_area / static_cast<double>(std::max<std::size_t>(leaf_count(tree, foliage), 1));
  foliage.leaf_length = std::sqrt(2.6 * foliage.leaf_area);
  return foliage;
}

}  // namespace

Scene forest_scene(const Forest& trees, std::uint64_t seed) {
  if (trees.trees.empty()) throw Error(ErrorCode::no_data, "there are no trees");
  for (std::size_t i = 0; i < trees.trees.size(); ++i)
    check(trees.trees[i], i + 1);
  SceneBuilder scene("forest", seed);
  const std::vector<Eigen::Vector3d> feet = feet_of(trees);
  const Mesh field = ground_under(feet);
  scene.scene().ground = field;
  scene.add(SceneLabel::ground, "ground", field);
  Forest& forest = scene.scene().forest;
  forest.comments = trees.comments;
  forest.tree_attributes = trees.tree_attributes;
  forest.segment_attributes = trees.segment_attributes;
  name_tree_attributes(forest);
  for (std::size_t i = 0; i < trees.trees.size(); ++i) {
    const Tree& given = trees.trees[i];
    const std::string number = std::to_string(i);
    Tree tree = with_branches(given, attribute(trees, given, "height"), scene.random("growth " + number));
    const Foliage foliage = foliage_for(tree, attribute(trees, given, "leaf_area"));
    add_tree(scene, std::move(tree), foliage, scene.random("leaves " + number));
  }
  state_tree_facts(scene);
  const Ground ground(field);
  const Area area = ground.area();
  const double cell = std::max(0.25, area.size().maxCoeff() / 500);
  const int rows = std::clamp(static_cast<int>(area.size().y() / 12), 2, 40);
  const int columns = std::clamp(static_cast<int>(area.size().x() / 12), 2, 40);
  const Eigen::Vector2d rim(3, 3);
  walk_outdoors(scene, ground, area, {.cell = cell, .clearance = std::max(0.6, 2 * cell)},
                meander({area.low + rim, area.high - rim}, rows, columns, 2.0, scene.random("walk")),
                {.head = 1.5, .speed = 1.0});
  return scene.take();
}

}  // namespace ray
