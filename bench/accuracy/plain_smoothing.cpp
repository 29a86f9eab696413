#include "plain_smoothing.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/spatial/neighbour_search.h>

#include <Eigen/Eigenvalues>
#include <limits>

namespace bench {

namespace {

Eigen::Vector3d onto_plane(ray::NeighbourSearch& search, std::size_t place) {
  const ray::PointTree& tree = search.tree();
  const Eigen::Vector3d point = tree.point(place);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double count = 1.0;
  for (const ray::Neighbour& near : search.nearest(place, 16, std::numeric_limits<double>::infinity())) {
    const Eigen::Vector3d offset = tree.point(near.place) - point;
    sum += offset;
    squares += offset * offset.transpose();
    count += 1.0;
  }
  const Eigen::Vector3d middle = sum / count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(squares / count - middle * middle.transpose());
  const Eigen::Vector3d normal = axes.eigenvectors().col(0);
  return point + normal * normal.dot(middle);
}

}  // namespace

std::vector<Eigen::Vector3d> plainly_smoothed(std::vector<Eigen::Vector3d> points) {
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<ray::SeenPoint> seen(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      seen[i].end = points[i];
    const ray::PointTree tree({}, seen);
    ray::parallel_for({}, points.size(), 1024, [&](std::size_t begin, std::size_t end) {
      ray::NeighbourSearch search(tree);
      for (std::size_t place = begin; place < end; ++place)
        points[tree.index(place)] = onto_plane(search, place);
    });
  }
  return points;
}

}  // namespace bench
