#include "judgement_cells.h"

#include "cloud_ellipsoids.h"
#include "mix_bits.h"
#include "transient_regions.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/spatial/surfel.h>

#include <algorithm>
#include <cmath>
#include <mutex>

namespace ray {

JudgementCells::JudgementCells(double reach) : reach_(reach) {
  constexpr double kShareOfReach = 0.25, kLeast = 0.001;  // m
  width_ = std::max(kLeast, kShareOfReach * reach);
}

std::size_t JudgementCells::Hash::operator()(const Key& key) const {
  std::uint64_t hash = 0;
  for (const std::int64_t at : key)
    hash = mix_bits(hash + static_cast<std::uint64_t>(at));
  return hash;
}

JudgementCells::Key JudgementCells::key_of(const Eigen::Vector3d& point) const {
  Key key;
  for (std::size_t axis = 0; axis < 3; ++axis)
    key[axis] = static_cast<std::int64_t>(std::floor(point[static_cast<Eigen::Index>(axis)] / width_));
  return key;
}

void JudgementCells::add(const Context& context, const PointTree& points, std::span<const std::uint8_t> own,
                         std::size_t part) {
  const SurfelRule rule = ellipsoid_rule(reach_);
  std::mutex mutex;
  parallel_for(context, points.size(), 4096, [&](std::size_t begin, std::size_t end) {
    NeighbourSearch search(points);
    std::unordered_map<Key, Cell, Hash> found;
    for (std::size_t place = begin; place < end; ++place) {
      if (own[points.index(place)] == 0) continue;
      Cell& cell = found[key_of(points.point(place))];
      const Surfel surfel = surfel_at(search, place, rule);
      cell.neighbours =
          std::max(cell.neighbours, surfel.count <= rule.neighbours ? reach_ : std::sqrt(surfel.reach2));
      cell.semi = std::max(cell.semi, semi_axis_of(surfel));
      cell.shift = std::max(cell.shift, (surfel.centroid - points.point(place)).norm());
    }
    const std::lock_guard lock(mutex);
    for (const auto& [key, cell] : found) {
      const auto [at, is_new] = numbers_.try_emplace(key, static_cast<std::uint32_t>(cells_.size()));
      if (is_new) cells_.emplace_back().key = key;
      Cell& known = cells_[at->second];
      known.semi = std::max(known.semi, cell.semi);
      known.shift = std::max(known.shift, cell.shift);
      known.neighbours = std::max(known.neighbours, cell.neighbours);
      const auto number = static_cast<std::uint32_t>(part);
      if (known.own_parts.empty() || known.own_parts.back() != number) known.own_parts.push_back(number);
    }
  });
}

std::vector<std::uint32_t> JudgementCells::cells_within(std::uint32_t cell, double distance) const {
  const Key& from = cells_[cell].key;
  const double cubes = std::floor(distance / width_) + 1.0;
  std::vector<std::uint32_t> found;
  const auto add_if_near = [&](const Key& key, std::uint32_t number) {
    double gap2 = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double gap = std::max(0.0, std::abs(static_cast<double>(key[axis] - from[axis])) - 1.0) * width_;
      gap2 += gap * gap;
    }
    if (gap2 <= distance * distance) found.push_back(number);
  };
  if (std::pow(2.0 * cubes + 1.0, 3.0) > static_cast<double>(cells_.size())) {
    for (std::uint32_t i = 0; i < cells_.size(); ++i)
      add_if_near(cells_[i].key, i);
    return found;
  }
  const auto steps = static_cast<std::int64_t>(cubes);
  for (std::int64_t x = -steps; x <= steps; ++x)
    for (std::int64_t y = -steps; y <= steps; ++y)
      for (std::int64_t z = -steps; z <= steps; ++z) {
        const auto at = numbers_.find(Key{from[0] + x, from[1] + y, from[2] + z});
        if (at != numbers_.end()) add_if_near(at->first, at->second);
      }
  return found;
}

void JudgementCells::find_parts(double range_noise) {
  constexpr double kRounding = 1.01, kThinnest = 0.003;  // m
  // Of two ends whose ellipsoids hold one another's centres, the one with the larger sum of semi-axis and
  // shift is at most twice that away from the other.
  std::vector<std::vector<std::uint32_t>> overlapping(cells_.size()), neighbours(cells_.size());
  for (std::uint32_t i = 0; i < cells_.size(); ++i) {
    const Cell& cell = cells_[i];
    const double hop = kRounding * (std::hypot(cell.semi, range_noise) + cell.shift) + kThinnest;
    for (const std::uint32_t other : cells_within(i, 2.0 * hop)) {
      overlapping[i].push_back(other);
      overlapping[other].push_back(i);
    }
    neighbours[i] = cells_within(i, kRounding * cell.neighbours);
  }
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> of_parts;
  for (std::uint32_t i = 0; i < cells_.size(); ++i)
    for (const std::uint32_t part : cells_[i].own_parts)
      of_parts[part].push_back(i);
  std::vector<std::uint32_t> seen(cells_.size(), ~std::uint32_t{0});
  for (auto& of_part : of_parts) {
    const std::uint32_t part = of_part.first;
    std::vector<std::uint32_t>& region = of_part.second;
    const auto reach_from = [&](std::size_t begin, std::size_t end, const auto& edges) {
      for (std::size_t at = begin; at < end; ++at)
        for (const std::uint32_t other : edges[region[at]])
          if (std::exchange(seen[other], part) != part) region.push_back(other);
    };
    for (const std::uint32_t cell : region)
      seen[cell] = part;
    std::size_t begin = 0;
    for (int step = 0; step < kRegionSteps; ++step) {
      const std::size_t end = region.size();
      reach_from(begin, end, overlapping);
      begin = end;
    }
    reach_from(0, region.size(), neighbours);
    for (const std::uint32_t cell : region)
      cells_[cell].parts.push_back(part);
  }
}

std::span<const std::uint32_t> JudgementCells::parts_for(const Eigen::Vector3d& end) const {
  return cells_[numbers_.at(key_of(end))].parts;
}

}  // namespace ray
