#include <raycloud/exec/block_cuts.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace ray::blocks {
namespace {

/// Records of the largest block with what lies around it.
double largest_of(const SpaceCuts& cuts, const EndSample& sample, double reach) {
  std::vector<std::uint32_t> counts(cuts.parts(), 0), near;
  for (const Eigen::Vector3d& end : sample.ends) {
    cuts.parts_near(end, reach, near);
    for (const std::uint32_t part : near)
      ++counts[part];
  }
  if (sample.ends.empty()) return 0.0;
  const double most = *std::max_element(counts.begin(), counts.end());
  return most / static_cast<double>(sample.ends.size()) * static_cast<double>(sample.bounded);
}

}  // namespace

SpaceCuts cuts_for(const EndSample& sample, double reach, std::size_t fitting) {
  constexpr std::size_t kMostBlocks = 1024, kFewer = 4;
  constexpr double kNearly = 1.4;
  const std::size_t wanted = 2 * (sample.bounded / std::max<std::size_t>(fitting, 1) + 1);
  const std::size_t most = std::bit_ceil(std::min(wanted, kMostBlocks));
  const double least = largest_of(SpaceCuts(sample.ends, most), sample, reach);
  const auto fits = static_cast<double>(fitting);
  const double enough = least <= fits ? fits : kNearly * least;
  for (std::size_t parts = std::max<std::size_t>(most / kFewer, 2); parts < most; parts *= 2) {
    SpaceCuts cuts(sample.ends, parts);
    if (largest_of(cuts, sample, reach) <= enough) return cuts;
  }
  return {sample.ends, most};
}

}  // namespace ray::blocks
