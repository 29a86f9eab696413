#include "range_edges.h"

#include <raycloud/core/bounds.h>
#include <raycloud/exec/parallel.h>
#include <raycloud/spatial/neighbour_search.h>

#include <Eigen/Eigenvalues>
#include <cmath>

namespace ray {
namespace {

constexpr std::size_t kBeside = 8;    // neighbours that are compared
constexpr double kStill = 0.1;        // m; a sensor that moves less saw all from one place
constexpr double kLeastSlant = 0.05;  // rad
constexpr std::size_t kBeamsAtOnce = 1 << 12;

/// Where the neighbours are looked for: directions from the place of the sensor, or the ends themselves.
std::vector<SeenPoint> places_of(const Beams& beams) {
  Bounds starts;
  for (const Eigen::Vector3d& start : beams.starts)
    starts.add(start);
  const bool still = !starts.empty() && starts.extent().maxCoeff() <= kStill;
  std::vector<SeenPoint> places(beams.size());
  for (std::size_t i = 0; i < beams.size(); ++i)
    places[i].end =
        still ? Eigen::Vector3d((beams.ends[i] - beams.starts[i]).stableNormalized()) : beams.ends[i];
  return places;
}

/// Whether the end of a beam lies in the plane of the others, or on their line: a slanted surface. A plane or
/// line along the beam is none: it goes from one surface to the other.
bool on_slant(const std::vector<Eigen::Vector3d>& others, const Eigen::Vector3d& start,
              const Eigen::Vector3d& end, double distance) {
  const auto count = static_cast<double>(others.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  // from the end
  for (const Eigen::Vector3d& other : others)
    mean += (other - end) / count;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& other : others)
    spread += (other - end - mean) * (other - end - mean).transpose() / count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  const Eigen::Vector3d beam = (end - start).normalized();
  const Eigen::Vector3d normal = axes.eigenvectors().col(0), along = axes.eigenvectors().col(2);
  const double thin2 = distance * distance;
  const bool plane = axes.eigenvalues()[0] <= thin2 && std::abs(normal.dot(mean)) <= distance &&
                     std::abs(normal.dot(beam)) >= kLeastSlant;
  const bool line = axes.eigenvalues()[1] <= thin2 && along.cross(mean).norm() <= distance &&
                    along.cross(beam).norm() >= kLeastSlant;
  return plane || line;
}

bool between_others(const std::vector<Eigen::Vector3d>& others, const Eigen::Vector3d& start,
                    const Eigen::Vector3d& end, double distance) {
  const double range = (end - start).norm();
  bool nearer = false, further = false;
  for (const Eigen::Vector3d& other : others) {
    const double difference = (other - start).norm() - range;
    if (std::abs(difference) <= distance) return false;
    (difference < 0.0 ? nearer : further) = true;
  }
  return nearer && further && !on_slant(others, start, end, distance);
}

}  // namespace

std::vector<std::uint8_t> mixed_in_space(const Context& context, const Beams& beams, double distance) {
  const PointTree tree(context, places_of(beams));
  std::vector<std::uint8_t> mixed(beams.size());
  parallel_for(context, tree.size(), kBeamsAtOnce, [&](std::size_t begin, std::size_t end) {
    NeighbourSearch search(tree);
    std::vector<Eigen::Vector3d> others;
    for (std::size_t place = begin; place < end; ++place) {
      const std::uint32_t i = tree.index(place);
      others.clear();
      for (const Neighbour& near : search.nearest(place, kBeside, std::numeric_limits<double>::infinity()))
        others.push_back(beams.ends[tree.index(near.place)]);
      mixed[i] = between_others(others, beams.starts[i], beams.ends[i], distance) ? 1 : 0;
    }
  });
  return mixed;
}

}  // namespace ray
