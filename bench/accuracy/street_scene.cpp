#include "street_scene.h"

#include <raycloud/exec/random.h>
#include <raycloud/synth/movers.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace bench {
namespace {

using Eigen::Vector3d;

/// Adds corners by twos and threes.
class Shapes {
 public:
  void triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.insert(mesh_.vertices.end(), {a, b, c});
    mesh_.faces.push_back({first, first + 1, first + 2});
  }
  void quad(const Vector3d& corner, const Vector3d& u, const Vector3d& v) {
    triangle(corner, corner + u, corner + u + v);
    triangle(corner, corner + u + v, corner + v);
  }
  void box(const Vector3d& low, const Vector3d& high) {
    const Vector3d size = high - low;
    const Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
    quad(low, y, x);
    quad(low + z, x, y);
    quad(low, x, z);
    quad(low + y, z, x);
    quad(low, z, y);
    quad(low + x, y, z);
  }
  /// Upright, of twelve sides.
  void pole(double x, double y, double radius, double height) {
    constexpr int kSides = 12;
    const auto corner = [&](int i) {
      const double angle = 2.0 * std::numbers::pi * i / kSides;
      return Vector3d(x + radius * std::cos(angle), y + radius * std::sin(angle), 0.0);
    };
    for (int i = 0; i < kSides; ++i)
      quad(corner(i), corner(i + 1) - corner(i), Vector3d(0, 0, height));
  }
  /// Triangles anywhere in a box, or in the ball within it, that face anywhere: `density` m² in a m³.
  void leaves(const Vector3d& low, const Vector3d& high, double density, bool ball,
              const ray::RandomStream& random, double side = 0.04) {
    const double area = std::sqrt(3.0) / 4.0 * side * side;
    const Vector3d size = high - low;
    const auto count = static_cast<std::uint64_t>(density * size.prod() / area);
    for (std::uint64_t i = 0; i < count; ++i) {
      const Vector3d place(random.uniform(i, 0), random.uniform(i, 1), random.uniform(i, 2));
      if (ball && (place - Vector3d::Constant(0.5)).norm() > 0.5) continue;
      const double z = 2.0 * random.uniform(i, 3) - 1.0, turn = 2.0 * std::numbers::pi * random.uniform(i, 4);
      const double across = std::sqrt(1.0 - z * z);
      const Vector3d normal(across * std::cos(turn), across * std::sin(turn), z);
      const Vector3d u = normal.unitOrthogonal();
      const Eigen::AngleAxisd spin(2.0 * std::numbers::pi * random.uniform(i, 5), normal);
      const Eigen::AngleAxisd third(2.0 * std::numbers::pi / 3.0, normal);
      const Vector3d a = spin * (side / std::sqrt(3.0) * u), b = third * a, c = third * b;
      const Vector3d middle = low + place.cwiseProduct(size);
      triangle(middle + a, middle + b, middle + c);
    }
  }
  ray::Mesh take() { return std::exchange(mesh_, {}); }

 private:
  ray::Mesh mesh_;
};

/// A box with a cabin on top.
ray::Mesh parked_car(double x, double y) {
  Shapes car;
  car.box({x - 2.1, y - 0.9, 0.25}, {x + 2.1, y + 0.9, 0.85});
  car.box({x - 1.4, y - 0.75, 0.85}, {x + 0.8, y + 0.75, 1.45});
  for (const double wheel : {-1.35, 1.35})
    car.box({x + wheel - 0.3, y - 0.85, 0.0}, {x + wheel + 0.3, y + 0.85, 0.3});
  return car.take();
}

class Street {
 public:
  explicit Street(std::uint64_t seed) {
    scene_.kind = "street";
    scene_.seed = seed;
  }

  ray::SceneObject& add(ray::SceneLabel label, const std::string& name, ray::Mesh mesh) {
    ray::SceneObject object;
    object.id = static_cast<std::int32_t>(scene_.objects.size());
    object.label = label;
    object.name = name;
    object.mesh = std::move(mesh);
    scene_.objects.push_back(std::move(object));
    return scene_.objects.back();
  }

  void ground() {
    Shapes shapes;
    constexpr double kKerb = 0.12;
    shapes.quad({-25, -4, 0}, {50, 0, 0}, {0, 8, 0});
    for (const double side : {-1.0, 1.0}) {
      shapes.quad({-25, 4 * side, 0}, {50, 0, 0}, {0, 0.02 * side, kKerb});
      shapes.quad({-25, 4.02 * side, kKerb}, {50, 0, 0}, {0, 6 * side, 0});
    }
    add(ray::SceneLabel::ground, "ground", shapes.take());
  }

