#include "travelled_path.h"

#include <cmath>
#include <utility>

namespace ray {

void TravelledPath::add_to_slot(const Node& node) {
  constexpr std::size_t kMostNodes = std::size_t{1} << 16;
  slot_ = std::floor(node.time / width_);
  const auto [at, is_new] = nodes_.try_emplace(slot_, node);
  if (node.time < at->second.time) at->second = node;
  current_ = &at->second;
  while (nodes_.size() > kMostNodes)
    set_width(2.0 * width_);
}

/// Doubling is exact, so a slot is always the union of two narrower ones.
void TravelledPath::set_width(double width) {
  const std::map<double, Node> narrow = std::exchange(nodes_, {});
  width_ = width;
  for (const auto& [slot, node] : narrow)
    nodes_.try_emplace(nodes_.end(), std::floor(node.time / width_), node);
  slot_ = std::numeric_limits<double>::quiet_NaN();
}

void TravelledPath::append(const TravelledPath& later) {
  if (later.width_ > width_) set_width(later.width_);
  for (const auto& [slot, node] : later.nodes_)
    add_to_slot(node);
  if (later.latest_.time > latest_.time) latest_ = later.latest_;
}

double TravelledPath::length() const {
  if (nodes_.empty()) return 0.0;
  double sum = 0.0;
  const Node* before = &nodes_.begin()->second;
  for (const auto& [slot, node] : nodes_) {
    sum += (node.position - before->position).norm();
    before = &node;
  }
  return sum + (latest_.position - before->position).norm();
}

}  // namespace ray
