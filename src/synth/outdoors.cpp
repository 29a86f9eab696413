#include "outdoors.h"

#include "indoors.h"
#include "turn.h"

#include <raycloud/core/error.h>
#include <raycloud/synth/scenes.h>

#include <algorithm>

namespace ray {

Shrub grow_shrub(double height, const RandomStream& random, std::uint64_t index) {
  constexpr std::uint64_t kStems = 7;
  constexpr std::uint64_t kLeaves = 40;
  constexpr double kLeafArea = 0.003;
  std::uint64_t draw = 0;
  MeshBuilder builder;
  for (std::uint64_t stem = 0; stem < kStems; ++stem) {
    const Eigen::Vector2d out = turned(random.uniform(index, draw++));
    const double lean = between(0.1, 0.7, random, index, draw++);
    const double length = height * between(0.6, 1.0, random, index, draw++);
    const Eigen::Vector3d foot(0.05 * out.x(), 0.05 * out.y(), -0.1);
    const Eigen::Vector3d along = Eigen::Vector3d(lean * out.x(), lean * out.y(), 1).normalized();
    builder.tube(foot, 0.012, foot + length * along, 0.004, 5);
    for (std::uint64_t i = 0; i < kLeaves; ++i) {
      const double fraction = 0.25 + 0.75 * random.uniform(index, draw++);
      const Eigen::Vector3d away = random_direction(random, index, draw);
      const Eigen::Vector3d facing = random_direction(random, index, draw + 2);
      const AcrossAxes axes = across(facing);
      draw += 4;
      const Eigen::Vector3d place =
          foot + fraction * length * along + 0.22 * height * random.uniform(index, draw++) * away;
      builder.leaf(place, place + 0.08 * facing, axes.first, axes.second, kLeafArea, 0.2);
    }
  }
  return {builder.take(), kStems * kLeaves * kLeafArea};
}

Mesh boulder(double radius, const RandomStream& random, std::uint64_t index) {
  Mesh mesh = icosphere(3);
  const double shift = 100 * random.uniform(index);
  const double flat = between(0.55, 0.8, random, index, 1);
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    const double bump = fractal(random, vertex.x() + 0.7 * vertex.z() + shift, vertex.y() - 0.6 * vertex.z(),
                                {.wavelength = 1.3, .height = 0.55, .octaves = 4});
    vertex *= radius * (1 + bump);
    vertex.z() = flat * vertex.z() + 0.25 * radius;
  }
  return mesh;
}

Mesh grass_tuft(const Eigen::Vector3d& place, double height, const RandomStream& random,
                std::uint64_t index) {
  constexpr std::uint64_t kBlades = 24;
  MeshBuilder builder;
  for (std::uint64_t blade = 0; blade < kBlades; ++blade) {
    const Eigen::Vector2d out = turned(random.uniform(index, 3 * blade));
    const double lean = between(0.1, 0.8, random, index, 3 * blade + 1);
    const double length = height * between(0.6, 1.0, random, index, 3 * blade + 2);
    const Eigen::Vector3d root = place + Eigen::Vector3d(0.06 * out.x(), 0.06 * out.y(), -0.02);
    const Eigen::Vector3d side(-0.008 * out.y(), 0.008 * out.x(), 0);
    builder.triangle(root - side, root + side,
                     root + length * Eigen::Vector3d(lean * out.x(), lean * out.y(), 1).normalized());
  }
  return builder.take();
}

Mesh fallen_trunk(const Ground& ground, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double radius,
                  const RandomStream& random, std::uint64_t index) {
  constexpr int kPieces = 7;
  MeshBuilder builder;
  const auto radius_at = [&](int i) { return radius * (1 - 0.6 * i / kPieces); };
  const auto place = [&](int i) {
    const Eigen::Vector2d flat = from + (to - from) * i / kPieces;
    return Eigen::Vector3d(flat.x(), flat.y(), ground.at(flat.x(), flat.y()) + 0.85 * radius_at(i));
  };
  for (int i = 0; i < kPieces; ++i)
    builder.tube(place(i), radius_at(i), place(i + 1), radius_at(i + 1), 20);
  for (int i = 3; i < kPieces; ++i) {
    const auto key = static_cast<std::uint64_t>(2 * i);
    Eigen::Vector3d out = random_direction(random, index, key);
    out.z() = std::abs(out.z()) + 0.3;
    builder.tube(place(i), 0.25 * radius_at(i), place(i) + 0.9 * out.normalized(), 0.12 * radius_at(i), 8);
  }
  return builder.take();
}

