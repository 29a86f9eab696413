#include "carved_body.h"
#include "insertion_order.h"
#include "lattice.h"
#include "wrap_forms.h"

#include <raycloud/core/error.h>
#include <raycloud/mesh/full_wrap.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <tuple>

namespace ray {
namespace {

using Index = Tetrahedra::Index;
using Cells = std::vector<Index>;

struct LatticeEnds {
  std::vector<LatticePoint> points;  ///< no two the same, each near the one before
  Eigen::Vector3d middle;            ///< the mean of the starts
};

LatticePoint upside_down(const LatticePoint& point) {
  return {point[0], point[1], kLatticeSteps - 1 - point[2]};
}

LatticeEnds ends_on(const Context& context, RaySource& source, const Lattice& lattice, bool downwards,
                    const Eigen::Vector3d& origin) {
  struct Placed {
    std::uint64_t place;
    LatticePoint point;
  };
  std::vector<Placed> placed;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  stream(
      context, source, nullptr,
      [&](RayCloud& rays) {
        std::vector<Placed> part;
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (rays.bounded[i] == 0) continue;
          const LatticePoint end = lattice.point(rays.ends[i]);
          const LatticePoint point = downwards ? upside_down(end) : end;
          const auto coordinate = [&](std::size_t axis) {
            return static_cast<std::uint32_t>(point[axis]) * 2;
          };
          part.push_back({place_on_curve({coordinate(0), coordinate(1), coordinate(2)}), point});
        }
        return part;
      },
      [&](RayCloud& rays, const std::vector<Placed>& part) {
        placed.insert(placed.end(), part.begin(), part.end());
        for (std::size_t i = 0; i < rays.size(); ++i)
          if (rays.bounded[i] != 0) sum += rays.starts[i] - origin;
      });
  const Eigen::Vector3d middle = origin + sum / static_cast<double>(std::max<std::size_t>(placed.size(), 1));
  parallel_sort(context, placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    return std::tie(a.place, a.point) < std::tie(b.place, b.point);
  });
  LatticeEnds ends{{}, middle};
  for (const Placed& one : placed)
    if (ends.points.empty() || ends.points.back() != one.point) ends.points.push_back(one.point);
  return ends;
}

/// The infinite cells; or only those on faces of the hull that look down.
Cells beyond_hull(const Tetrahedra& cells, bool below) {
  Cells found;
  for (Index at = 0; at < cells.places(); ++at) {
    if (!cells.is_alive(at) || !cells.is_infinite(at)) continue;
    if (below) {
      const auto& [a, b, c, d] = cells.cell(at).vertices;
      const LatticePoint &p = cells.point(a), &q = cells.point(b), &r = cells.point(c);
      const auto along = [](const LatticePoint& from, const LatticePoint& to, std::size_t axis) {
        return std::int64_t{to[axis]} - from[axis];
      };
      if (along(p, q, 0) * along(p, r, 1) - along(p, q, 1) * along(p, r, 0) >= 0) continue;
    }
    found.push_back(at);
  }
  return found;
}

/// The cells that the place is in or on: several if it is on a face between them; infinite ones if it is
/// outside.
Cells cells_at(const Tetrahedra& cells, const LatticePoint& place) {
  Cells found{cells.locate(place, cells.any_cell())};
  if (cells.is_infinite(found.front())) return found;
  for (std::size_t done = 0; done < found.size(); ++done) {
    const Tetrahedra::Cell& cell = cells.cell(found[done]);
    for (std::size_t i = 0; i < 4; ++i) {
      const Index other = cell.neighbours[i];
      if (cells.is_infinite(other) || std::find(found.begin(), found.end(), other) != found.end()) continue;
      const auto& [x, y, z] = Tetrahedra::kFaces[i];
      if (side_of_plane(cells.point(cell.vertices[x]), cells.point(cell.vertices[y]),
                        cells.point(cell.vertices[z]), place) == 0)
        found.push_back(other);
    }
  }
  return found;
}

/// Of the cells at the place the one with the largest sphere.
Cells largest_at(const Tetrahedra& cells, const LatticePoint& place) {
  const Cells at_place = cells_at(cells, place);
  if (cells.is_infinite(at_place.front())) return at_place;
  const auto key = [&](Index at) {
    auto vertices = cells.cell(at).vertices;
    std::sort(vertices.begin(), vertices.end());
    return std::make_pair(squared_radius_of(cells, at), vertices);
  };
  return {
      *std::max_element(at_place.begin(), at_place.end(), [&](Index a, Index b) { return key(a) < key(b); })};
}

