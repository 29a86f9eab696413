// The caster against a slow intersector that shares no code with it, and closed surfaces that nothing may
// leave.
#include "small_scene.h"

#include <raycloud/exec/random.h>
#include <raycloud/synth/scene_caster.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

namespace ray {
namespace {

using namespace test;

Eigen::Vector3d direction_of(const RandomStream& random, std::uint64_t i) {
  Eigen::Vector3d v;
  do {
    v = 2.0 * Eigen::Vector3d(random.uniform(i, 0), random.uniform(i, 1), random.uniform(i, 2)) -
        Eigen::Vector3d::Ones();
    i += 1'000'000'007;
  } while (v.squaredNorm() > 1.0 || v.squaredNorm() < 1e-6);
  return v.normalized();
}

/// The least barycentric coordinate of a point on the face.
double margin_in(const Mesh& mesh, std::uint32_t index, const Eigen::Vector3d& point) {
  const Mesh::Face& face = mesh.faces[index];
  const auto corner = [&](std::size_t i) { return mesh.vertices[face[i % 3]]; };
  const Eigen::Vector3d across = (corner(1) - corner(0)).cross(corner(2) - corner(0));
  double least = 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d part = (corner(i + 1) - corner(i)).cross(point - corner(i));
    least = std::min(least, part.dot(across) / across.squaredNorm());
  }
  return least;
}

RC_GTEST_PROP(SceneCaster, FindsWhatASlowIntersectorFindsInTriangleSoup, ()) {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "soup");
  const double size = *rc::gen::element(0.01, 0.3, 3.0);
  const double away = *rc::gen::element(0.0, 300.0);  // from the middle of the world
  Scene scene;
  for (std::uint64_t o = 0; o < 3; ++o) {
    Mesh mesh;
    for (std::uint64_t t = 0; t < 100; ++t) {
      Eigen::Vector3d centre(random.uniform(o, 10 * t), random.uniform(o, 10 * t + 1),
                             random.uniform(o, 10 * t + 2));
      centre = 10.0 * centre + Eigen::Vector3d::Constant(away);
      for (std::uint64_t corner = 0; corner < 3; ++corner)
        mesh.vertices.push_back(centre + size * direction_of(random, 1000 * o + 10 * t + corner));
      const auto first = static_cast<std::uint32_t>(3 * t);
      mesh.faces.push_back({first, first + 1, first + 2});
    }
    add_object(scene, SceneLabel::wall, mesh);
  }
  // Far from the rest, so that the middle of the scene lies elsewhere.
  add_object(scene, SceneLabel::wall, box_mesh({-200, -200, -200}, {-199, -199, -199}));
  const SceneCaster caster(scene);
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Eigen::Vector3d origin =
        Eigen::Vector3d::Constant(away + 5.0) + 12.0 * direction_of(random, 7000 + i);
    // At a triangle, or its corner.
    const Mesh& mesh = scene.objects[i % 3].mesh;
    Eigen::Vector3d aim = mesh.vertices[random.below(300, i, 5)];
    if (i % 2 == 0) aim += 0.3 * size * direction_of(random, 9000 + i);
    const Eigen::Vector3d direction = (aim - origin).normalized();
    const SlowHit slow = slow_cast(scene, origin, direction, 0.0);
    const auto hit = caster.cast(origin, direction, 900.0, 0.0);
    if (slow.range < 900.0 && slow.margin > 1e-7) {
      RC_ASSERT(hit.has_value());
      RC_ASSERT(hit->range < slow.range + 1e-9);
    }
    if (hit) {
      // What it met is a triangle, at that range.
      const SceneObject& object = scene.objects[hit->object];
      const Mesh::Face& face = object.mesh.faces[hit->face];
      const Eigen::Vector3d a = object.mesh.vertices[face[0]];
      const Eigen::Vector3d across =
          (object.mesh.vertices[face[1]] - a).cross(object.mesh.vertices[face[2]] - a);
      const double off = (origin + hit->range * direction - a).dot(across.normalized());
      RC_ASSERT(std::abs(off) < 1e-9);
      RC_ASSERT(std::abs(hit->normal.dot(across.normalized())) > 1.0 - 1e-12);
      RC_ASSERT(hit->normal.dot(direction) <= 0.0);
      // An edge or corner that was aimed at may go to either; anything nearer must truly be there.
      const double margin = margin_in(object.mesh, hit->face, origin + hit->range * direction);
      RC_ASSERT(margin > -1e-7);
      if (margin > 1e-7 && slow.margin > 1e-7) RC_ASSERT(std::abs(hit->range - slow.range) < 1e-9);
    }
  }
}