  void houses() {
    Shapes shapes;
    for (const double side : {-1.0, 1.0}) {
      const auto part = [&](double x, double width, double front, double low, double high) {
        const double a = side * front, b = side * 10.0;
        shapes.box({x, std::min(a, b), low}, {x + width, std::max(a, b), high});
      };
      part(-25.0, 50.0, 9.4, 0.0, 7.0);
      for (double x = -25.0; x < 24.0; x += 3.0) {
        part(x, 0.4, 9.0, 0.0, 7.0);
        part(x + 0.4, 2.6, 9.2, 0.0, 1.0);
      }
    }
    add(ray::SceneLabel::wall, "houses", shapes.take());
  }

  void greenery() {
    Shapes shapes;
    shapes.leaves({-15, 6.6, 0.2}, {-3, 7.6, 1.6}, 4.0, false, {scene_.seed, "hedge"});
    add(ray::SceneLabel::hedge, "hedge", shapes.take());
    for (const double x : {-19.0, 1.0, 12.0}) {
      shapes.pole(x, -5.2, 0.12, 3.2);
      add(ray::SceneLabel::trunk, "trunk", shapes.take());
      shapes.leaves({x - 1.6, -6.8, 2.6}, {x + 1.6, -3.6, 5.6}, 1.5, true,
                    {scene_.seed, "tree" + std::to_string(x)});
      add(ray::SceneLabel::leaf, "crown", shapes.take());
    }
  }

  void fence() {
    constexpr double kHalf = 0.0025, kMesh = 0.08, kHeight = 1.5, kY = 6.0;
    Shapes shapes;
    for (double x = 3.0; x < 17.0; x += kMesh)
      shapes.box({x - kHalf, kY - kHalf, 0.15}, {x + kHalf, kY + kHalf, kHeight});
    for (double z = 0.2; z < kHeight; z += kMesh)
      shapes.box({3.0, kY - kHalf, z - kHalf}, {17.0, kY + kHalf, z + kHalf});
    add(ray::SceneLabel::fence, "wire fence", shapes.take());
    for (double x = 3.0; x < 18.0; x += 3.5)
      shapes.pole(x, kY + 0.05, 0.03, 1.6);
    for (double x = -22.0; x < 23.0; x += 11.0)
      shapes.pole(x, 4.6, 0.06, 5.0);
    add(ray::SceneLabel::fence, "posts", shapes.take());
  }

  void cars() {
    for (const double x : {-21.0, -9.0, 8.0, 20.0})
      add(ray::SceneLabel::vehicle, "parked car", parked_car(x, -2.9));
    for (const double x : {-6.0, 13.0})
      add(ray::SceneLabel::vehicle, "parked car", parked_car(x, 2.9));
  }

  void walk() {
    constexpr double kSpeed = 1.3, kStep = 0.25, kEnd = 21.0;
    double time = 0.0;
    const auto add_node = [&](double x, double y) {
      scene_.path.times.push_back(time);
      scene_.path.positions.emplace_back(x, y, 1.6);
      time += kStep / kSpeed;
    };
    for (int lap = 0; lap < 2; ++lap) {
      for (double x = -kEnd; x < kEnd; x += kStep)
        add_node(x, -1.0);
      for (double turn = -1.5; turn < 1.5; turn += kStep)
        add_node(kEnd + std::cos(turn), std::sin(turn));
      for (double x = kEnd; x > -kEnd; x -= kStep)
        add_node(x, 1.0);
      for (double turn = 1.5; turn > -1.5; turn -= kStep)
        add_node(-kEnd - std::cos(turn), std::sin(turn));
    }
  }

  void come_and_go() {
    const double end = scene_.path.times.back();
    add(ray::SceneLabel::vehicle, "leaves", parked_car(2.0, -2.9)).present.second = 0.45 * end;
    add(ray::SceneLabel::vehicle, "arrives", parked_car(-14.0, 2.9)).present.first = 0.55 * end;
  }

  ray::Scene take() { return std::move(scene_); }

 private:
  ray::Scene scene_;
};

}  // namespace

ray::Scene street_scene(std::uint64_t seed, int movers) {
  Street street(seed);
  street.ground();
  street.houses();
  street.greenery();
  street.fence();
  street.cars();
  street.walk();
  if (movers == 0) return street.take();
  street.come_and_go();
  return ray::with_movers(street.take(), movers, seed);
}

ray::Scene hedge_scene(double density, double blade, std::uint64_t seed) {
  Street street(seed);
  Shapes shapes;
  shapes.leaves(kHedgeLow, kHedgeHigh, density, false, {seed, "hedge"}, blade);
  street.add(ray::SceneLabel::hedge, "hedge", shapes.take());
  ray::Scene scene = street.take();
  constexpr int kNodes = 200;
  for (int i = 0; i < kNodes; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kNodes;
    scene.path.times.push_back(0.2 * i);
    scene.path.positions.emplace_back(4.0 * std::cos(angle), 4.0 * std::sin(angle), 1.0);
  }
  return scene;
}

}  // namespace bench
