#include "agreement.h"

#include "fine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace ray::align {
namespace {

/// Columns of space, eight patches wide, and what is in them.
class Columns {
 public:
  explicit Columns(double width) : width_(width) {}

  void add(const Eigen::Vector3d& place, bool is_against) {
    const Eigen::Array2d cell = (place.head<2>().array() / (kPatches * width_)).floor();
    seen_.push_back({{cell.x(), cell.y()}, is_against});
  }

  /// How many are against, but for those in the tenth of the columns that have most of them.
  [[nodiscard]] double against() {
    constexpr double kShare = 0.1;
    std::sort(seen_.begin(), seen_.end());
    std::vector<double> columns;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      if (i == 0 || seen_[i - 1].first != seen_[i].first) columns.push_back(0.0);
      columns.back() += seen_[i].second ? 1.0 : 0.0;
    }
    std::sort(columns.begin(), columns.end());
    const auto kept = static_cast<std::ptrdiff_t>((1.0 - kShare) * static_cast<double>(columns.size()));
    return std::accumulate(columns.begin(), columns.begin() + kept, 0.0);
  }

 private:
  static constexpr double kPatches = 8.0;
  double width_;
  std::vector<std::pair<std::pair<double, double>, bool>> seen_;
};

}  // namespace

Agreement::Counts& Agreement::Counts::operator+=(const Counts& more) {
  same += more.same, other += more.other, empty += more.empty, unknown += more.unknown;
  return *this;
}

Agreement& Agreement::operator+=(const Agreement& more) {
  upright += more.upright;
  others += more.others;
  against += more.against;
  return *this;
}

std::vector<JudgedPatch> judged_patches(const PatchLevel& level, std::size_t most) {
  std::vector<JudgedPatch> judged;
  for (const Patch& patch : some_of(level.patches(), most))
    judged.push_back({patch, level.is_clean(patch)});
  return judged;
}

Agreement agreement_of(std::span<const JudgedPatch> patches, const Pose& pose, const Observed& other,
                       double tolerance) {
  constexpr double kAligned = 0.8;  // cosine
  Agreement agreement;
  Columns columns(other.level.width());
  for (const auto& [patch, is_clean] : patches) {
    const Eigen::Vector3d place = pose * patch.mean, normal = pose.rotation * patch.normal;
    const bool is_flat = patch.is_flat();
    Agreement::Counts& counts = is_flat && std::abs(normal.z()) < 0.5 ? agreement.upright : agreement.others;
    bool beside = false;
    double nearest = std::numeric_limits<double>::infinity();
    other.level.each_near(place, [&](const Patch& surface) {
      beside = true;
      const Eigen::Vector3d apart = surface.mean - place;
      const bool fits = is_flat && surface.is_flat();
      if (fits && surface.normal.dot(normal) < kAligned) return;
      nearest = std::min(nearest, fits ? std::abs(surface.normal.dot(apart)) : apart.norm());
    });
    const bool is_same = nearest < (is_flat ? tolerance : other.level.width());
    const bool is_empty = !is_same && !beside && other.free.is_crossed(place);
    (is_same ? counts.same : beside ? counts.other : is_empty ? counts.empty : counts.unknown) += 1.0;
    const bool is_against = is_empty || (is_clean && !is_same && beside && &counts == &agreement.upright);
    if (is_same || is_against) columns.add(place, is_against);
  }
  agreement.against = columns.against();
  return agreement;
}

}  // namespace ray::align
