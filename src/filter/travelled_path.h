#pragma once
/// The path of the sensor, from the starts of rays in any order of time.

#include <Eigen/Core>
#include <limits>
#include <map>

namespace ray {

/// Holds the start of the earliest ray of every time slot that has one, and of the latest ray of all. Slots
/// are a tenth of a second wide, doubled until there are at most 2^16. What it holds depends on the rays in
/// order of the file, not on how they were parted into paths that were then appended.
class TravelledPath {
 public:
  TravelledPath() = default;
  TravelledPath(TravelledPath&&) = default;
  TravelledPath& operator=(TravelledPath&&) = default;

  void add(double time, const Eigen::Vector3d& position) {
    const double slot = time / width_;
    if (slot >= slot_ && slot < slot_ + 1.0) {  // the slot of the ray before, nearly always
      if (time < current_->time) *current_ = {time, position};
    } else {
      add_to_slot({time, position});
    }
    if (time > latest_.time) latest_ = {time, position};
  }
  /// `later` holds rays that come later in the file.
  void append(const TravelledPath& later);
  /// Metres along the polyline through the nodes in order of time.
  [[nodiscard]] double length() const;

 private:
  struct Node {
    double time = -std::numeric_limits<double>::infinity();
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
  };

  void add_to_slot(const Node& node);
  void set_width(double width);

  double width_ = 0.1;
  std::map<double, Node> nodes_;  // by floor(time / width_)
  double slot_ = std::numeric_limits<double>::quiet_NaN();
  Node* current_ = nullptr;  // the node of slot_
  Node latest_;
};

}  // namespace ray
