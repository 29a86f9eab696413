#include "scene_geometry.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/random.h>
#include <raycloud/synth/scenes.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace ray {
namespace {

using test::area_of;
using test::fact;
using test::volume_of;

const SceneObject& object_named(const Scene& scene, const std::string& name) {
  for (const SceneObject& object : scene.objects) {
    if (object.name == name) return object;
  }
  throw std::runtime_error("no object " + name);
}

double attribute(const Scene& scene, std::size_t tree, const std::string& name) {
  const auto& names = scene.forest.tree_attributes;
  const auto place = std::find(names.begin(), names.end(), name) - names.begin();
  return scene.forest.trees[tree].attributes.at(static_cast<std::size_t>(place));
}

void expect_trees_as_stated(const Scene& scene) {
  double leaf_area = 0.0;
  double wood = 0.0;
  double stated_leaf_area = 0.0;
  double stated_wood = 0.0;
  for (const SceneObject& object : scene.objects) {
    if (object.label == SceneLabel::leaf) leaf_area += area_of(object.mesh);
    if (object.label == SceneLabel::trunk || object.label == SceneLabel::branch)
      wood += volume_of(object.mesh);
  }
  for (std::size_t i = 0; i < scene.forest.trees.size(); ++i) {
    stated_leaf_area += attribute(scene, i, "leaf_area");
    stated_wood += wood_volume(scene.forest.trees[i]);
    EXPECT_DOUBLE_EQ(attribute(scene, i, "wood_volume"), wood_volume(scene.forest.trees[i]));
  }
  EXPECT_NEAR(leaf_area, stated_leaf_area, 1e-6 * (1 + stated_leaf_area));
  EXPECT_NEAR(leaf_area, fact(scene, "leaf_area"), 1e-6 * (1 + leaf_area));
  EXPECT_NEAR(wood, stated_wood, 1e-6 * stated_wood);
  EXPECT_NEAR(wood, fact(scene, "wood_volume"), 1e-6 * wood);
  EXPECT_NEAR(wood, fact(scene, "wood_volume_of_mesh"), 1e-6 * wood);
  EXPECT_EQ(static_cast<double>(scene.forest.trees.size()), fact(scene, "tree_count"));
}

// At every fork the cross-sections add up.
void expect_pipes(const Tree& tree) {
  std::vector<double> carried(tree.segments.size(), 0.0);
  for (std::size_t i = 1; i < tree.segments.size(); ++i) {
    ASSERT_LT(tree.segments[i].parent, i);
    carried[tree.segments[i].parent] += tree.segments[i].radius * tree.segments[i].radius;
  }
  for (std::size_t i = 0; i < tree.segments.size(); ++i) {
    const double own = tree.segments[i].radius * tree.segments[i].radius;
    if (carried[i] > 0) {
      ASSERT_NEAR(carried[i], own, 1e-9 * own) << i;
    }
  }
}

TEST(scene_truth, wood_and_leaves_of_the_tree_are_as_stated) {
  const Scene scene = make_scene(SceneKind::tree, 3);
  expect_trees_as_stated(scene);
  const Tree& tree = scene.forest.trees.at(0);
  expect_pipes(tree);
  EXPECT_EQ(tree.segments[0].radius, fact(scene, "foot_radius"));
  EXPECT_GT(fact(scene, "leaf_area"), 20.0);
  // Orders of branching: the most side branches on the way from an end to the foot.
  const std::vector<std::size_t> next = continuations(tree);
  std::vector<int> order(tree.segments.size(), 0);
  for (std::size_t i = 1; i < order.size(); ++i) {
    const std::size_t parent = tree.segments[i].parent;
    order[i] = order[parent] + (next[parent] == i ? 0 : 1);
  }
  EXPECT_GE(*std::max_element(order.begin(), order.end()), 4);
}

TEST(scene_truth, wood_and_leaves_of_the_forest_are_as_stated) {
  const Scene scene = make_scene(SceneKind::forest, 3);
  expect_trees_as_stated(scene);
  EXPECT_GE(scene.forest.trees.size(), 40u);
  EXPECT_LE(scene.forest.trees.size(), 80u);
  double nearest = 1e9;
  std::vector<double> heights;
  for (std::size_t i = 0; i < scene.forest.trees.size(); ++i) {
    expect_pipes(scene.forest.trees[i]);
    heights.push_back(attribute(scene, i, "height"));
    const Eigen::Vector3d& foot = scene.forest.trees[i].segments[0].position;
    for (std::size_t j = 0; j < i; ++j)
      nearest = std::min(nearest, (foot - scene.forest.trees[j].segments[0].position).head<2>().norm());
    const double above = foot.z() - test::height_at(scene.ground, foot.x(), foot.y()).value();
    EXPECT_LT(above, 0.0) << "a tree hangs in the air";
    EXPECT_GT(above, -0.5);
  }
  EXPECT_GE(nearest, 4.0);
  EXPECT_GT(*std::max_element(heights.begin(), heights.end()),
            1.8 * *std::min_element(heights.begin(), heights.end()));
}

// A trunk of a cylinder and a cone's frustum, and a side branch: by hand.
TEST(scene_truth, wood_volume_of_a_small_tree_by_hand) {
  Tree tree;
  tree.segments = {{.position = {0, 0, 0}, .radius = 0.2},
                   {.position = {0, 0, 3}, .radius = 0.2, .parent = 0},
                   {.position = {1, 0, 3}, .radius = 0.05, .parent = 1},
                   {.position = {0, 0, 5}, .radius = 0.1, .parent = 1}};
  const double pi = 3.14159265358979;
  const double cylinder = pi * 0.04 * 3;
  const double branch = pi * 0.0025 * 1;
  const double frustum = pi / 3 * 2 * (0.04 + 0.02 + 0.01);
  EXPECT_NEAR(wood_volume(tree), cylinder + branch + frustum, 1e-12);
  EXPECT_THAT(continuations(tree),
              testing::ElementsAre(1, 3, TreeSegment::kNoParent, TreeSegment::kNoParent));
}

// Where leaves face every way alike, a line meets half of the leaf area density a metre (Warren Wilson 1960).
TEST(scene_truth, random_lines_meet_half_the_density_of_the_crop) {
  const Scene scene = make_scene(SceneKind::field, 5);
  const double density = fact(scene, "leaf_area_density");
  const RandomStream random(9, "lines");
  double crossings = 0.0;
  double length = 0.0;
  for (const std::string name : {"row 4", "row 11"}) {
    const Mesh& row = object_named(scene, name).mesh;
    Eigen::Vector3d low = row.vertices[0];
    Eigen::Vector3d high = low;
    for (const Eigen::Vector3d& vertex : row.vertices) {
      low = low.cwiseMin(vertex);
      high = high.cwiseMax(vertex);
    }
    // Well inside, where triangles are cut by neither the sides nor the waves of the ground.
    low += Eigen::Vector3d(0.5, 0.06, 0.25);
    high -= Eigen::Vector3d(0.5, 0.06, 0.25);
    for (std::uint64_t line = 0; line < 600; ++line) {
      const auto place = [&](std::uint64_t draw) {
        const Eigen::Vector3d box(random.uniform(line, draw), random.uniform(line, draw + 1),
                                  random.uniform(line, draw + 2));
        return (low + box.cwiseProduct(high - low)).eval();
      };
      const Eigen::Vector3d from = place(0);
      const Eigen::Vector3d to = place(3);
      length += (to - from).norm();
      for (const Mesh::Face& face : row.faces)
        crossings += test::crosses(from, to, test::triangle(row, face)) ? 1 : 0;
    }
  }
  EXPECT_NEAR(2 * crossings / length, density, 0.02 * density);
}

TEST(scene_truth, the_leaf_area_of_the_crop_is_its_density_times_its_volume) {
  const Scene scene = make_scene(SceneKind::field, 5);
  double area = 0.0;
  for (const SceneObject& object : scene.objects) {
    if (object.label == SceneLabel::crop) area += area_of(object.mesh);
  }
  EXPECT_NEAR(area, fact(scene, "leaf_area"), 1e-6 * area);
  const double volume = fact(scene, "row_count") * fact(scene, "row_length") * fact(scene, "row_width") *
                        (fact(scene, "crop_top") - fact(scene, "crop_bottom"));
  EXPECT_NEAR(area / volume, fact(scene, "leaf_area_density"), 1e-6 * area / volume);
}

double share_that_passes(const Mesh& mesh, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const RandomStream random(3, "fence");
  constexpr std::uint64_t kRays = 3000;
  int passed = 0;
  for (std::uint64_t i = 0; i < kRays; ++i) {
    const Eigen::Vector3d from(low.x() + random.uniform(i, 0) * (high.x() - low.x()), low.y(),
                               low.z() + random.uniform(i, 1) * (high.z() - low.z()));
    const Eigen::Vector3d to(from.x(), high.y(), from.z());
    const bool is_hit = std::any_of(mesh.faces.begin(), mesh.faces.end(), [&](const Mesh::Face& face) {
      return test::crosses(from, to, test::triangle(mesh, face));
    });
    passed += is_hit ? 0 : 1;
  }
  return static_cast<double>(passed) / kRays;
}

TEST(scene_truth, the_fences_are_as_open_as_stated) {
  const Scene scene = make_scene(SceneKind::field, 5);
  EXPECT_NEAR(share_that_passes(object_named(scene, "wire fence").mesh, {-12, 10.5, 0.16}, {12, 11.5, 1.3}),
              fact(scene, "wire_fence_openness"), 0.02);
  EXPECT_NEAR(share_that_passes(object_named(scene, "slats").mesh, {-12, -11.5, 0.2}, {12, -10.5, 1.2}),
              fact(scene, "slat_fence_openness"), 0.03);
}

Tree stick(const Eigen::Vector3d& foot, double radius, double height) {
  Tree tree;
  tree.segments = {
      {.position = foot, .radius = radius},
      {.position = foot + height / 2 * Eigen::Vector3d::UnitZ(), .radius = radius, .parent = 0},
      {.position = foot + height * Eigen::Vector3d(0.1, 0, 1), .radius = radius / 2, .parent = 1},
      {.position = foot + height * Eigen::Vector3d(0.2, 0.3, 0.8), .radius = radius / 3, .parent = 1}};
  return tree;
}

RC_GTEST_PROP(scene_truth, any_given_forest_keeps_its_wood_gets_its_leaf_area_and_stands_on_its_ground, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(1, 7);
  const auto seed = *rc::gen::inRange<std::uint64_t>(1, 1000);
  const bool has_leaf_area = *rc::gen::arbitrary<bool>();
  const RandomStream random(seed, "given");
  Forest given;
  given.tree_attributes = {"species"};
  if (has_leaf_area) given.tree_attributes.emplace_back("leaf_area");
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d foot(5e5 + 6.0 * static_cast<double>(i), 7e6 + 10 * random.uniform(i, 0),
                               80 + 3 * random.uniform(i, 1));
    Tree tree = stick(foot, 0.05 + 0.2 * random.uniform(i, 2), 4 + 10 * random.uniform(i, 3));
    tree.attributes = {static_cast<double>(i)};
    if (has_leaf_area) tree.attributes.push_back(50 * random.uniform(i, 4));
    given.trees.push_back(tree);
  }
  const Scene scene = forest_scene(given, seed);
  expect_trees_as_stated(scene);
  RC_ASSERT(!testing::Test::HasFailure());
  RC_ASSERT(scene.forest.trees.size() == count);
  for (std::size_t i = 0; i < count; ++i) {
    const Tree& tree = scene.forest.trees[i];
    RC_ASSERT(tree.attributes[0] == static_cast<double>(i));
    if (has_leaf_area) {
      RC_ASSERT(std::abs(attribute(scene, i, "leaf_area") - given.trees[i].attributes[1]) < 1e-9);
    }
    for (std::size_t j = 0; j < tree.segments.size(); ++j) {
      RC_ASSERT(tree.segments[j].position == given.trees[i].segments[j].position);
      RC_ASSERT(tree.segments[j].radius == given.trees[i].segments[j].radius);
    }
    const Eigen::Vector3d& foot = tree.segments[0].position;
    const double ground = test::height_at(scene.ground, foot.x(), foot.y()).value();
    RC_ASSERT(std::abs(ground - foot.z()) < 0.1);
  }
}

