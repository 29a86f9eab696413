#pragma once
/// How far a ball gets among tetrahedra, from those that it begins in.

#include "tetrahedra.h"

#include <raycloud/exec/context.h>

#include <cstdint>
#include <span>
#include <vector>

namespace ray {

/// Cells whose spheres have at least a given radius, and that one comes to through faces of such: what a
/// carving (`carving.h`) takes is among them, as it may not take all. About 0.1 µs a cell, times the threads.
class Reach {
 public:
  /// Squared, in steps. The cells stay.
  Reach(const Context& context, const Tetrahedra& cells, double least_squared_radius);

  /// From these on, whatever their radius.
  void extend(std::span<const Tetrahedra::Index> first);
  /// Tells that other cells, or none, have come to these places. Those that are reached stay so.
  void renew(std::span<const Tetrahedra::Index> places);

  /// The cells that are reached and their neighbours, by place: those that decide where a carving ends.
  [[nodiscard]] std::vector<std::uint8_t> with_neighbours() const;

 private:
  enum class State : std::uint8_t { small, large, reached };
  [[nodiscard]] State state_of(Tetrahedra::Index at) const;
  void spread();

  const Tetrahedra& cells_;
  double least_squared_radius_;
  std::vector<State> states_;
  std::vector<Tetrahedra::Index> front_;
};

}  // namespace ray
