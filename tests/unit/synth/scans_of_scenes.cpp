// Every world, scanned without noise: nothing stands between the sensor and what it saw, and the sky is
// empty. The rays are followed backwards, from their ends, so that the arithmetic is another one.
#include "scene_words.h"

#include <raycloud/exec/stream.h>
#include <raycloud/synth/movers.h>
#include <raycloud/synth/scene_caster.h>
#include <raycloud/synth/scenes.h>
#include <raycloud/synth/simulate.h>

#include <gtest/gtest.h>

namespace ray {
namespace {

constexpr double kTolerance = 1e-6;  // m

void check_scan(const Scene& scene, const SceneCaster& caster, const SimulationOptions& options) {
  const Context context;
  const auto source = simulate(scene, options);
  const RayCloud rays = read_all(context, *source);
  std::size_t bounded = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Vector3d along = rays.ends[i] - rays.starts[i];
    const double range = along.norm();
    const Eigen::Vector3d back = -along / range;
    const Eigen::Vector3d from = rays.ends[i] + kTolerance * back;
    const auto between = caster.cast(from, back, range - 2 * kTolerance, rays.times[i]);
    ASSERT_FALSE(between) << "ray " << i << " passes through " << scene.objects[between->object].name
                          << " at " << range - between->range << " of " << range;
    if (rays.bounded[i] == 0) {
      ASSERT_NEAR(range, options.range, 1e-9);
      continue;
    }
    ++bounded;
    // And there is a surface at the end.
    const auto there = caster.cast(rays.ends[i] + kTolerance * back, -back, 2 * kTolerance, rays.times[i]);
    ASSERT_TRUE(there) << i;
  }
  EXPECT_GT(bounded, rays.size() / 4);
}

class ScansOfScenes : public ::testing::TestWithParam<SceneKind> {};
INSTANTIATE_TEST_SUITE_P(Scenes, ScansOfScenes, testing::ValuesIn(test::kSceneKinds), test::name_by_scene);

TEST_P(ScansOfScenes, AgreeWithTheirSurfaces) {
  Scene scene = make_scene(GetParam(), 2);
  if (GetParam() != SceneKind::forest) scene = with_movers(std::move(scene), 2, 2);
  const SceneCaster caster(scene);
  check_scan(scene, caster, {.rays = 30'000, .noise = 0.0});
  if (GetParam() == SceneKind::forest) return;  // slow to build: once is enough
  check_scan(scene, caster, {.rays = 30'000, .scanner = StandingScanner{}, .noise = 0.0});
}

}  // namespace
}  // namespace ray
