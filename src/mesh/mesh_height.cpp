#include "edges.h"
#include "plan_grid.h"

#include <raycloud/core/error.h>
#include <raycloud/mesh/mesh_height.h>
#include <raycloud/mesh/weld.h>

#include <optional>
#include <utility>

namespace ray {
namespace {

using Plan = Eigen::Vector2d;

Plan plan(const Eigen::Vector3d& point) {
  return point.head<2>();
}

/// Twice the signed area of a, b and p; exactly opposite when a and b change places, so that two faces which
/// share a side agree on which of them has the point.
double side_of(const Plan& a, const Plan& b, const Plan& p) {
  return (a.x() - p.x()) * (b.y() - p.y()) - (b.x() - p.x()) * (a.y() - p.y());
}

double plan_area(const Mesh& mesh, const Mesh::Face& face) {
  return side_of(plan(mesh.vertices[face[0]]), plan(mesh.vertices[face[1]]), plan(mesh.vertices[face[2]]));
}

std::optional<double> height_of_face(const Mesh& mesh, const Mesh::Face& face, const Plan& p) {
  const Eigen::Vector3d& a = mesh.vertices[face[0]];
  const Eigen::Vector3d& b = mesh.vertices[face[1]];
  const Eigen::Vector3d& c = mesh.vertices[face[2]];
  const double of_a = side_of(plan(b), plan(c), p);
  const double of_b = side_of(plan(c), plan(a), p);
  const double of_c = side_of(plan(a), plan(b), p);
  const bool anticlockwise = of_a >= 0.0 && of_b >= 0.0 && of_c >= 0.0;
  const bool clockwise = of_a <= 0.0 && of_b <= 0.0 && of_c <= 0.0;
  const double sum = of_a + of_b + of_c;
  if ((!anticlockwise && !clockwise) || sum == 0.0) return std::nullopt;
  return (of_a * a.z() + of_b * b.z() + of_c * c.z()) / sum;
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

PlanGrid grid_of_faces(const Mesh& mesh) {
  std::vector<PlanShape> shapes;
  for (const Mesh::Face& face : mesh.faces)
    shapes.push_back(
        {plan(mesh.vertices[face[0]]), plan(mesh.vertices[face[1]]), plan(mesh.vertices[face[2]])});
  return PlanGrid(shapes);
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
        faces_at(grid_of_faces(mesh)),
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
  PlanGrid faces_at;
  PlanGrid rims_at;
};

MeshHeight::MeshHeight(const Mesh& mesh) : impl_(std::make_unique<Impl>(weld(mesh))) {}
MeshHeight::~MeshHeight() = default;
MeshHeight::MeshHeight(MeshHeight&&) noexcept = default;
MeshHeight& MeshHeight::operator=(MeshHeight&&) noexcept = default;

HeightAt MeshHeight::at(double x, double y) const {
  const Plan place(x, y);
  std::optional<double> highest;
  for (const std::uint32_t item : impl_->faces_at.at(place)) {
    const auto height = height_of_face(impl_->mesh, impl_->mesh.faces[item], place);
    if (height && (!highest || *height > *highest)) highest = height;
  }
  if (highest) return {*highest, false};
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