TEST(SceneCaster, NothingLeavesAClosedBox) {
  Scene scene;
  // Corners that are no floats, so that edges are where rounding puts them.
  add_object(scene, SceneLabel::wall, box_mesh({-1.1, -2.3, -0.7}, {3.3, 1.9, 2.1}));
  const SceneCaster caster(scene);
  const Mesh& mesh = scene.objects[0].mesh;
  const Eigen::Vector3d inside(0.3, 0.1, 0.2);
  const RandomStream random(1, "box");
  for (std::uint64_t i = 0; i < 200'000; ++i) {
    const Mesh::Face& face = mesh.faces[random.below(mesh.faces.size(), i)];
    const Eigen::Vector3d& a = mesh.vertices[face[0]];
    const Eigen::Vector3d& b = mesh.vertices[face[1]];
    // Exactly at edges and corners, as near as numbers go.
    const double along = i % 4 == 0 ? 0.0 : random.uniform(i, 1);
    const Eigen::Vector3d direction = (a + along * (b - a) - inside).normalized();
    ASSERT_TRUE(caster.cast(inside, direction, 100.0, 0.0)) << i;
  }
}

TEST(SceneCaster, ThingsAreThereFromTheirFirstToBeforeTheirLastMoment) {
  const Scene scene = small_scene();
  const SceneCaster caster(scene);
  const auto object_at = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double time) {
    const auto hit = caster.cast(from, direction, 100.0, time);
    return hit ? static_cast<int>(hit->object) : -1;
  };
  const Eigen::Vector3d above_chest(2.5, 3.5, 2.0);
  const Eigen::Vector3d down(0, 0, -1);
  EXPECT_EQ(object_at(above_chest, down, std::nextafter(10.0, 0.0)), 0);
  EXPECT_EQ(object_at(above_chest, down, 10.0), 3);
  const Eigen::Vector3d above_crate(-3.5, 3.5, 2.0);
  EXPECT_EQ(object_at(above_crate, down, std::nextafter(5.0, 0.0)), 4);
  EXPECT_EQ(object_at(above_crate, down, 5.0), 0);
  // The person, where it is at half of its way, and no longer where it was.
  EXPECT_EQ(object_at({-2.5, -5.5, 3.0}, down, 5.0), 5);
  EXPECT_EQ(object_at({-2.5, -5.5, 3.0}, down, 0.0), 0);
  EXPECT_EQ(object_at({-5.0, -6.0, 3.0}, down, 0.0), 5);
  EXPECT_EQ(object_at({-2.5, -5.5, 3.0}, -down, 5.0), -1);
}

TEST(SceneCaster, TheLimitOfTheRangeIsKept) {
  const Scene scene = small_scene();
  const SceneCaster caster(scene);
  const Eigen::Vector3d down(0, 0, -1);
  EXPECT_TRUE(caster.cast({10, 0, 2}, down, 2.0, 0.0));
  EXPECT_FALSE(caster.cast({10, 0, 2}, down, std::nextafter(2.0, 0.0), 0.0));
  EXPECT_FALSE(caster.cast({10, 0, 2}, -down, 1000.0, 0.0));
}

TEST(SceneCaster, OfTwoSurfacesInOnePlaceTheFirstIsMet) {
  Scene scene;
  add_object(scene, SceneLabel::wall, box_mesh({0, 0, 0}, {1, 1, 1}));
  add_object(scene, SceneLabel::door, box_mesh({0, 0, 0}, {1, 1, 1}));
  const SceneCaster caster(scene);
  const RandomStream random(1, "twins");
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const Eigen::Vector3d from(random.uniform(i, 0), random.uniform(i, 1), 3.0);
    const auto hit = caster.cast(from, {0, 0, -1}, 10.0, 0.0);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->object, 0u);
  }
}

TEST(SceneCaster, AnEmptySceneIsEmpty) {
  const Scene scene;
  const SceneCaster caster(scene);
  EXPECT_FALSE(caster.cast({0, 0, 0}, {1, 0, 0}, 1000.0, 0.0));
}

TEST(PoseAt, FollowsNodesAndStaysNearTheSphericalWay) {
  const Trajectory motion = small_scene().objects[5].motion;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const Pose pose = pose_at(motion, motion.times[i]);
    EXPECT_LT((pose.translation - motion.positions[i]).norm(), 1e-15);
    EXPECT_LT((pose.rotation - motion.orientations[i].toRotationMatrix()).norm(), 1e-14);
  }
  for (double time = -1.0; time < 22.0; time += 0.1) {
    const Pose pose = pose_at(motion, time);
    const auto slerped = orientation_at(motion, spot_at(motion, time)).toRotationMatrix();
    EXPECT_LT((pose.rotation - slerped).norm(), 0.02) << time;  // nodes up to 0.8 rad apart
    EXPECT_LT((pose.rotation * pose.rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace ray
