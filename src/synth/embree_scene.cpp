#include "embree_scene.h"

#include "ray_triangle.h"

#include <raycloud/core/bounds.h>
#include <raycloud/core/error.h>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <string>
#include <tuple>

namespace ray {
namespace {

#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
#else
using EmbreeContext = RTCIntersectContext;
#endif

constexpr double kLongest = 1000.0;   // m
constexpr double kFloatError = 4e-7;  // of a coordinate, after a few operations

/// What the callback of a ray may see; Embree hands back the pointer to `base`.
struct Query {
  EmbreeContext base;
  const Eigen::Vector3d* origin;
  const Eigen::Vector3d* direction;
  double time;
  double margin;
  EmbreeHit best;
  bool found = false;
};

void begin(EmbreeContext& context) {
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&context);
#else
  rtcInitIntersectContext(&context);
#endif
}

void intersect(RTCScene scene, EmbreeContext& context, RTCRayHit& ray) {
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &ray, &arguments);
#else
  rtcIntersect1(scene, &context, &ray);
#endif
}

}  // namespace

struct EmbreeScene::Impl {
  /// A part as its geometry knows it.
  struct Geometry {
    EmbreePart part;
    std::uint32_t index = 0;
    const Impl* scene = nullptr;
  };

  ~Impl() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  void build();
  void add(Geometry& geometry) const;
  void check() const;

  static void bounds_of(const RTCBoundsFunctionArguments* arguments);
  static void meet(const RTCIntersectFunctionNArguments* arguments);

  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<Geometry> geometries;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double margin = 0.0;  ///< m; what single precision may do to a ray and a box
};

/// A box around the triangle, so much larger that a ray which single precision has moved still meets it.
void EmbreeScene::Impl::bounds_of(const RTCBoundsFunctionArguments* arguments) {
  const auto& geometry = *static_cast<const Geometry*>(arguments->geometryUserPtr);
  Bounds box;
  for (const std::uint32_t vertex : geometry.part.mesh->faces[arguments->primID])
    box.add(geometry.part.mesh->vertices[vertex] - geometry.scene->centre);
  const Eigen::Vector3f low = (box.min.array() - geometry.scene->margin).cast<float>();
  const Eigen::Vector3f high = (box.max.array() + geometry.scene->margin).cast<float>();
  RTCBounds& out = *arguments->bounds_o;
  out.lower_x = low.x(), out.lower_y = low.y(), out.lower_z = low.z();
  out.upper_x = high.x(), out.upper_y = high.y(), out.upper_z = high.z();
}

void EmbreeScene::Impl::meet(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  const auto& geometry = *static_cast<const Geometry*>(arguments->geometryUserPtr);
  auto& query = *reinterpret_cast<Query*>(arguments->context);
  if (query.time < geometry.part.from || query.time >= geometry.part.until) return;
  const Mesh& mesh = *geometry.part.mesh;
  const auto range = range_to_triangle(*query.origin, *query.direction, mesh, mesh.faces[arguments->primID]);
  if (!range || *range > query.best.range) return;
  const EmbreeHit hit{*range, geometry.index, arguments->primID};
  if (*range == query.best.range && query.found &&
      std::tie(query.best.part, query.best.face) <= std::tie(hit.part, hit.face))
    return;
  query.best = hit;
  query.found = true;
  RTCRayN* const ray = RTCRayHitN_RayN(arguments->rayhit, arguments->N);
  RTCHitN* const embree_hit = RTCRayHitN_HitN(arguments->rayhit, arguments->N);
  // Nothing that lies nearer, or as near, may be cut off by rounding.
  RTCRayN_tfar(ray, arguments->N, 0) = static_cast<float>(*range + query.margin);
  RTCHitN_geomID(embree_hit, arguments->N, 0) = arguments->geomID;
  RTCHitN_primID(embree_hit, arguments->N, 0) = arguments->primID;
}

void EmbreeScene::Impl::check() const {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  throw Error(ErrorCode::out_of_range, error == RTC_ERROR_OUT_OF_MEMORY
                                           ? "not enough memory to cast rays into this scene"
                                           : "Embree failed (error " + std::to_string(int(error)) + ")");
}

void EmbreeScene::Impl::add(Geometry& geometry) const {
  RTCGeometry handle = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(handle, static_cast<unsigned>(geometry.part.mesh->faces.size()));
  rtcSetGeometryUserData(handle, &geometry);
  rtcSetGeometryBoundsFunction(handle, bounds_of, nullptr);
  rtcSetGeometryIntersectFunction(handle, meet);
  rtcCommitGeometry(handle);
  rtcAttachGeometryByID(scene, handle, geometry.index);
  rtcReleaseGeometry(handle);
}

void EmbreeScene::Impl::build() {
  Bounds bounds;
  for (const Geometry& geometry : geometries) {
    for (const Eigen::Vector3d& vertex : geometry.part.mesh->vertices)
      bounds.add(vertex);
  }
  if (!bounds.empty()) centre = 0.5 * (bounds.min + bounds.max);
  margin = kFloatError * (0.5 * bounds.extent().norm() + kLongest);
  // Told a number of threads, Embree would limit those of the whole program.
  device = rtcNewDevice(nullptr);
  check();
  scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  for (Geometry& geometry : geometries) {
    if (!geometry.part.mesh->faces.empty()) add(geometry);
  }
  rtcCommitScene(scene);
  check();
}

EmbreeScene::EmbreeScene(const std::vector<EmbreePart>& parts) : impl_(std::make_unique<Impl>()) {
  for (const EmbreePart& part : parts) {
    const auto index = static_cast<std::uint32_t>(impl_->geometries.size());
    impl_->geometries.push_back({part, index, impl_.get()});
  }
  impl_->build();
}

EmbreeScene::~EmbreeScene() = default;

std::optional<EmbreeHit> EmbreeScene::nearest(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                              double longest, double time) const {
  Query query{.origin = &origin, .direction = &direction, .time = time, .margin = impl_->margin};
  begin(query.base);
  query.best.range = longest;
  const Eigen::Vector3f from = (origin - impl_->centre).cast<float>();
  const Eigen::Vector3f along = direction.cast<float>();
  RTCRayHit ray{};
  ray.ray.org_x = from.x(), ray.ray.org_y = from.y(), ray.ray.org_z = from.z();
  ray.ray.dir_x = along.x(), ray.ray.dir_y = along.y(), ray.ray.dir_z = along.z();
  ray.ray.tfar = static_cast<float>(longest + impl_->margin);
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  intersect(impl_->scene, query.base, ray);
  if (!query.found) return std::nullopt;
  return query.best;
}

}  // namespace ray
