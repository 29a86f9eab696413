#include "rises.h"

#include "fine.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ray::align {

std::vector<Patch> level_patches(const std::vector<Patch>& patches, std::size_t most) {
  std::vector<Patch> chosen;
  for (const Patch& patch : patches)
    if (patch.is_flat() && patch.is_level()) chosen.push_back(patch);
  constexpr std::size_t kFew = 50;
  return some_of(chosen.size() < kFew ? patches : chosen, most);
}

LevelHeights::LevelHeights(const std::vector<Patch>& patches, double width) : width_(2.0 * width) {
  for (const Patch& patch : level_patches(patches, patches.size()))
    heights_.push_back(
        {column_of(patch.mean.head<2>()), static_cast<float>(patch.mean.z()), patch.normal.z() > 0.0});
  std::stable_sort(heights_.begin(), heights_.end(),
                   [](const Height& a, const Height& b) { return a.column < b.column; });
}

std::uint64_t LevelHeights::column_of(const Eigen::Vector2d& place) const {
  const Eigen::Array<std::int64_t, 2, 1> cell = (place.array() / width_).floor().cast<std::int64_t>();
  return static_cast<std::uint64_t>(cell.x()) << 32 ^ static_cast<std::uint32_t>(cell.y());
}

std::vector<double> LevelHeights::rises(std::span<const Patch> cloud, const Candidate& candidate,
                                        std::size_t most) const {
  constexpr double kBin = 0.25;  // m
  std::map<int, double> votes;
  const double c = std::cos(candidate.yaw), s = std::sin(candidate.yaw);
  for (const Patch& patch : cloud) {
    const Eigen::Vector2d place(c * patch.mean.x() - s * patch.mean.y() + candidate.shift.x(),
                                s * patch.mean.x() + c * patch.mean.y() + candidate.shift.y());
    const std::uint64_t column = column_of(place);
    auto found = std::lower_bound(heights_.begin(), heights_.end(), column,
                                  [](const Height& one, std::uint64_t key) { return one.column < key; });
    for (; found != heights_.end() && found->column == column; ++found)
      if (found->up == (patch.normal.z() > 0.0))
        votes[static_cast<int>(std::lround((static_cast<double>(found->height) - patch.mean.z()) / kBin))] +=
            1.0;
  }
  const auto at = [&](int bin) {
    const auto found = votes.find(bin);
    return found == votes.end() ? 0.0 : found->second;
  };
  struct Peak {
    double votes, rise;
  };
  std::vector<Peak> peaks;
  for (const auto& [bin, count] : votes) {
    const double before = at(bin - 1), after = at(bin + 1);
    if (count < before || count <= after) continue;
    const double sum = before + count + after;
    peaks.push_back({sum, kBin * (bin + (after - before) / sum)});
  }
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const Peak& a, const Peak& b) { return a.votes > b.votes; });
  std::vector<double> rises;
  for (const Peak& peak : peaks)
    if (rises.size() < most) rises.push_back(peak.rise);
  return rises;
}

}  // namespace ray::align
