// Movers do what their names say, on the ground, and out of the way.
#include "scene_words.h"
#include "small_scene.h"

#include <raycloud/synth/movers.h>
#include <raycloud/synth/scene_caster.h>
#include <raycloud/synth/scenes.h>

#include <gtest/gtest.h>

#include <map>

namespace ray {
namespace {

/// Whole steps of its motion of 0.1 s in which it goes, and in which it stands.
std::pair<int, int> going_and_standing(const SceneObject& mover) {
  int going = 0;
  int standing = 0;
  for (std::size_t i = 1; i < mover.motion.size(); ++i)
    ++((mover.motion.positions[i] - mover.motion.positions[i - 1]).norm() > 1e-6 ? going : standing);
  return {going, standing};
}

void check_mover(const Scene& scene, const SceneObject& mover, const SceneCaster& standing) {
  const auto& times = scene.path.times;
  const double from = std::max(mover.present.first, times.front());
  const double until = std::min(mover.present.second, times.back());
  ASSERT_FALSE(mover.motion.empty());
  ASSERT_EQ(mover.motion.orientations.size(), mover.motion.size());
  EXPECT_TRUE(mover.is_transient());
  EXPECT_LE(mover.motion.times.front(), from);
  EXPECT_GE(mover.motion.times.back(), until - 1e-9);
  for (double time = from; time < until; time += 0.37) {
    const Pose pose = pose_at(mover.motion, time);
    const Eigen::Vector3d scanner = position_at(scene.path, spot_at(scene.path, time));
    EXPECT_GT((pose * Eigen::Vector3d(0, 0, 1) - scanner).norm(), 0.9);
    // Upright, and standing on what is there: the ground is where it steps, to the slope of half a step.
    EXPECT_NEAR((pose.rotation * Eigen::Vector3d::UnitZ()).z(), 1.0, 1e-12);
    const Eigen::Vector3d knee = pose * Eigen::Vector3d(0, 0, 0.5);
    const auto below = standing.cast(knee, -Eigen::Vector3d::UnitZ(), 2.0, time);
    ASSERT_TRUE(below) << mover.name << " " << time;
    EXPECT_NEAR(below->range, 0.5, 0.35) << mover.name << " " << time;
  }
}

class WithMovers : public ::testing::TestWithParam<SceneKind> {};
INSTANTIATE_TEST_SUITE_P(Scenes, WithMovers,
                         ::testing::Values(SceneKind::room, SceneKind::building, SceneKind::tree),
                         test::name_by_scene);

TEST_P(WithMovers, DoWhatTheirNamesSay) {
  const Scene scene = make_scene(GetParam(), 3);
  const SceneCaster standing(scene);
  const Scene moving = with_movers(scene, 6, 3);
  ASSERT_GE(moving.objects.size(), scene.objects.size() + 3) << "room for too few";
  std::map<std::string, int> habits;
  for (std::size_t i = scene.objects.size(); i < moving.objects.size(); ++i) {
    const SceneObject& mover = moving.objects[i];
    EXPECT_EQ(mover.id, static_cast<int>(i));
    EXPECT_TRUE(mover.label == SceneLabel::person || mover.label == SceneLabel::vehicle);
    check_mover(scene, mover, standing);
    const std::string habit = mover.name.substr(mover.name.find(", ") + 2);
    ++habits[habit];
    const auto [going, waiting] = going_and_standing(mover);
    EXPECT_GT(going, 5) << mover.name;
    EXPECT_GT(waiting, habit == "stop and go" ? 20 : -1) << mover.name;
    if (habit == "appears once") {
      EXPECT_GT(mover.present.first, scene.path.times.front());
      EXPECT_LT(mover.present.second, scene.path.times.back());
    }
    if (habit == "leaves once") {
      EXPECT_LT(mover.present.first, scene.path.times.front());
      EXPECT_LT(mover.present.second, scene.path.times.back());
    }
  }
  EXPECT_GE(habits.size(), 2u);
}

TEST(Movers, TheSameSeedTheSameWays) {
  const Scene scene = make_scene(SceneKind::room, 1);
  const Scene a = with_movers(scene, 4, 5);
  const Scene b = with_movers(scene, 4, 5);
  const Scene c = with_movers(scene, 4, 6);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  bool differs = a.objects.size() != c.objects.size();
  for (std::size_t i = scene.objects.size(); i < a.objects.size(); ++i) {
    EXPECT_EQ(a.objects[i].motion.positions, b.objects[i].motion.positions);
    if (!differs) differs = a.objects[i].motion.positions != c.objects[i].motion.positions;
  }
  EXPECT_TRUE(differs);
}

TEST(Movers, NoneInAWorldWithoutRoom) {
  Scene scene = test::small_scene();
  scene.objects.erase(scene.objects.begin());  // no floor to stand on
  EXPECT_EQ(with_movers(scene, 3, 1).objects.size(), scene.objects.size());
}

}  // namespace
}  // namespace ray
