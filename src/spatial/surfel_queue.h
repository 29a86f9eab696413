#pragma once
/// Surfels of points and their neighbours, several at once.

#include <raycloud/spatial/neighbourhood.h>
#include <raycloud/spatial/surfel.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

namespace ray {

/// Collects the moments of neighbours, and makes surfels of four or eight at a time. A surfel is the same to
/// the last bit, whichever others it is made with.
class SurfelQueue {
 public:
  static constexpr std::size_t kMost = 16;

  explicit SurfelQueue(const PointTree& tree) : tree_(tree) {}

  /// `surfel` will be that of the point and some of its neighbours when the queue is next made.
  void add(const Neighbourhood& around, Neighbourhood::Some some, Surfel& surfel);
  void make();

 private:
  struct Waiting {
    Neighbourhood::Moments moments;
    Eigen::Vector3d to_sensor;
    Surfel* surfel;
  };
  template <class Value>
  static void make_some(std::span<const Waiting> some);
  static void finish(Surfel& surfel, const Eigen::Vector3d& to_sensor);

  const PointTree& tree_;
  std::array<Waiting, kMost> waiting_;
  std::size_t count_ = 0;
};

}  // namespace ray
