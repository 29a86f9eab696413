#include "reach.h"

#include "carving.h"

#include <raycloud/exec/parallel.h>

#include <algorithm>

namespace ray {

using Index = Tetrahedra::Index;

Reach::Reach(const Context& context, const Tetrahedra& cells, double least_squared_radius)
    : cells_(cells), least_squared_radius_(least_squared_radius), states_(cells.places(), State::small) {
  parallel_for(context, states_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t at = begin; at < end; ++at)
      states_[at] = state_of(static_cast<Index>(at));
  });
}

Reach::State Reach::state_of(Index at) const {
  if (!cells_.is_alive(at) || cells_.is_infinite(at)) return State::small;
  return squared_radius_of(cells_, at) >= least_squared_radius_ ? State::large : State::small;
}

void Reach::extend(std::span<const Index> first) {
  for (const Index at : first) {
    if (states_[at] == State::reached) continue;
    states_[at] = State::reached;
    front_.push_back(at);
  }
  spread();
}

void Reach::renew(std::span<const Index> places) {
  states_.resize(cells_.places(), State::small);
  for (const Index at : places)
    states_[at] = state_of(at);
  for (const Index at : places) {
    if (states_[at] != State::large) continue;
    const auto& neighbours = cells_.cell(at).neighbours;
    if (std::none_of(neighbours.begin(), neighbours.end(),
                     [&](Index other) { return states_[other] == State::reached; }))
      continue;
    states_[at] = State::reached;
    front_.push_back(at);
  }
  spread();
}

void Reach::spread() {
  while (!front_.empty()) {
    const Index at = front_.back();
    front_.pop_back();
    for (const Index other : cells_.cell(at).neighbours) {
      if (states_[other] != State::large) continue;
      states_[other] = State::reached;
      front_.push_back(other);
    }
  }
}

std::vector<std::uint8_t> Reach::with_neighbours() const {
  std::vector<std::uint8_t> marks(states_.size(), 0);
  for (Index at = 0; at < states_.size(); ++at) {
    if (states_[at] != State::reached) continue;
    marks[at] = 1;
    for (const Index other : cells_.cell(at).neighbours)
      marks[other] = 1;
  }
  return marks;
}

}  // namespace ray
