#pragma once
/// Points that rays pass closely by, on their way to something behind: what was hit there may be no thing.

#include <raycloud/spatial/voxel_key.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace ray {

/// Points with balls of one radius around them, and how many rays went through each of the balls.
///
/// A ray goes through if it comes nearer to the point than the radius, and its end is more than the radius
/// further on than where it does: what hits the surface on which the point lies, and what hits one beside it,
/// does not.
///
/// Exact by the coordinates as doubles, up to 10^12 radii from the origin; of a ray that is longer than some
/// 10^7 radii, the beginning counts. A tenth to half a µs a ray. Memory: some 90 bytes a point where they are
/// dense, 200 where each is alone.
class SeenThrough {
 public:
  /// Preconditions: radius > 0 if there are points, and there are less than 2^28.
  SeenThrough(std::vector<Eigen::Vector3d> points, double radius);

  /// Counts a ray. Thread-safe; the order of the rays changes nothing. It visits the bricks on its way
  /// (Amanatides and Woo 1987), and in those with points looks at each, or at groups of them where they are
  /// many.
  void add(const Eigen::Vector3d& start, const Eigen::Vector3d& end, bool bounded);

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  /// How many of the rays went through the ball of a point.
  [[nodiscard]] std::uint32_t passes(std::size_t point) const { return passes_[point]; }

 private:
  using Points = std::vector<Eigen::Vector3d>;

  /// Space is cut into bricks, and these lie in a box of cells that is repeated again and again. Bricks that
  /// share a cell are so far apart that no ball touches both, and the distance tells their points apart.
  struct Cells {
    std::array<std::uint32_t, 3> shift{}, mask{};  // of the number of a brick along each axis
    [[nodiscard]] std::uint32_t along(std::size_t axis, std::int64_t brick) const {
      return static_cast<std::uint32_t>(static_cast<std::uint64_t>(brick) << shift[axis]) & mask[axis];
    }
    [[nodiscard]] std::size_t count() const { return std::size_t{mask[0] | mask[1] | mask[2]} + 1; }
  };
  /// For 64 cells, which of them have points, and how many have in all before.
  struct Occupied {
    std::uint64_t cells = 0;
    std::uint32_t before = 0;
  };
  /// Balls of eight points, or around those of eight groups of points. They are looked at together, in single
  /// precision, so a little larger than they are, and by their offset from the middle of the brick.
  struct Eight {
    using Floats = std::array<float, 8>;
    alignas(32) Floats x{}, y{}, z{};          // radii
    Floats reach2{-1.0F, -1.0F, -1.0F, -1.0F,  // squared radii; below 0 where there is none
                  -1.0F, -1.0F, -1.0F, -1.0F};
    std::array<std::uint32_t, 8> which{};  // points, or the Eight of each group

    void set(std::size_t k, const Eigen::Vector3f& middle, float most2, std::uint32_t what) {
      x[k] = middle.x(), y[k] = middle.y(), z[k] = middle.z();
      reach2[k] = most2;
      which[k] = what;
    }
  };
  /// Of a cell.
  struct List {
    std::uint32_t begin, end;  // in eights_
    bool is_of_groups;
  };
  struct Line {
    Eigen::Vector3d start, direction;
  };
  /// Of a line, the way through a brick.
  struct Way {
    double in, out;               // m, from the start
    Eigen::Vector3f from, along;  // radii, from the middle of the brick; a unit vector
  };
  struct Listed {
    Eigen::Vector3f offset;  // radii
    std::uint32_t point;
  };

  void choose_cells();
  void list_points();
  void add_list(std::span<Listed> listed);
  void add_points(std::span<const Listed> listed);
  template <class Visit>
  void each_cell_of_ball(const Eigen::Vector3d& point, const Visit& visit) const;
  /// How many of the cells before have points.
  [[nodiscard]] std::size_t rank_of(std::size_t cell) const {
    const Occupied& occupied = occupied_[cell / 64];
    const std::uint64_t before = occupied.cells & ((std::uint64_t{1} << cell % 64) - 1);
    return occupied.before + static_cast<std::size_t>(std::popcount(before));
  }
  void visit(std::size_t cell, const Line& line, const Way& way);
  struct Kernels;
  [[nodiscard]] std::pair<double, double> inside_box(const Line& line) const;

  Points points_;
  std::vector<std::uint32_t> passes_;
  Eigen::AlignedBox3d box_;  // of all balls: rays are followed only there
  double radius_;
  double width_;  // of a brick
  Cells cells_;
  std::vector<Occupied> occupied_;
  std::vector<List> lists_;  // of each cell with points
  std::vector<Eight> eights_;
};

}  // namespace ray
