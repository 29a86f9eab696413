#include "plate.h"

#include "turn.h"

#include <algorithm>
#include <map>

namespace ray {
namespace {

using Cuts = std::vector<double>;

Cuts sorted_cuts(double end, const std::vector<Opening>& openings, double Opening::*low,
                 double Opening::*high) {
  Cuts cuts{0.0, end};
  for (const Opening& opening : openings) {
    cuts.push_back(opening.*low);
    cuts.push_back(opening.*high);
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  return cuts;
}

// The plate as cells between cuts, each solid or open.
class PlateCells {
 public:
  explicit PlateCells(const Plate& plate)
      : plate_(plate),
        across_(plate.along.cross(plate.up)),
        columns_(sorted_cuts(plate.width, plate.openings, &Opening::left, &Opening::right)),
        rows_(sorted_cuts(plate.height, plate.openings, &Opening::bottom, &Opening::top)) {}

  Mesh mesh() {
    for (std::size_t i = 0; i + 1 < columns_.size(); ++i) {
      for (std::size_t j = 0; j + 1 < rows_.size(); ++j) {
        if (is_solid(i, j)) add_cell(i, j);
      }
    }
    return std::move(mesh_);
  }

 private:
  // Numbers before the first cell wrap around and are open too.
  bool is_solid(std::size_t i, std::size_t j) const {
    if (i >= columns_.size() - 1 || j >= rows_.size() - 1) return false;
    const double x = (columns_[i] + columns_[i + 1]) / 2;
    const double y = (rows_[j] + rows_[j + 1]) / 2;
    return std::none_of(plate_.openings.begin(), plate_.openings.end(), [&](const Opening& opening) {
      return x > opening.left && x < opening.right && y > opening.bottom && y < opening.top;
    });
  }

  std::uint32_t vertex(std::size_t i, std::size_t j, std::size_t side) {
    const std::size_t key = (i * rows_.size() + j) * 2 + side;
    const auto [place, added] = vertices_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (added) {
      mesh_.vertices.push_back(plate_.corner + columns_[i] * plate_.along + rows_[j] * plate_.up +
                               (side == 1 ? plate_.thickness : 0.0) * across_);
    }
    return place->second;
  }

  // Braces, since they evaluate in order and so number the vertices alike for every compiler.
  struct Quad {
    std::uint32_t a, b, c, d;
  };
  void add(const Quad& quad) {
    mesh_.faces.push_back({quad.a, quad.b, quad.c});
    mesh_.faces.push_back({quad.a, quad.c, quad.d});
  }

  void rim(std::size_t i, std::size_t j, std::size_t next_i, std::size_t next_j) {
    add({vertex(i, j, 0), vertex(next_i, next_j, 0), vertex(next_i, next_j, 1), vertex(i, j, 1)});
  }

  void add_cell(std::size_t i, std::size_t j) {
    add({vertex(i, j, 1), vertex(i + 1, j, 1), vertex(i + 1, j + 1, 1), vertex(i, j + 1, 1)});
    add({vertex(i, j + 1, 0), vertex(i + 1, j + 1, 0), vertex(i + 1, j, 0), vertex(i, j, 0)});
    if (!is_solid(i, j - 1)) rim(i, j, i + 1, j);
    if (!is_solid(i + 1, j)) rim(i + 1, j, i + 1, j + 1);
    if (!is_solid(i, j + 1)) rim(i + 1, j + 1, i, j + 1);
    if (!is_solid(i - 1, j)) rim(i, j + 1, i, j);
  }

  const Plate& plate_;
  Eigen::Vector3d across_;
  Cuts columns_;
  Cuts rows_;
  std::map<std::size_t, std::uint32_t> vertices_;
  Mesh mesh_;
};

// x along the wall, y to the left of the way, z up, origin at the wall's start.
Pose frame_of(const Wall& wall) {
  const Eigen::Vector3d along = (wall.to - wall.from).normalized();
  Pose pose;
  pose.rotation.col(0) = along;
  pose.rotation.col(1) = Eigen::Vector3d::UnitZ().cross(along);
  pose.rotation.col(2) = Eigen::Vector3d::UnitZ();
  pose.translation = wall.from;
  return pose;
}

}  // namespace

Mesh plate_mesh(const Plate& plate) {
  return PlateCells(plate).mesh();
}

Plate plate_of(const Wall& wall) {
  const Eigen::Vector3d along = (wall.to - wall.from).normalized();
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(along);
  return {.corner = wall.from + wall.thickness / 2 * left,
          .along = along,
          .up = Eigen::Vector3d::UnitZ(),
          .width = (wall.to - wall.from).norm(),
          .height = wall.height,
          .thickness = wall.thickness,
          .openings = wall.openings};
}

Mesh window_mesh(const Wall& wall, const Opening& opening) {
  constexpr double kBar = 0.06;
  MeshBuilder builder;
  builder.set_pose(frame_of(wall));
  const auto bar = [&](double left, double right, double bottom, double top) {
    builder.box({left, -kBar / 2, bottom}, {right, kBar / 2, top});
  };
  const double middle = (opening.left + opening.right) / 2;
  const double rail = opening.bottom + 0.7 * (opening.top - opening.bottom);
  bar(opening.left, opening.right, opening.bottom, opening.bottom + kBar);
  bar(opening.left, opening.right, opening.top - kBar, opening.top);
  bar(opening.left, opening.left + kBar, opening.bottom + kBar, opening.top - kBar);
  bar(opening.right - kBar, opening.right, opening.bottom + kBar, opening.top - kBar);
  bar(middle - kBar / 2, middle + kBar / 2, opening.bottom + kBar, opening.top - kBar);
  bar(opening.left + kBar, middle - kBar / 2, rail, rail + kBar);
  bar(middle + kBar / 2, opening.right - kBar, rail, rail + kBar);
  return builder.take();
}

Mesh door_mesh(const Wall& wall, const Opening& opening, Hinge hinge, double turns) {
  constexpr double kThickness = 0.04;
  const double side = hinge == Hinge::left ? 1.0 : -1.0;
  const double edge = hinge == Hinge::left ? opening.left + 0.01 : opening.right - 0.01;
  const double towards = turns > 0 ? 1.0 : -1.0;
  const Pose frame = frame_of(wall);
  Pose swing =
      placed({edge, towards * (wall.thickness / 2 + kThickness / 2), opening.bottom + 0.01}, side * turns);
  swing.translation = frame * swing.translation;
  swing.rotation = frame.rotation * swing.rotation;
  const double width = opening.right - opening.left - 0.03;
  MeshBuilder builder;
  builder.set_pose(swing);
  builder.box({side > 0 ? 0.0 : -width, -kThickness / 2, 0.0},
              {side > 0 ? width : 0.0, kThickness / 2, opening.top - opening.bottom - 0.02});
  const double knob = side * (width - 0.08);
  builder.box({knob - 0.05, -0.06, 1.0}, {knob + 0.05, 0.06, 1.03});
  return builder.take();
}

}  // namespace ray