[[noreturn]] void throw_no_room(const Eigen::Vector3d& middle, double radius) {
  char text[200];
  if (radius > 0.0) {
    std::snprintf(text, sizeof text,
                  "around the middle (%.3g,%.3g,%.3g) a ball of %.4g m fits between the ends: outwards takes "
                  "a curvature of %.5g or more",
                  middle.x(), middle.y(), middle.z(), radius, 1.00001 / radius);
  } else {
    std::snprintf(text, sizeof text,
                  "the middle (%.3g,%.3g,%.3g) is not between the ends, so there is nothing to blow up",
                  middle.x(), middle.y(), middle.z());
  }
  throw Error(ErrorCode::out_of_range, text);
}

CarvedBody body_from_middle(const Context& context, const LatticeEnds& ends, const Lattice& lattice,
                            const Bounds& bounds, double least_squared_radius) {
  if ((ends.middle.array() < bounds.min.array()).any() || (ends.middle.array() > bounds.max.array()).any())
    throw_no_room(ends.middle, 0.0);
  const LatticePoint middle = lattice.point(ends.middle);
  CarvedBody body = carve_body(
      context, ends.points, least_squared_radius,
      [&](const Tetrahedra& cells) { return largest_at(cells, middle); },
      [&](const Tetrahedra& cells) { return cells_at(cells, middle); });
  const Index first = largest_at(body.cells, middle).front();
  if (body.cells.is_infinite(first)) throw_no_room(ends.middle, 0.0);
  const double squared = squared_radius_of(body.cells, first);
  if (!(squared >= least_squared_radius)) throw_no_room(ends.middle, lattice.step() * std::sqrt(squared));
  return body;
}

/// Of the outside's faces, seen from there or from behind; first the smallest vertex, and in order.
std::vector<Mesh::Face> surface_of(const CarvedBody& body, bool from_behind) {
  std::vector<Mesh::Face> faces;
  for (Index at = 0; at < body.outside.size(); ++at) {
    if (body.outside[at] == 0) continue;
    const Tetrahedra::Cell& cell = body.cells.cell(at);
    for (std::size_t i = 0; i < 4; ++i) {
      if (body.outside[cell.neighbours[i]] != 0) continue;
      const auto& [x, y, z] = Tetrahedra::kFaces[i];
      Mesh::Face face{cell.vertices[x], cell.vertices[y], cell.vertices[z]};
      if (std::find(face.begin(), face.end(), body.cells.infinity()) != face.end()) continue;
      if (from_behind) std::swap(face[1], face[2]);
      std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

Mesh mesh_of(std::vector<Mesh::Face> faces, const std::vector<LatticePoint>& points, const Lattice& lattice,
             bool downwards) {
  std::vector<std::uint32_t> number(points.size(), 0);
  for (const Mesh::Face& face : faces) {
    for (const std::uint32_t vertex : face)
      number[vertex] = 1;
  }
  Mesh mesh;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (number[p] == 0) continue;
    number[p] = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(lattice.place(downwards ? upside_down(points[p]) : points[p]));
  }
  for (Mesh::Face& face : faces) {
    for (std::uint32_t& vertex : face)
      vertex = number[vertex];
  }
  mesh.faces = std::move(faces);
  return mesh;
}

}  // namespace

Wrap full_wrap(const Context& context, RaySource& source, WrapDirection direction, double curvature) {
  const EndsSurvey survey = survey_for_wrap(context, source, curvature);
  const Lattice lattice(survey.bounds);
  const bool downwards = direction == WrapDirection::downwards;
  const bool is_sheet = downwards || direction == WrapDirection::upwards;
  const LatticeEnds ends = ends_on(context, source, lattice, downwards, survey.bounds.min);
  if (Tetrahedra(ends.points).places() == 0) {
    if (!is_sheet) throw Error(ErrorCode::no_data, "all ends are in one plane, so nothing is around them");
    source.rewind();
    return wrap(context, source, direction, curvature);
  }
  const double radius = 1.0 / (curvature * lattice.step());  // infinite for 0: the convex hull
  const CarvedBody body = direction == WrapDirection::outwards
                              ? body_from_middle(context, ends, lattice, survey.bounds, radius * radius)
                              : carve_body(
                                    context, ends.points, radius * radius,
                                    [&](const Tetrahedra& cells) { return beyond_hull(cells, is_sheet); },
                                    [](const Tetrahedra&) { return Cells{}; });
  const bool from_behind = direction != WrapDirection::inwards;
  return {.mesh = mesh_of(surface_of(body, from_behind), ends.points, lattice, downwards),
          .stream = survey.stream,
          .bounded = survey.bounded};
}

}  // namespace ray
