#include "edges.h"
#include "plan_heights.h"

#include <raycloud/core/error.h>
#include <raycloud/mesh/mesh_height.h>
#include <raycloud/mesh/weld.h>

#include <utility>

namespace ray {
namespace {

using Plan = Eigen::Vector2d;

Plan plan(const Eigen::Vector3d& point) {
  return point.head<2>();
}

/// Edges with faces on one side only, seen from above.
std::vector<FaceSide> rims_of(const Mesh& mesh) {
  std::vector<FaceSide> rims;
  for_each_edge(sorted_sides(mesh), [&](const FaceSide* first, const FaceSide* last) {
    bool left = false;
    bool right = false;
    for (const FaceSide* side = first; side < last; ++side)
      ((plan_area(mesh, mesh.faces[side->face]) > 0.0) == side->forwards ? left : right) = true;
    if (left != right) rims.push_back(*first);
  });
  return rims;
}

/// Without what cannot be seen from above.
Mesh seen_from_above(Mesh mesh) {
  std::erase_if(mesh.faces, [&](const Mesh::Face& face) { return plan_area(mesh, face) == 0.0; });
  if (mesh.faces.empty()) throw Error(ErrorCode::no_data, "no face of the mesh can be seen from above");
  return mesh;
}

PlanGrid grid_of_rims(const Mesh& mesh, const std::vector<FaceSide>& rims) {
  std::vector<PlanShape> shapes;
  for (const FaceSide& rim : rims) {
    const Plan end = plan(mesh.vertices[rim.high]);
    shapes.push_back({plan(mesh.vertices[rim.low]), end, end});
  }
  return PlanGrid(shapes);
}

}  // namespace

struct MeshHeight::Impl {
  explicit Impl(WeldedMesh welded)
      : without_area(welded.without_area),
        mesh(seen_from_above(std::move(welded.mesh))),
        rims(rims_of(mesh)),
        heights(mesh),
        rims_at(grid_of_rims(mesh, rims)) {}

  [[nodiscard]] double nearest_rim(const Plan& place) const {
    double best = std::numeric_limits<double>::infinity();
    double height = 0.0;
    rims_at.search(place, [&](std::uint32_t item) {
      const Eigen::Vector3d& a = mesh.vertices[rims[item].low];
      const Eigen::Vector3d& b = mesh.vertices[rims[item].high];
      const Plan along = plan(b) - plan(a);
      const double t = std::clamp((place - plan(a)).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const double squared = (place - plan(a) - t * along).squaredNorm();
      const double there = a.z() + t * (b.z() - a.z());
      if (squared < best || (squared == best && there > height)) {
        best = squared;
        height = there;
      }
      return squared;
    });
    return height;
  }

  std::size_t without_area;
  Mesh mesh;
  std::vector<FaceSide> rims;
  PlanHeights heights;
  PlanGrid rims_at;
};

MeshHeight::MeshHeight(const Mesh& mesh) : impl_(std::make_unique<Impl>(weld(mesh))) {}
MeshHeight::~MeshHeight() = default;
MeshHeight::MeshHeight(MeshHeight&&) noexcept = default;
MeshHeight& MeshHeight::operator=(MeshHeight&&) noexcept = default;

HeightAt MeshHeight::at(double x, double y) const {
  const Plan place(x, y);
  if (const auto highest = impl_->heights.highest(place)) return {*highest, false};
  return {impl_->nearest_rim(place), true};
}

std::size_t MeshHeight::faces_without_area() const {
  return impl_->without_area;
}

HeightShift shift_by_height(const Context& context, RaySource& source, RaySink& sink, const MeshHeight& mesh,
                            double factor) {
  HeightShift shift;
  shift.stream = stream(
      context, source, &sink,
      [&](RayCloud& rays) {
        std::uint64_t beyond = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
          const HeightAt end = mesh.at(rays.ends[i].x(), rays.ends[i].y());
          const HeightAt start = mesh.at(rays.starts[i].x(), rays.starts[i].y());
          rays.ends[i].z() += factor * end.height;
          rays.starts[i].z() += factor * start.height;
          beyond += end.beyond ? 1 : 0;
        }
        return beyond;
      },
      [&](RayCloud&, std::uint64_t beyond) { shift.beyond += beyond; });
  return shift;
}

}  // namespace ray
