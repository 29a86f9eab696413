#include "embree_faces.h"

#include <raycloud/core/bounds.h>
#include <raycloud/core/error.h>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace ray {
namespace {

constexpr double kSingleStep = 2.4e-7;  // of a coordinate, after its rounding and a few operations

struct Leaf {
  Corners corners;
  double spread = 0.0;  ///< m²; a third of the square of the longest side
};

std::vector<Leaf> leaves_of(const Mesh& mesh) {
  std::vector<Leaf> leaves;
  leaves.reserve(mesh.faces.size());
  for (const Mesh::Face& face : mesh.faces) {
    Leaf& leaf = leaves.emplace_back();
    leaf.corners.vertices = face;
    for (std::size_t i = 0; i < 3; ++i)
      leaf.corners.at[i] = mesh.vertices[face[i]];
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d side = leaf.corners.at[(i + 1) % 3] - leaf.corners.at[i];
      leaf.spread = std::max(leaf.spread, side.squaredNorm() / 3.0);
    }
  }
  return leaves;
}

}  // namespace

struct EmbreeFaces::Impl {
  explicit Impl(const Mesh& mesh) : leaves(leaves_of(mesh)) {
    Bounds all;
    for (const Leaf& leaf : leaves)
      for (const Eigen::Vector3d& corner : leaf.corners.at)
        all.add(corner);
    centre = 0.5 * (all.min + all.max);
    half_size = 0.5 * all.extent().norm();
  }
  ~Impl() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  void build() {
    // Told a number of threads, Embree would limit those of the whole program.
    device = rtcNewDevice(nullptr);
    check();
    scene = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(leaves.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, bounds_of, nullptr);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    check();
  }

  void check() const {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE) return;
    throw Error(ErrorCode::out_of_range, error == RTC_ERROR_OUT_OF_MEMORY
                                             ? "not enough memory for a tree of the mesh"
                                             : "Embree failed (error " + std::to_string(int(error)) + ")");
  }

  /// No smaller than the triangle.
  static void bounds_of(const RTCBoundsFunctionArguments* arguments) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const auto& impl = *static_cast<const Impl*>(arguments->geometryUserPtr);
    Bounds box;
    for (const Eigen::Vector3d& corner : impl.leaves[arguments->primID].corners.at)
      box.add(corner - impl.centre);
    const Eigen::Vector3f low = box.min.cast<float>();
    const Eigen::Vector3f high = box.max.cast<float>();
    RTCBounds& out = *arguments->bounds_o;
    out.lower_x = std::nextafter(low.x(), -kInfinity), out.upper_x = std::nextafter(high.x(), kInfinity);
    out.lower_y = std::nextafter(low.y(), -kInfinity), out.upper_y = std::nextafter(high.y(), kInfinity);
    out.lower_z = std::nextafter(low.z(), -kInfinity), out.upper_z = std::nextafter(high.z(), kInfinity);
  }

  std::vector<Leaf> leaves;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double half_size = 0.0;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
};

namespace {

/// One point's search: the best so far, and how near in single precision a box must be to matter.
struct Search {
  const std::vector<Leaf>& leaves;
  const Eigen::Vector3d& point;
  double slack = 0.0;  ///< m; what single precision may do to a distance
  double enough = 0.0;
  NearestFace best;

  /// Whether it is better than the best so far, and now that.
  bool look_at(std::uint32_t face) {
    const Leaf& leaf = leaves[face];
    const double bound = best.nearest.squared * (1.0 + 1e-12) + slack * slack;
    // For a place of the face with weights w of its corners, |p - place|² = Σ w_i |p - corner_i|² -
    // Σ w_i w_j side_ij², so from afar no place is much nearer than the nearest corner.
    double corner = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& at : leaf.corners.at)
      corner = std::min(corner, (point - at).squaredNorm());
    if (corner - leaf.spread > bound) return false;
    const NearestPlace found = nearest_on_face(point, leaf.corners, bound);
    if (found.squared > best.nearest.squared) return false;
    if (found.squared == best.nearest.squared && face >= best.face) return false;
    best = {found, face};
    return true;
  }

  [[nodiscard]] bool is_enough() const {
    return best.face != EmbreeFaces::kNoFace && best.nearest.squared < enough;
  }

  [[nodiscard]] float reach() const {
    if (is_enough()) return 0.0f;
    return static_cast<float>(std::min((std::sqrt(best.nearest.squared) + slack) * (1.0 + 1e-6), 1e18));
  }

  static bool meet(RTCPointQueryFunctionArguments* arguments) {
    Search& search = *static_cast<Search*>(arguments->userPtr);
    if (search.is_enough() || !search.look_at(arguments->primID)) return false;
    arguments->query->radius = search.reach();
    return true;
  }
};

}  // namespace

EmbreeFaces::EmbreeFaces(const Mesh& mesh) {
  auto impl = std::make_unique<Impl>(mesh);
  impl->build();
  impl_ = std::move(impl);
}
EmbreeFaces::~EmbreeFaces() = default;

NearestFace EmbreeFaces::find(const Eigen::Vector3d& point, std::uint32_t near) const {
  return find_within(point, near, std::numeric_limits<double>::infinity(), -1.0);
}

NearestFace EmbreeFaces::find_within(const Eigen::Vector3d& point, std::uint32_t near, double most,
                                     double enough) const {
  const Eigen::Vector3d local = point - impl_->centre;
  Search search{.leaves = impl_->leaves,
                .point = point,
                .slack = kSingleStep * (local.cwiseAbs().maxCoeff() + impl_->half_size),
                .enough = enough,
                .best = {}};
  search.best.nearest.squared = most;
  search.best.face = kNoFace;
  if (near != kNoFace) search.look_at(near);
  if (search.is_enough()) return search.best;
  RTCPointQuery query{};
  query.x = static_cast<float>(local.x());
  query.y = static_cast<float>(local.y());
  query.z = static_cast<float>(local.z());
  query.radius = search.reach();
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(impl_->scene, &query, &context, &Search::meet, &search);
  return search.best;
}

}  // namespace ray