void name_tree_attributes(Forest& forest) {
  for (const char* name : {"height", "crown_radius", "leaf_area", "wood_volume"}) {
    const auto& names = forest.tree_attributes;
    if (std::find(names.begin(), names.end(), name) == names.end()) forest.tree_attributes.emplace_back(name);
  }
}

void add_tree(SceneBuilder& scene, Tree tree, const Foliage& foliage, const RandomStream& leaves) {
  Forest& forest = scene.scene().forest;
  const std::string name = "tree " + std::to_string(forest.trees.size() + 1);
  Wood wood = wood_mesh(tree);
  Mesh leaf = leaf_mesh(tree, foliage, leaves);
  if (!wood.trunk.empty()) scene.add(SceneLabel::trunk, name + " trunk", std::move(wood.trunk));
  if (!wood.branches.empty()) scene.add(SceneLabel::branch, name + " branches", std::move(wood.branches));
  if (!leaf.empty()) scene.add(SceneLabel::leaf, name + " leaves", std::move(leaf));
  tree.attributes.resize(forest.tree_attributes.size());
  const auto state = [&](const char* attribute, double value) {
    const auto& names = forest.tree_attributes;
    tree.attributes[static_cast<std::size_t>(std::find(names.begin(), names.end(), attribute) -
                                             names.begin())] = value;
  };
  state("height", tree_height(tree));
  state("crown_radius", crown_radius(tree));
  state("leaf_area", static_cast<double>(leaf_count(tree, foliage)) * foliage.leaf_area);
  state("wood_volume", wood_volume(tree));
  forest.trees.push_back(std::move(tree));
}

void state_tree_facts(SceneBuilder& scene) {
  const Forest& forest = scene.scene().forest;
  const auto& names = forest.tree_attributes;
  const auto sum_of = [&](const char* attribute) {
    const auto place =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), attribute) - names.begin());
    double sum = 0.0;
    for (const Tree& tree : forest.trees)
      sum += tree.attributes[place];
    return sum;
  };
  double mesh_volume = 0.0;
  for (const SceneObject& object : scene.scene().objects) {
    if (object.label == SceneLabel::trunk || object.label == SceneLabel::branch)
      mesh_volume += enclosed_volume(object.mesh);
  }
  double cylinders = 0.0;
  for (const Tree& tree : forest.trees) {
    for (const TreeSegment& segment : tree.segments) {
      if (segment.parent == TreeSegment::kNoParent) continue;
      const double length = (segment.position - tree.segments[segment.parent].position).norm();
      cylinders += 3.141592653589793 * segment.radius * segment.radius * length;
    }
  }
  scene.fact("tree_count", static_cast<double>(forest.trees.size()), "");
  scene.fact("leaf_area", sum_of("leaf_area"), "m2");
  scene.fact("wood_volume", sum_of("wood_volume"), "m3");
  scene.fact("wood_volume_of_mesh", mesh_volume, "m3");
  scene.fact("wood_volume_as_cylinders", cylinders, "m3");
}

void walk_outdoors(SceneBuilder& scene, const Ground& ground, const Area& area, const WalkOptions& options,
                   const std::vector<Eigen::Vector2d>& goals, const Walk& walk) {
  constexpr double kTripod = 1.7;
  WalkMap map(
      area, [&](double x, double y) { return ground.find(x, y); }, options);
  for (const SceneObject& object : scene.scene().objects) {
    if (object.label != SceneLabel::ground && object.label != SceneLabel::grass &&
        object.label != SceneLabel::crop)
      map.add_obstacle(object.mesh);
  }
  const std::vector<Eigen::Vector3d> way = map.route(goals);
  if (way.size() < 2) throw Error(ErrorCode::wrong_content, "the scene has no ground that can be walked on");
  scene.scene().path = walked(way, walk);
  scene.scene().stations = stations_along(way, 6, kTripod);
  scene.fact("path_length", length_of(scene.scene().path), "m");
}

std::vector<Eigen::Vector2d> meander(const Area& area, int rows, int columns, double jitter,
                                     const RandomStream& random) {
  std::vector<Eigen::Vector2d> goals;
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < columns; ++i) {
      const int column = row % 2 == 0 ? i : columns - 1 - i;
      const auto key = static_cast<std::uint64_t>(row * columns + column);
      const double x = area.low.x() + area.size().x() * column / (columns - 1);
      const double y = area.low.y() + area.size().y() * (row + 0.5) / rows;
      goals.emplace_back(x + between(-jitter, jitter, random, key, 0),
                         y + between(-jitter, jitter, random, key, 1));
    }
  }
  return goals;
}

}  // namespace ray
