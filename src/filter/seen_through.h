#pragma once
/// Points that rays pass closely by, on their way to something behind: what was hit there may be no thing.

#include <raycloud/spatial/voxel_key.h>

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ray {

/// Points with balls of one radius around them, and how many rays went through each of the balls.
///
/// A ray goes through if it comes nearer to the point than the radius, and its end is more than the radius
/// further on than where it does: what hits the surface on which the point lies, and what hits one beside it,
/// does not.
///
/// Memory: some 70 bytes a point.
class SeenThrough {
 public:
  /// Preconditions: radius > 0 if there are points, and there are less than 2^28.
  SeenThrough(const std::vector<Eigen::Vector3d>& points, double radius);

  /// Counts a ray. Thread-safe. It visits the bricks on its way (Amanatides and Woo 1987), and in those with
  /// points looks at each, or at groups of them where they are many.
  void add(const Eigen::Vector3d& start, const Eigen::Vector3d& end, bool bounded);

  [[nodiscard]] std::size_t size() const { return passes_.size(); }
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
  /// A ball: of a point, or around those of the nodes that follow up to `end`.
  struct Node {
    Eigen::Vector3d middle;
    double radius2;
    std::uint32_t point;  // or kIsGroup
    std::uint32_t end;    // the node after it and what is in it
  };
  struct Line {
    Eigen::Vector3d start, direction;
  };
  /// A point in a cell, and a number that is near for places near each other in its brick.
  struct Listed {
    std::uint32_t place, point;
    bool operator<(const Listed& other) const { return place < other.place; }
  };
  static constexpr std::uint32_t kIsGroup = 0xffffffff;

  void choose_cells(const Points& points);
  void list_points(const Points& points);
  void add_nodes(const Points& points, std::span<Listed> listed);
  void add_group(const Points& points, std::span<const Listed> listed);
  template <class Visit>
  void each_cell_of_ball(const Eigen::Vector3d& point, const Visit& visit) const;
  /// How many of the cells before have points.
  [[nodiscard]] std::size_t rank_of(std::size_t cell) const {
    const Occupied& occupied = occupied_[cell / 64];
    const std::uint64_t before = occupied.cells & ((std::uint64_t{1} << cell % 64) - 1);
    return occupied.before + static_cast<std::size_t>(std::popcount(before));
  }
  void visit(std::size_t cell, const Line& line, double in, double out);

  std::vector<std::uint32_t> passes_;
  double radius_;
  double width_;  // of a brick
  Cells cells_;
  std::vector<Occupied> occupied_;
  std::vector<std::uint32_t> first_node_;  // of each cell with points, and one past the last
  std::vector<Node> nodes_;
};

}  // namespace ray
