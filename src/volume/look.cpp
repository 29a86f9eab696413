#include "look.h"

#include "mix_bits.h"

#include <cmath>

namespace ray {

std::uint16_t look_of(double time, const Eigen::Vector3d& way, double look_time) {
  const double most = way.cwiseAbs().maxCoeff();
  const Eigen::Vector3d side = most > 0.0 ? Eigen::Vector3d(way / most) : way;
  const auto third = [](double v) { return std::uint64_t{v > 0.5 ? 2U : v < -0.5 ? 0U : 1U}; };
  const auto when = static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(time / look_time)));
  const std::uint64_t hash = when * 27 + third(side.x()) + 3 * third(side.y()) + 9 * third(side.z());
  return static_cast<std::uint16_t>(1U << (mix_bits(hash) >> 60));
}

}  // namespace ray
