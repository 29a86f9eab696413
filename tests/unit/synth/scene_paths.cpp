#include "scene_geometry.h"
#include "scene_words.h"

#include <raycloud/synth/scenes.h>

#include <gtest/gtest.h>

namespace ray {
namespace {

using test::Triangle;

// Which steps of a path pass over each square metre, so that a triangle meets few of them.
class StepsByPlace {
 public:
  explicit StepsByPlace(const Trajectory& path) : path_(path) {
    for (std::size_t i = 1; i < path.size(); ++i) {
      for_cells(path.positions[i - 1], path.positions[i],
                [&](std::pair<int, int> cell) { steps_[cell].push_back(i); });
    }
  }

  std::optional<std::size_t> crossed_step(const Triangle& t) const {
    const Eigen::Vector3d low = t[0].cwiseMin(t[1]).cwiseMin(t[2]);
    const Eigen::Vector3d high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    std::optional<std::size_t> crossed;
    for_cells(low, high, [&](std::pair<int, int> cell) {
      const auto place = steps_.find(cell);
      if (place == steps_.end() || crossed) return;
      for (const std::size_t step : place->second) {
        if (test::crosses(path_.positions[step - 1], path_.positions[step], t)) crossed = step;
      }
    });
    return crossed;
  }

 private:
  template <class Body>
  static void for_cells(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Body& body) {
    const auto cell = [](double x) { return static_cast<int>(std::floor(x)); };
    for (int x = cell(std::min(a.x(), b.x())); x <= cell(std::max(a.x(), b.x())); ++x) {
      for (int y = cell(std::min(a.y(), b.y())); y <= cell(std::max(a.y(), b.y())); ++y)
        body({x, y});
    }
  }

  const Trajectory& path_;
  std::map<std::pair<int, int>, std::vector<std::size_t>> steps_;
};

void expect_clear_path(const Scene& scene) {
  const StepsByPlace steps(scene.path);
  for (const SceneObject& object : scene.objects) {
    for (const Mesh::Face& face : object.mesh.faces) {
      const auto step = steps.crossed_step(test::triangle(object.mesh, face));
      ASSERT_FALSE(step) << object.name << " is in the way at step " << *step;
    }
  }
}

void expect_clear_stations(const Scene& scene) {
  for (const Eigen::Vector3d& station : scene.stations) {
    for (const SceneObject& object : scene.objects) {
      for (const Mesh::Face& face : object.mesh.faces) {
        const Triangle t = test::triangle(object.mesh, face);
        if (std::min({t[0].z(), t[1].z(), t[2].z()}) > station.z() + 0.1) continue;
        ASSERT_GT(test::distance(station, t), 0.1) << object.name;
      }
    }
  }
}

void expect_walkable(const Scene& scene, double speed) {
  const Trajectory& path = scene.path;
  ASSERT_GT(path.size(), 100u);
  ASSERT_EQ(path.orientations.size(), path.size());
  EXPECT_EQ(path.times.front(), 0.0);
  double along = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    ASSERT_GT(path.times[i], path.times[i - 1]);
    const Eigen::Vector3d step = path.positions[i] - path.positions[i - 1];
    // A step of a terrace is climbed at once.
    ASSERT_LT(step.head<2>().norm(), 1.001 * speed * (path.times[i] - path.times[i - 1])) << i;
    ASSERT_LT(std::abs(step.z()), 0.2) << i;
    ASSERT_NEAR(path.orientations[i].norm(), 1.0, 1e-12);
    ASSERT_NEAR((path.orientations[i] * Eigen::Vector3d::UnitZ()).z(), 1.0, 1e-12) << "not upright";
    along += (path.orientations[i] * Eigen::Vector3d::UnitX()).dot(step);
  }
  EXPECT_GT(along, 0.9 * test::fact(scene, "path_length")) << "does not look where it goes";
}

class EveryPath : public testing::TestWithParam<SceneKind> {};

TEST_P(EveryPath, keeps_clear_of_every_surface_for_several_seeds) {
  const double speed = GetParam() == SceneKind::terrain ? 1.4 : 1.0;  // m/s
  for (const std::uint64_t seed : {1, 77}) {
    SCOPED_TRACE(seed);
    const Scene scene = make_scene(GetParam(), seed);
    expect_walkable(scene, speed);
    expect_clear_path(scene);
    EXPECT_GE(scene.stations.size(), 4u);
    EXPECT_LE(scene.stations.size(), 8u);
    expect_clear_stations(scene);
  }
}

INSTANTIATE_TEST_SUITE_P(scenes, EveryPath, testing::ValuesIn(test::kSceneKinds), test::name_by_scene);

// The test itself must see a path that goes through a wall.
TEST(scene_paths, a_path_through_a_wall_is_found) {
  Scene scene = make_scene(SceneKind::room, 1);
  scene.path.positions = {{-1, -1.6, 1.4}, {0.6, 1.4, 1.4}};
  scene.path.times = {0, 1};
  const StepsByPlace steps(scene.path);
  bool crossed = false;
  for (const SceneObject& object : scene.objects) {
    for (const Mesh::Face& face : object.mesh.faces)
      crossed = crossed || (object.name == "wall between the rooms" &&
                            steps.crossed_step(test::triangle(object.mesh, face)));
  }
  EXPECT_TRUE(crossed);
}

TEST(scene_paths, the_walk_climbs_every_floor_of_the_building_and_visits_rooms_on_each) {
  const Scene scene = make_scene(SceneKind::building, 1);
  std::array<int, 3> in_rooms{};
  int outside = 0;
  int between_floors = 0;
  for (const Eigen::Vector3d& place : scene.path.positions) {
    const double height = place.z() - 1.4;
    const auto floor = static_cast<int>(std::floor(height / 3.0 + 0.01));
    const bool is_inside = std::abs(place.x()) < 9 && std::abs(place.y()) < 5.5;
    if (!is_inside) ++outside;
    if (height > 3.0 * floor + 0.1 && height < 3.0 * floor + 2.9) ++between_floors;
    if (is_inside && place.x() < 6 && std::abs(place.y()) > 1.3 && std::abs(height - 3.0 * floor) < 1e-6)
      ++in_rooms.at(static_cast<std::size_t>(floor));
  }
  EXPECT_GT(outside, 600);
  EXPECT_GT(between_floors, 100);
  for (const int nodes : in_rooms)
    EXPECT_GT(nodes, 100);
}

}  // namespace
}  // namespace ray
