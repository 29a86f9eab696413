#pragma once
/// Finding a way through a scene, and walking it.

#include "ground.h"

#include <raycloud/core/trajectory.h>

#include <functional>
#include <limits>
#include <vector>

namespace ray {

struct WalkOptions {
  double cell = 0.5;                                          ///< m, of the map
  double clearance = 0.6;                                     ///< m, from the middle of a person to anything
  double comfort = 1.5;                                       ///< m, within which nearness makes a way longer
  double step = 0.25;                                         ///< m, what a person steps over
  double body = 2.3;                                          ///< m, up to where things are in the way
  double smoothing = 1.5;                                     ///< m, how early a corner is cut
  double steepest = std::numeric_limits<double>::infinity();  ///< slope of the floor that can be walked
};

/// A floor seen from above, with what stands on it.
class WalkMap {
 public:
  /// `floor` gives the height of the floor; nothing where there is none.
  using Floor = std::function<std::optional<double>(double x, double y)>;
  WalkMap(const Area& area, Floor floor, const WalkOptions& options);

  /// Everything of the mesh between a step and a body's height above the floor is in the way.
  void add_obstacle(const Mesh& mesh);

  /// The way past the goals in turn, on the floor, as points less than half a cell apart; a goal that can't
  /// be reached is left out, one that is not free is moved to the nearest free place. Shortest where ways
  /// near obstacles count as longer (Dijkstra on the cells, equal ways told apart by cell number), then
  /// smoothed. Points keep the clearance, less a cell. Empty if nothing is free.
  [[nodiscard]] std::vector<Eigen::Vector3d> route(const std::vector<Eigen::Vector2d>& goals);

 private:
  using Cell = std::size_t;
  [[nodiscard]] Cell cell_of(const Eigen::Vector2d& place) const;
  [[nodiscard]] Eigen::Vector2d middle_of(Cell cell) const;
  [[nodiscard]] bool is_inside(const Eigen::Vector2d& place) const;
  void block_slopes();
  void sample(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);
  void measure_clearance();
  void keep_largest_part();
  template <class Body>
  void for_neighbours(Cell cell, const Body& body) const;
  [[nodiscard]] bool is_free(Cell cell) const;
  [[nodiscard]] std::optional<Cell> nearest_free(const Eigen::Vector2d& place) const;
  [[nodiscard]] std::vector<Cell> shortest(Cell from, Cell to) const;
  [[nodiscard]] std::vector<Eigen::Vector2d> smoothed(const std::vector<Eigen::Vector2d>& way) const;

  Area area_;
  Floor floor_;
  WalkOptions options_;
  std::size_t columns_;
  std::size_t rows_;
  double highest_floor_ = -std::numeric_limits<double>::infinity();
  std::vector<std::uint8_t> blocked_;
  std::vector<double> nearest_obstacle_;  ///< m, up to `comfort`
};

struct Walk {
  double head = 1.4;   ///< m above the way
  double speed = 1.0;  ///< m/s
};
/// The way at even speed: nodes every 0.1 s, the head upright and turned to where the way goes (as seen half
/// a metre behind and ahead). Precondition: the way has a length.
[[nodiscard]] Trajectory walked(const std::vector<Eigen::Vector3d>& way, const Walk& walk);

/// `count` places evenly along the way, `height` m above it, not its ends.
[[nodiscard]] std::vector<Eigen::Vector3d> stations_along(const std::vector<Eigen::Vector3d>& way,
                                                          std::size_t count, double height);

}  // namespace ray
