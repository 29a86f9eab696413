#include <raycloud/spatial/point_sample.h>

#include <algorithm>
#include <bit>
#include <cassert>

namespace ray {

bool PointSample::chosen(const Eigen::Vector3d& point, int level) {
  if (level == 0) return true;
  std::uint64_t hash = std::bit_cast<std::uint64_t>(point.x()) * 0x9e3779b97f4a7c15U;
  hash = (hash ^ (hash >> 32) ^ std::bit_cast<std::uint64_t>(point.y())) * 0xbf58476d1ce4e5b9U;
  hash = (hash ^ (hash >> 32) ^ std::bit_cast<std::uint64_t>(point.z())) * 0x94d049bb133111ebU;
  hash = (hash ^ (hash >> 32)) * 0x9e3779b97f4a7c15U;
  return hash >> (64 - level) == 0;
}

std::vector<Eigen::Vector3d> PointSample::candidates(std::span<const Eigen::Vector3d> points,
                                                     std::span<const std::uint8_t> mask) const {
  assert(points.size() == mask.size());
  const int level = level_.load(std::memory_order_relaxed);
  std::vector<Eigen::Vector3d> result;
  for (std::size_t i = 0; i < points.size(); i++) {
    if (mask[i] != 0 && chosen(points[i], level)) result.push_back(points[i]);
  }
  return result;
}

void PointSample::add(std::span<const Eigen::Vector3d> candidates) {
  int level = level_.load(std::memory_order_relaxed);
  for (const Eigen::Vector3d& point : candidates) {
    if (chosen(point, level)) points_.push_back(point);
    while (points_.size() > capacity_ && level < 64) {
      level++;
      std::erase_if(points_, [&](const Eigen::Vector3d& p) { return !chosen(p, level); });
    }
  }
  level_.store(level, std::memory_order_relaxed);
}

}  // namespace ray
