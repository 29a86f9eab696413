#include "gaussian.h"
#include "materials.h"

#include <raycloud/core/error.h>
#include <raycloud/synth/scene_caster.h>
#include <raycloud/synth/simulate.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace ray {
namespace {

constexpr double kNearest = 1e-3;     // m
constexpr double kFarthest = 1000.0;  // m

std::vector<ColumnInfo> truth_schema() {
  return {{"label", ScalarType::uint8},      {"object_id", ScalarType::int32},
          {"moving", ScalarType::uint8},     {"true_x", ScalarType::float64},
          {"true_y", ScalarType::float64},   {"true_z", ScalarType::float64},
          {"normal_x", ScalarType::float32}, {"normal_y", ScalarType::float32},
          {"normal_z", ScalarType::float32}};
}

/// The truth columns of a chunk, if it has them.
class TruthColumns {
 public:
  explicit TruthColumns(RayCloud& rays) {
    if (rays.extras.empty()) return;
    label_ = rays.extras[0].values<std::uint8_t>();
    object_ = rays.extras[1].values<std::int32_t>();
    moving_ = rays.extras[2].values<std::uint8_t>();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      end_[axis] = rays.extras[3 + axis].values<double>();
      normal_[axis] = rays.extras[6 + axis].values<float>();
    }
  }

  /// `object` is nullptr for an unbounded ray.
  void set(std::size_t row, const SceneObject* object, const Eigen::Vector3d& end,
           const Eigen::Vector3d& normal) {
    if (label_.empty()) return;
    label_[row] = static_cast<std::uint8_t>(object != nullptr ? object->label : SceneLabel::nothing);
    object_[row] = object != nullptr ? object->id : -1;
    moving_[row] = object != nullptr && object->is_transient() ? 1 : 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      end_[axis][row] = end[static_cast<Eigen::Index>(axis)];
      normal_[axis][row] = static_cast<float>(normal[static_cast<Eigen::Index>(axis)]);
    }
  }

 private:
  std::span<std::uint8_t> label_;
  std::span<std::int32_t> object_;
  std::span<std::uint8_t> moving_;
  std::array<std::span<double>, 3> end_;
  std::array<std::span<float>, 3> normal_;
};

class SimulatedScan final : public RaySource {
 public:
  SimulatedScan(const Scene& scene, const SimulationOptions& options, ScanPlan plan)
      : scene_(scene),
        options_(options),
        plan_(std::move(plan)),
        caster_(scene),
        noise_(options.seed, "range noise") {
    info_.ray_count = options.rays;
    if (options.truth) info_.extras = truth_schema();
  }

  [[nodiscard]] const CloudInfo& info() const override { return info_; }

  [[nodiscard]] bool fetch(RawChunk& raw) override {
    raw.bytes.clear();
    raw.first_row = next_;
    raw.rows = static_cast<std::size_t>(std::min<std::uint64_t>(options_.chunk_rays, options_.rays - next_));
    next_ += raw.rows;
    return raw.rows > 0;
  }

  std::size_t decode(const RawChunk& raw, RayCloud& rays) const override {
    rays.set_schema(info_.extras);
    rays.resize(raw.rows);
    TruthColumns truth(rays);
    const std::size_t hint = plan_.node(raw.first_row);
    for (std::size_t row = 0; row < raw.rows; ++row)
      cast(raw.first_row + row, hint, row, rays, truth);
    return 0;
  }

  void rewind() override { next_ = 0; }

 private:
  void cast(std::uint64_t number, std::size_t hint, std::size_t row, RayCloud& rays,
            TruthColumns& truth) const {
    const Shot shot = plan_.shot(number, hint);
    const auto hit = caster_.cast(shot.origin, shot.direction, options_.range, shot.time);
    const double range = hit ? hit->range : options_.range;
    double measured = range;
    if (hit && options_.noise > 0.0)
      measured = std::max(kNearest, range + options_.noise * gaussian(noise_, number));
    rays.times[row] = shot.time;
    rays.starts[row] = shot.origin;
    rays.ends[row] = shot.origin + measured * shot.direction;
    rays.bounded[row] = hit ? 1 : 0;
    if (!options_.drift.empty()) {
      const Pose error = pose_error(options_.drift, shot.time, shot.origin);
      rays.starts[row] = error * shot.origin;
      rays.ends[row] = error * rays.ends[row];
    }
    const Eigen::Vector3d true_end = shot.origin + range * shot.direction;
    if (!hit) {
      rays.colours[row] = sky_colour();
      truth.set(row, nullptr, true_end, Eigen::Vector3d::Zero());
      return;
    }
    const SceneObject& object = scene_.objects[hit->object];
    const double incidence = std::min(1.0, -hit->normal.dot(shot.direction));
    rays.colours[row] = colour_of({object.label, object.id, hit->normal, incidence, range});
    truth.set(row, &object, true_end, hit->normal);
  }

  const Scene& scene_;
  SimulationOptions options_;
  ScanPlan plan_;
  SceneCaster caster_;
  RandomStream noise_;
  CloudInfo info_;
  std::uint64_t next_ = 0;
};

void check(const Scene& scene, const SimulationOptions& options) {
  const auto refuse = [](const std::string& what) { throw Error(ErrorCode::usage, what); };
  if (!(options.noise >= 0.0 && std::isfinite(options.noise))) refuse("the noise must be 0 or more");
  if (!(options.range > 0.0 && options.range <= kFarthest))
    refuse("the range must be above 0 and at most 1000 m");
  if (options.chunk_rays == 0) refuse("a chunk has at least one ray");
  if (scene.path.empty()) refuse("the scene has no path for a scanner");
  if (std::holds_alternative<StandingScanner>(options.scanner) && scene.stations.empty())
    refuse("the scene has no stations for a scanner");
}

ScanPlan plan_of(const Scene& scene, const SimulationOptions& options) {
  if (const auto* spinning = std::get_if<SpinningScanner>(&options.scanner))
    return {*spinning, scene.path, options.rays};
  return {StandingScanner{}, scene.path, scene.stations, options.rays};
}

}  // namespace

std::unique_ptr<RaySource> simulate(const Scene& scene, const SimulationOptions& options) {
  check(scene, options);
  return std::make_unique<SimulatedScan>(scene, options, plan_of(scene, options));
}

Mesh scene_mesh(const Scene& scene) {
  Mesh all;
  Column ids({"object_id", ScalarType::int32});
  Column labels({"label", ScalarType::uint8});
  for (const SceneObject& object : scene.objects) {
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    const Pose pose = object.motion.empty() ? Pose{} : pose_at(object.motion, object.motion.times.front());
    for (const Eigen::Vector3d& vertex : object.mesh.vertices)
      all.vertices.push_back(object.motion.empty() ? vertex : pose * vertex);
    for (const Mesh::Face& face : object.mesh.faces)
      all.faces.push_back({first + face[0], first + face[1], first + face[2]});
    ids.resize(all.faces.size());
    labels.resize(all.faces.size());
    const std::size_t own = object.mesh.faces.size();
    std::fill_n(ids.values<std::int32_t>().end() - static_cast<std::ptrdiff_t>(own), own, object.id);
    std::fill_n(labels.values<std::uint8_t>().end() - static_cast<std::ptrdiff_t>(own), own,
                static_cast<std::uint8_t>(object.label));
  }
  all.face_columns = {std::move(ids), std::move(labels)};
  return all;
}

}  // namespace ray
