#include "ground.h"

#include "turn.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ray {
namespace {

Area box_of(const Mesh& mesh, const Mesh::Face& face) {
  const auto flat = [&](std::size_t i) { return mesh.vertices[face[i]].head<2>().eval(); };
  return {flat(0).cwiseMin(flat(1)).cwiseMin(flat(2)), flat(0).cwiseMax(flat(1)).cwiseMax(flat(2))};
}

// The height of a triangle's plane at (x, y) where the triangle covers it, borders included.
std::optional<double> height_within(const Mesh& mesh, const Mesh::Face& face, double x, double y) {
  const auto corner = [&](std::size_t i) -> const Eigen::Vector3d& { return mesh.vertices[face[i]]; };
  const auto twice_area = [](double ax, double ay, double bx, double by) { return ax * by - ay * bx; };
  const auto opposite = [&](std::size_t i) {
    const Eigen::Vector3d& a = corner((i + 1) % 3);
    const Eigen::Vector3d& b = corner((i + 2) % 3);
    return twice_area(a.x() - x, a.y() - y, b.x() - x, b.y() - y);
  };
  const double a = opposite(0);
  const double b = opposite(1);
  const double c = opposite(2);
  const double sum = a + b + c;
  const double slack = 1e-12 * std::abs(sum);
  if (sum == 0.0) return std::nullopt;  // upright
  const double sign = sum > 0 ? 1.0 : -1.0;
  if (sign * a < -slack || sign * b < -slack || sign * c < -slack) return std::nullopt;
  return (a * corner(0).z() + b * corner(1).z() + c * corner(2).z()) / sum;
}

}  // namespace

Area area_of(const Mesh& mesh) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Area area{{kFar, kFar}, {-kFar, -kFar}};
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    area.low = area.low.cwiseMin(vertex.head<2>());
    area.high = area.high.cwiseMax(vertex.head<2>());
  }
  return area;
}

Mesh height_field(const Area& area, double cell, const std::function<double(double x, double y)>& height) {
  const auto columns = static_cast<std::uint32_t>(std::ceil(area.size().x() / cell));
  const auto rows = static_cast<std::uint32_t>(std::ceil(area.size().y() / cell));
  Mesh mesh;
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i <= columns; ++i) {
      const double x = area.low.x() + area.size().x() * i / columns;
      const double y = area.low.y() + area.size().y() * j / rows;
      mesh.vertices.emplace_back(x, y, height(x, y));
    }
  }
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t low = j * (columns + 1) + i;
      const std::uint32_t high = low + columns + 1;
      mesh.faces.push_back({low, low + 1, high + 1});
      mesh.faces.push_back({low, high + 1, high});
    }
  }
  return mesh;
}

Ground::Ground(const Mesh& mesh) : mesh_(&mesh), area_(area_of(mesh)) {
  const Eigen::Vector2d size = area_.size().cwiseMax(1e-9);
  cell_ = std::max(std::sqrt(2 * size.x() * size.y() / static_cast<double>(mesh.faces.size())),
                   size.maxCoeff() / 4096);
  columns_ = static_cast<std::size_t>(size.x() / cell_) + 1;
  rows_ = static_cast<std::size_t>(size.y() / cell_) + 1;
  begins_.assign(columns_ * rows_ + 1, 0);
  const auto for_cells = [&](const Mesh::Face& face, const auto& body) {
    const Area box = box_of(mesh, face);
    for (std::size_t j = row_of(box.low.y()); j <= row_of(box.high.y()); ++j) {
      for (std::size_t i = column_of(box.low.x()); i <= column_of(box.high.x()); ++i)
        body(j * columns_ + i);
    }
  };
  for (const Mesh::Face& face : mesh.faces)
    for_cells(face, [&](std::size_t cell) { ++begins_[cell + 1]; });
  for (std::size_t cell = 1; cell < begins_.size(); ++cell)
    begins_[cell] += begins_[cell - 1];
  faces_.resize(begins_.back());
  std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    for_cells(mesh.faces[face],
              [&](std::size_t cell) { faces_[next[cell]++] = static_cast<std::uint32_t>(face); });
  }
}

std::size_t Ground::column_of(double x) const {
  const double place = (x - area_.low.x()) / cell_;
  return place <= 0 ? 0 : std::min(static_cast<std::size_t>(place), columns_ - 1);
}

std::size_t Ground::row_of(double y) const {
  const double place = (y - area_.low.y()) / cell_;
  return place <= 0 ? 0 : std::min(static_cast<std::size_t>(place), rows_ - 1);
}

std::optional<double> Ground::find(double x, double y) const {
  const std::size_t cell = row_of(y) * columns_ + column_of(x);
  std::optional<double> highest;
  for (std::size_t i = begins_[cell]; i < begins_[cell + 1]; ++i) {
    const std::optional<double> height = height_within(*mesh_, mesh_->faces[faces_[i]], x, y);
    if (height && (!highest || *height > *highest)) highest = height;
  }
  return highest;
}

double Ground::lowest_around(double x, double y, double radius) const {
  double lowest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector2d place = Eigen::Vector2d(x, y) + radius * turned(i / 8.0);
    lowest = std::min(lowest, find(place.x(), place.y()).value_or(lowest));
  }
  return lowest;
}

}  // namespace ray