TEST(scene_truth, a_tree_of_which_only_the_place_is_known_is_grown_to_its_height) {
  Forest given;
  given.tree_attributes = {"height"};
  given.trees.resize(2);
  given.trees[0] = {.attributes = {11.5}, .segments = {{.position = {3, 4, 100}, .radius = 0.15}}};
  given.trees[1] = {.attributes = {-1}, .segments = {{.position = {12, 4, 101}, .radius = 0.1}}};
  const Scene scene = forest_scene(given, 1);
  expect_trees_as_stated(scene);
  EXPECT_NEAR(attribute(scene, 0, "height"), 11.5, 1e-9);
  EXPECT_GT(attribute(scene, 1, "height"), 3.0);
  EXPECT_EQ(scene.forest.trees[0].segments[0].radius, 0.15);
  EXPECT_EQ(scene.forest.trees[0].segments[0].position, Eigen::Vector3d(3, 4, 100));
  EXPECT_GT(scene.forest.trees[0].segments.size(), 100u);
}

template <class Body>
ErrorCode code_of(const Body& body) {
  try {
    body();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::usage;
}

TEST(scene_truth, trees_that_cannot_be_are_refused) {
  EXPECT_EQ(code_of([] { (void)forest_scene({}, 1); }), ErrorCode::no_data);
  Forest good;
  good.trees = {stick({0, 0, 0}, 0.1, 5)};
  EXPECT_NO_THROW((void)forest_scene(good, 1));
  const auto refused = [&](const auto& spoil) {
    Forest bad = good;
    spoil(bad.trees[0]);
    return code_of([&] { (void)forest_scene(bad, 1); }) == ErrorCode::wrong_content;
  };
  EXPECT_TRUE(refused([](Tree& tree) { tree.segments.clear(); }));
  EXPECT_TRUE(refused([](Tree& tree) { tree.segments[2].radius = 0.0; }));
  EXPECT_TRUE(refused([](Tree& tree) { tree.segments[2].radius = -0.1; }));
  EXPECT_TRUE(refused([](Tree& tree) { tree.segments[1].radius = std::nan(""); }));
  EXPECT_TRUE(refused([](Tree& tree) { tree.segments[3].position.x() = std::nan(""); }));
  EXPECT_TRUE(refused([](Tree& tree) { tree.segments[2].parent = 2; }));
  EXPECT_TRUE(refused([](Tree& tree) { tree.segments[2].parent = 17; }));
}

Mesh tilted_square(double side, double rise) {
  return {.vertices = {{0, 0, 0}, {side, 0, rise}, {side, side, rise}, {0, side, 0}},
          .faces = {{0, 1, 2}, {0, 2, 3}},
          .face_columns = {}};
}

TEST(scene_truth, a_given_ground_is_walked_over_at_head_height) {
  const Mesh mesh = tilted_square(80, 16);
  const Scene scene = terrain_scene(mesh);
  EXPECT_EQ(scene.ground.vertices, mesh.vertices);
  EXPECT_EQ(scene.ground.faces, mesh.faces);
  ASSERT_GT(scene.path.size(), 100u);
  for (const Eigen::Vector3d& place : scene.path.positions)
    ASSERT_NEAR(place.z() - 0.2 * place.x(), 1.5, 1e-9);
  EXPECT_NEAR(fact(scene, "ground_area"), 80 * std::sqrt(80.0 * 80 + 16 * 16), 1e-6);
  EXPECT_DOUBLE_EQ(fact(scene, "relief"), 16);
}

TEST(scene_truth, ground_that_cannot_be_walked_is_refused) {
  EXPECT_EQ(code_of([] { (void)terrain_scene({}); }), ErrorCode::no_data);
  EXPECT_EQ(code_of([] { (void)terrain_scene(tilted_square(10, 30)); }), ErrorCode::wrong_content);
  const Mesh upright{.vertices = {{0, 0, 0}, {5, 0, 0}, {5, 0, 4}}, .faces = {{0, 1, 2}}, .face_columns = {}};
  EXPECT_EQ(code_of([&] { (void)terrain_scene(upright); }), ErrorCode::wrong_content);
  Mesh hole = tilted_square(10, 0);
  hole.vertices[1].z() = std::nan("");
  EXPECT_EQ(code_of([&] { (void)terrain_scene(hole); }), ErrorCode::wrong_content);
}

}  // namespace
}  // namespace ray
