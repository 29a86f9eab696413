/// A crop in rows, between fences and a hedge.

#include "outdoors.h"
#include "scene_kinds.h"
#include "turn.h"

#include <array>
#include <cmath>

namespace ray {
namespace {

constexpr int kRows = 16;
constexpr double kRowSpacing = 1.0;  // m
constexpr double kRowWidth = 0.5;    // m
constexpr double kRowLength = 24.0;  // m
constexpr double kBottom = 0.05;     // m above the ground
constexpr double kTop = 0.85;        // m above the ground

// Triangles that face anywhere, their middles anywhere in a box over the ground.
struct LeafCloud {
  Eigen::Vector3d low;  // z above the ground
  Eigen::Vector3d high;
  double density;  // m2 of leaf (one side) in a m3
  double blade;    // m, the side of an equilateral triangle

  double volume() const { return (high - low).prod(); }
  double blade_area() const { return std::sqrt(3.0) / 4 * blade * blade; }
  std::uint64_t blades() const {
    return static_cast<std::uint64_t>(std::floor(density * volume() / blade_area() + 0.5));
  }
};

Mesh blades_of(const LeafCloud& cloud, const Ground& ground, const RandomStream& random) {
  MeshBuilder builder;
  const double out = cloud.blade / std::sqrt(3.0);  // from the middle to a corner
  for (std::uint64_t i = 0; i < cloud.blades(); ++i) {
    const Eigen::Vector3d box(random.uniform(i, 0), random.uniform(i, 1), random.uniform(i, 2));
    Eigen::Vector3d middle = cloud.low + box.cwiseProduct(cloud.high - cloud.low);
    middle.z() += ground.at(middle.x(), middle.y());
    const AcrossAxes axes = across(random_direction(random, i, 3));
    const Eigen::Vector2d spin = turned(random.uniform(i, 5));
    const Eigen::Vector3d along = out * (spin.x() * axes.first + spin.y() * axes.second);
    const Eigen::Vector3d side = out * std::sqrt(3.0) / 2 * (spin.x() * axes.second - spin.y() * axes.first);
    builder.triangle(middle + along, middle - along / 2 + side, middle - along / 2 - side);
  }
  return builder.take();
}

void plant_rows(SceneBuilder& scene, const Ground& ground) {
  const double density = between(2.0, 4.0, scene.random("density"), 0);
  double leaf_area = 0.0;
  double volume = 0.0;
  for (int row = 0; row < kRows; ++row) {
    const double y = (row - (kRows - 1) / 2.0) * kRowSpacing;
    const LeafCloud cloud{{-kRowLength / 2, y - kRowWidth / 2, kBottom},
                          {kRowLength / 2, y + kRowWidth / 2, kTop},
                          density,
                          0.04};
    Mesh mesh = blades_of(cloud, ground, scene.random("row " + std::to_string(row)));
    leaf_area += static_cast<double>(cloud.blades()) * cloud.blade_area();
    volume += cloud.volume();
    scene.add(SceneLabel::crop, "row " + std::to_string(row + 1), std::move(mesh));
  }
  scene.fact("leaf_area_density", leaf_area / volume, "m2/m3");
  scene.fact("leaf_area", leaf_area, "m2");
  scene.fact("crop_volume", volume, "m3");
  scene.fact("row_count", kRows, "");
  scene.fact("row_spacing", kRowSpacing, "m");
  scene.fact("row_width", kRowWidth, "m");
  scene.fact("row_length", kRowLength, "m");
  scene.fact("crop_bottom", kBottom, "m");
  scene.fact("crop_top", kTop, "m");
}

void plant_hedge(SceneBuilder& scene, const Ground& ground) {
  const LeafCloud cloud{{14.5, -8, 0.1}, {15.3, 8, 1.6}, 6.0, 0.05};
  scene.add(SceneLabel::hedge, "hedge leaves", blades_of(cloud, ground, scene.random("hedge")));
  MeshBuilder stems;
  for (int i = 0; i < 32; ++i) {
    const double y = -7.75 + 0.5 * i;
    const double z = ground.at(14.9, y);
    stems.tube({14.9, y, z - 0.1}, 0.025, {14.9 + 0.1 * (i % 3 - 1), y, z + 1.3}, 0.01, 6);
  }
  scene.add(SceneLabel::hedge, "hedge stems", stems.take());
  scene.fact("hedge_leaf_area_density",
             static_cast<double>(cloud.blades()) * cloud.blade_area() / cloud.volume(), "m2/m3");
}

void posts(MeshBuilder& builder, const Ground& ground, double y, double height) {
  for (int i = 0; i <= 8; ++i) {
    const double x = -13 + 26 * i / 8.0;
    const double z = ground.at(x, y);
    builder.box({x - 0.04, y + 0.02, z - 0.2}, {x + 0.04, y + 0.1, z + height});
  }
}

// Wires before posts. Seen at a right angle, the openness is what the wires leave.
void build_wire_fence(SceneBuilder& scene, const Ground& ground) {
  constexpr double kWire = 0.004;
  constexpr double kMesh = 0.06;
  constexpr double kHigh = 1.26;
  constexpr double kY = 11.0;
  MeshBuilder wires;
  MeshBuilder wood;
  const auto columns = static_cast<int>(26 / kMesh);
  for (int i = 0; i <= columns; ++i) {
    const double x = -13 + kMesh * i;
    wires.box({x - kWire / 2, kY - kWire, 0.1}, {x + kWire / 2, kY, 0.1 + kHigh});
  }
  for (int i = 0; i <= 21; ++i) {
    const double z = 0.1 + kMesh * i;
    wires.box({-13, kY, z - kWire / 2}, {-13 + kMesh * columns, kY + kWire, z + kWire / 2});
  }
  posts(wood, ground, kY, 1.5);
  scene.add(SceneLabel::fence, "wire fence", wires.take());
  scene.add(SceneLabel::fence, "posts of the wire fence", wood.take());
  const double open = 1 - kWire / kMesh;
  scene.fact("wire_fence_openness", open * open, "");
  scene.fact("wire_width", kWire, "m");
}

void build_slat_fence(SceneBuilder& scene, const Ground& ground) {
  constexpr double kSlat = 0.08;
  constexpr double kPitch = 0.12;
  constexpr double kY = -11.0;
  MeshBuilder slats;
  MeshBuilder wood;
  for (int i = 0; i < 216; ++i) {
    const double x = -12.95 + kPitch * i;
    slats.box({x, kY - 0.02, 0.12}, {x + kSlat, kY, 1.3});
  }
  for (const double z : {0.4, 1.0})
    wood.box({-13, kY, z}, {13, kY + 0.02, z + 0.07});
  posts(wood, ground, kY, 1.3);
  scene.add(SceneLabel::fence, "slats", slats.take());
  scene.add(SceneLabel::fence, "rails and posts of the slats", wood.take());
  scene.fact("slat_fence_openness", 1 - kSlat / kPitch, "");
}

}  // namespace

Scene make_field(std::uint64_t seed) {
  SceneBuilder scene("field", seed);
  const RandomStream bumps = scene.random("ground");
  const Mesh field = height_field({{-28, -24}, {28, 24}}, 0.25, [&](double x, double y) {
    return fractal(bumps, x, y, {.wavelength = 10, .height = 0.12, .octaves = 6});
  });
  scene.scene().ground = field;
  scene.add(SceneLabel::ground, "ground", field);
  const Ground ground(field);
  plant_rows(scene, ground);
  plant_hedge(scene, ground);
  build_wire_fence(scene, ground);
  build_slat_fence(scene, ground);
  std::vector<Eigen::Vector2d> goals;
  const std::array<double, 5> kLanes{-9.6, -4.0, 0.0, 4.0, 9.6};
  for (std::size_t i = 0; i < kLanes.size(); ++i) {
    const double x = i % 2 == 0 ? 13.0 : -13.0;
    goals.insert(goals.end(), {{-x, kLanes[i]}, {x, kLanes[i]}});
  }
  walk_outdoors(scene, ground, {{-20, -16}, {20, 16}}, {.cell = 0.2, .clearance = 0.6, .comfort = 1.0}, goals,
                {.head = 2.0, .speed = 1.0});
  return scene.take();
}

}  // namespace ray
