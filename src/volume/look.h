#pragma once
/// A look: passes of one time from about one direction, which are one observation.

#include <Eigen/Core>
#include <atomic>
#include <cstdint>

namespace ray {

/// The bit, of 16, of a look: a piece of time, `look_time` seconds long, and one of 26 directions.
[[nodiscard]] std::uint16_t look_of(double time, const Eigen::Vector3d& way, double look_time);

/// Thread-safe.
inline void add_look(std::uint16_t& looks, std::uint16_t look) {
  const std::atomic_ref<std::uint16_t> atomic(looks);
  if ((atomic.load(std::memory_order_relaxed) & look) == 0) atomic.fetch_or(look, std::memory_order_relaxed);
}

}  // namespace ray
