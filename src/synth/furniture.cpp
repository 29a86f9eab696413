#include "furniture.h"

#include "turn.h"

namespace ray {
namespace {

// A box by its middle on the floor plan, its size there, and its heights.
void block(MeshBuilder& builder, double x, double y, double width, double depth, double bottom, double top) {
  builder.box({x - width / 2, y - depth / 2, bottom}, {x + width / 2, y + depth / 2, top});
}

void four_legs(MeshBuilder& builder, double width, double depth, double leg, double height) {
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0})
      block(builder, x * (width - leg) / 2, y * (depth - leg) / 2, leg, leg, 0, height);
  }
}

}  // namespace

Mesh table(double width, double depth) {
  MeshBuilder builder;
  block(builder, 0, 0, width, depth, 0.71, 0.75);
  four_legs(builder, width - 0.06, depth - 0.06, 0.07, 0.71);
  return builder.take();
}

Mesh chair() {
  MeshBuilder builder;
  block(builder, 0, 0, 0.44, 0.44, 0.42, 0.46);
  four_legs(builder, 0.42, 0.42, 0.04, 0.42);
  for (const double x : {-0.19, 0.19})
    block(builder, x, 0.2, 0.04, 0.04, 0.46, 0.92);
  block(builder, 0, 0.2, 0.34, 0.025, 0.72, 0.9);
  block(builder, 0, 0.2, 0.34, 0.025, 0.55, 0.62);
  return builder.take();
}

Mesh sofa(double width) {
  MeshBuilder builder;
  block(builder, 0, 0, width, 0.85, 0.08, 0.3);
  block(builder, 0, 0.345, width, 0.16, 0.3, 0.82);
  for (const double side : {-1.0, 1.0}) {
    block(builder, side * (width / 2 - 0.1), -0.08, 0.2, 0.69, 0.3, 0.6);
    block(builder, side * (width / 4 - 0.05), -0.09, width / 2 - 0.12, 0.67, 0.3, 0.44);  // cushions
  }
  four_legs(builder, width - 0.1, 0.75, 0.05, 0.08);
  return builder.take();
}

Mesh shelf(double width, double height, int boards) {
  constexpr double kDepth = 0.32;
  constexpr double kBoard = 0.025;
  MeshBuilder builder;
  for (const double side : {-1.0, 1.0})
    block(builder, side * (width - kBoard) / 2, 0, kBoard, kDepth, 0, height);
  block(builder, 0, kDepth / 2 - 0.005, width - 2 * kBoard, 0.01, 0, height);
  const double inside = width - 2 * kBoard;
  for (int i = 0; i < boards; ++i) {
    const double bottom = 0.06 + (height - 0.06 - kBoard) * i / (boards - 1);
    block(builder, 0, -0.005, inside, kDepth - 0.01, bottom, bottom + kBoard);
    if (i + 1 == boards) break;
    const int books = 5 + (i * 7) % 4;
    for (int book = 0; book < books; ++book) {
      const double book_height = 0.2 + 0.03 * ((book * 5 + i) % 4);
      block(builder, -inside / 2 + 0.03 + 0.06 * book, 0.02, 0.045, 0.2, bottom + kBoard,
            bottom + kBoard + book_height);
    }
  }
  return builder.take();
}

Mesh wardrobe(double width) {
  MeshBuilder builder;
  block(builder, 0, 0.02, width, 0.56, 0.05, 2.0);
  for (const double side : {-1.0, 1.0}) {
    block(builder, side * width / 4, -0.27, width / 2 - 0.01, 0.02, 0.07, 1.98);
    block(builder, side * 0.06, -0.3, 0.02, 0.04, 0.95, 1.1);
  }
  block(builder, 0, 0.02, width - 0.06, 0.5, 0, 0.05);
  return builder.take();
}

Mesh bed() {
  MeshBuilder builder;
  block(builder, 0, 0, 1.5, 2.0, 0.15, 0.3);
  block(builder, 0, 0, 1.42, 1.92, 0.3, 0.5);
  block(builder, 0, 1.02, 1.5, 0.05, 0, 0.95);
  for (const double side : {-0.36, 0.36})
    block(builder, side, 0.7, 0.6, 0.4, 0.5, 0.6);
  four_legs(builder, 1.4, 1.9, 0.08, 0.15);
  return builder.take();
}

Mesh desk() {
  MeshBuilder builder;
  block(builder, 0, 0, 1.4, 0.7, 0.71, 0.74);
  block(builder, -0.66, 0, 0.04, 0.66, 0, 0.71);
  block(builder, 0.45, 0, 0.42, 0.6, 0, 0.71);
  block(builder, 0, 0.2, 0.55, 0.03, 0.85, 1.2);  // screen
  block(builder, 0, 0.23, 0.06, 0.03, 0.74, 0.9);
  block(builder, 0, 0.22, 0.25, 0.16, 0.74, 0.75);
  return builder.take();
}

Mesh floor_lamp() {
  MeshBuilder builder;
  builder.tube({0, 0, 0}, 0.15, {0, 0, 0.03}, 0.15, 20);
  builder.tube({0, 0, 0.03}, 0.015, {0, 0, 1.4}, 0.015, 8);
  builder.tube({0, 0, 1.4}, 0.22, {0, 0, 1.7}, 0.14, 20);
  return builder.take();
}

Mesh ceiling_lamp(double cord) {
  MeshBuilder builder;
  builder.tube({0, 0, -cord}, 0.01, {0, 0, 0}, 0.01, 6);
  builder.tube({0, 0, -cord - 0.25}, 0.25, {0, 0, -cord}, 0.08, 20);
  return builder.take();
}

Mesh boxes() {
  MeshBuilder builder;
  block(builder, 0, 0, 0.6, 0.45, 0, 0.4);
  builder.set_pose(placed({0.03, -0.02, 0.4}, 0.06));
  block(builder, 0, 0, 0.5, 0.4, 0, 0.35);
  return builder.take();
}

Mesh pot_plant() {
  constexpr int kLeaves = 40;
  MeshBuilder builder;
  builder.tube({0, 0, 0}, 0.12, {0, 0, 0.3}, 0.17, 16);
  builder.tube({0, 0, 0.3}, 0.02, {0, 0, 0.8}, 0.012, 6);
  for (int i = 0; i < kLeaves; ++i) {
    const Eigen::Vector2d out = turned(0.381966 * i);  // the golden angle
    const double rise = 0.2 + 0.5 * i / kLeaves;
    const Eigen::Vector3d stem(0.02 * out.x(), 0.02 * out.y(), 0.45 + 0.35 * i / kLeaves);
    const Eigen::Vector3d along = Eigen::Vector3d(out.x(), out.y(), rise).normalized();
    const Eigen::Vector3d flat(-out.y(), out.x(), 0);
    builder.leaf(stem, stem + 0.3 * along, flat, along.cross(flat), 0.012, 0.3);
  }
  return builder.take();
}

Mesh moved(const Mesh& mesh, const Pose& pose) {
  Mesh result = mesh;
  for (Eigen::Vector3d& vertex : result.vertices)
    vertex = pose * vertex;
  return result;
}

}  // namespace ray
