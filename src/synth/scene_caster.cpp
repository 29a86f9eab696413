#include "embree_scene.h"

#include <raycloud/synth/scene_caster.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace ray {
namespace {

struct Mover {
  std::size_t object = 0;
  std::unique_ptr<EmbreeScene> surfaces;
  double radius = 0.0;  ///< m; of a ball around the origin of its own frame
};

Mover mover_of(const SceneObject& object, std::size_t index) {
  Mover mover{.object = index};
  mover.surfaces = std::make_unique<EmbreeScene>(
      std::vector<EmbreePart>{{&object.mesh, object.present.first, object.present.second}});
  for (const Eigen::Vector3d& vertex : object.mesh.vertices)
    mover.radius = std::max(mover.radius, vertex.norm());
  return mover;
}

/// False if a ball is surely not met within `longest`.
bool may_meet(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double longest, double radius) {
  const double along = std::clamp(-from.dot(direction), 0.0, longest);
  constexpr double kSlack = 1e-6;
  return (from + along * direction).squaredNorm() <= (radius + kSlack) * (radius + kSlack);
}

}  // namespace

Pose pose_at(const Trajectory& motion, double time) {
  const TrajectorySpot spot = spot_at(motion, time);
  Pose pose;
  pose.translation = position_at(motion, spot);
  if (motion.orientations.empty()) return pose;
  const Eigen::Vector4d a = motion.orientations[spot.node].coeffs();
  const std::size_t next = std::min(spot.node + 1, motion.size() - 1);
  const Eigen::Vector4d b = motion.orientations[next].coeffs();
  const double sign = a.dot(b) < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector4d sum = (1.0 - spot.fraction) * a + sign * spot.fraction * b;
  pose.rotation = Eigen::Quaterniond(Eigen::Vector4d(sum / sum.norm())).toRotationMatrix();
  return pose;
}

struct SceneCaster::Impl {
  const Scene& scene;
  std::vector<std::size_t> objects;  ///< of the parts of `standing`
  std::unique_ptr<EmbreeScene> standing;
  std::vector<Mover> movers;

  [[nodiscard]] std::optional<SceneHit> meet(const Mover& mover, const Eigen::Vector3d& origin,
                                             const Eigen::Vector3d& direction, double longest,
                                             double time) const {
    const SceneObject& object = scene.objects[mover.object];
    if (time < object.present.first || time >= object.present.second) return std::nullopt;
    const Eigen::Vector3d place = position_at(object.motion, spot_at(object.motion, time));
    if (!may_meet(origin - place, direction, longest, mover.radius)) return std::nullopt;
    const Pose pose = pose_at(object.motion, time);
    const Eigen::Vector3d from = pose.rotation.transpose() * (origin - pose.translation);
    const Eigen::Vector3d along = pose.rotation.transpose() * direction;
    const auto hit = mover.surfaces->nearest(from, along, longest, time);
    if (!hit) return std::nullopt;
    return finished({hit->range, mover.object, hit->face}, pose.rotation, direction);
  }

  [[nodiscard]] SceneHit finished(SceneHit hit, const Eigen::Matrix3d& rotation,
                                  const Eigen::Vector3d& direction) const {
    const Mesh& mesh = scene.objects[hit.object].mesh;
    const Mesh::Face& face = mesh.faces[hit.face];
    const Eigen::Vector3d& corner = mesh.vertices[face[0]];
    const Eigen::Vector3d across = (mesh.vertices[face[1]] - corner).cross(mesh.vertices[face[2]] - corner);
    hit.normal = rotation * across.normalized();
    if (hit.normal.dot(direction) > 0.0) hit.normal = -hit.normal;
    return hit;
  }
};

SceneCaster::SceneCaster(const Scene& scene)
    : impl_(new Impl{.scene = scene, .objects = {}, .standing = nullptr, .movers = {}}) {
  std::vector<EmbreePart> parts;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    if (object.motion.empty()) {
      parts.push_back({&object.mesh, object.present.first, object.present.second});
      impl_->objects.push_back(i);
    } else {
      impl_->movers.push_back(mover_of(object, i));
    }
  }
  impl_->standing = std::make_unique<EmbreeScene>(parts);
}

SceneCaster::~SceneCaster() = default;

std::optional<SceneHit> SceneCaster::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                          double longest, double time) const {
  std::optional<SceneHit> nearest;
  if (const auto hit = impl_->standing->nearest(origin, direction, longest, time)) {
    nearest = impl_->finished({hit->range, impl_->objects[hit->part], hit->face}, Eigen::Matrix3d::Identity(),
                              direction);
  }
  for (const Mover& mover : impl_->movers) {
    const double within = nearest ? nearest->range : longest;
    const auto hit = impl_->meet(mover, origin, direction, within, time);
    if (hit && (!nearest || hit->range < nearest->range || hit->object < nearest->object)) nearest = hit;
  }
  return nearest;
}

}  // namespace ray
