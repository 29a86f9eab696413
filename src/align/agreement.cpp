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

constexpr double kColumn = 8.0;  // patches

/// What the other cloud says of a patch.
struct Seen {
  bool is_same = false, is_beside = false, is_empty = false;
  double cost = 1.0;  ///< from 0, on the surface, to 1

  [[nodiscard]] bool is_known() const { return is_same || is_beside || is_empty; }
};

/// Whether the other cloud has seen the back of a flat patch, as of a thin wall: then rays on both sides of
/// it have not gone through.
bool has_back(const Eigen::Vector3d& place, const Eigen::Vector3d& normal, const PatchLevel& level) {
  constexpr double kOpposite = -0.8;             // cosine
  constexpr double kMiddle = 0.4, kThick = 0.8;  // widths
  bool found = false;
  level.each_near(place - kMiddle * level.width() * normal, [&](const Patch& surface) {
    const double behind = normal.dot(place - surface.mean);
    found = found || (surface.is_flat() && surface.normal.dot(normal) < kOpposite && behind > 0.0 &&
                      behind < kThick * level.width());
  });
  return found;
}

Seen seen_of(const Patch& patch, const Pose& pose, const Observed& other, double tolerance) {
  constexpr double kAligned = 0.8;   // cosine
  constexpr double kThrough = 0.75;  // widths
  const Eigen::Vector3d place = pose * patch.mean, normal = pose.rotation * patch.normal;
  const bool is_flat = patch.is_flat();
  Seen seen;
  double nearest = std::numeric_limits<double>::infinity(), nearest_mean = nearest;
  other.level.each_near(place, [&](const Patch& surface) {
    const Eigen::Vector3d apart = surface.mean - place;
    nearest_mean = std::min(nearest_mean, apart.norm());
    const bool fits = is_flat && surface.is_flat();
    // A floor beside the place of a wall says nothing of the wall: the other cloud may end there.
    if (fits && surface.normal.dot(normal) < kAligned) return;
    seen.is_beside = seen.is_beside || fits || !is_flat;
    nearest = std::min(nearest, fits ? std::abs(surface.normal.dot(apart)) : apart.norm());
  });
  const double within = is_flat ? tolerance : other.level.width();
  seen.is_same = nearest < within;
  if (seen.is_same) seen.cost = nearest * nearest / (within * within);
  // Rays along a surface cross its cubes too, and the other cloud may end there: they must have gone through.
  const Eigen::Vector3d step = (is_flat ? kThrough * other.free.width() : 0.0) * normal;
  seen.is_empty = !seen.is_same && !seen.is_beside && nearest_mean > kThrough * other.level.width() &&
                  other.free.is_crossed(place + step) && other.free.is_crossed(place - step) &&
                  !(is_flat && has_back(place, normal, other.level));
  return seen;
}

void count(const Seen& seen, Agreement::Counts& counts) {
  (seen.is_same     ? counts.same
   : seen.is_beside ? counts.other
   : seen.is_empty  ? counts.empty
                    : counts.unknown) += 1.0;
}

/// Columns of space and what is in them.
class Columns {
 public:
  explicit Columns(double width) : width_(width) {}

  void add(const Eigen::Vector3d& place, bool is_against) {
    const Eigen::Array2d cell = (place.head<2>().array() / (kColumn * width_)).floor();
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
  double width_;
  std::vector<std::pair<std::pair<double, double>, bool>> seen_;
};

/// What the patches of a cell say.
struct CellSums {
  double known = 0.0, apart = 0.0, refuted = 0.0;
};

/// Adds cells that have one voice each.
void add_cells(const std::vector<CellSums>& cells, Evidence& evidence) {
  constexpr double kApart = 0.3;  // weight of being apart from a surface, where being refuted has 1
  constexpr double kFew = 3.0;    // patches, of which a cell counts half
  evidence.cells.reserve(cells.size());
  for (const CellSums& cell : cells) {
    const double scale = 1.0 / (cell.known + kFew), known = scale * cell.known,
                 refuted = scale * cell.refuted, against = refuted + scale * kApart * cell.apart;
    evidence.cells.push_back(
        {static_cast<float>(known), static_cast<float>(against), static_cast<float>(refuted)});
    evidence.known += known;
    evidence.against += against;
    evidence.refuted += refuted;
  }
}

}  // namespace

std::vector<JudgedPatch> judged_patches(const PatchLevel& level, std::size_t most) {
  std::vector<JudgedPatch> judged;
  for (const Patch& patch : some_of(level.patches(), most))
    judged.push_back({patch, level.is_clean(patch)});
  return judged;
}

Agreement agreement_of(std::span<const JudgedPatch> patches, const Pose& pose, const Observed& other,
                       double tolerance) {
  Agreement agreement;
  Columns columns(other.level.width());
  for (const auto& [patch, is_clean] : patches) {
    const Seen seen = seen_of(patch, pose, other, tolerance);
    const bool is_upright = patch.is_flat() && std::abs((pose.rotation * patch.normal).z()) < 0.5;
    Agreement::Counts& counts = is_upright ? agreement.upright : agreement.others;
    count(seen, counts);
    const bool is_against = seen.is_empty || (is_clean && is_upright && !seen.is_same && seen.is_beside);
    if (seen.is_same || is_against) columns.add(pose * patch.mean, is_against);
  }
  agreement.against = columns.against();
  return agreement;
}

Witnesses::Witnesses(const PatchLevel& level, std::size_t most, double cell_width)
    : patches_(judged_patches(level, most)) {
  KeyTable<std::uint32_t> numbers;
  for (const JudgedPatch& judged : patches_) {
    const Eigen::Array<std::int64_t, 3, 1> cell =
        (judged.patch.mean.array() / cell_width).floor().cast<std::int64_t>();
    const auto added = numbers.add(voxel_place({cell.x(), cell.y(), cell.z()}).key);
    if (added.is_new) *added.value = static_cast<std::uint32_t>(count_++);
    cells_.push_back(*added.value);
  }
}

Evidence evidence_of(const Witnesses& witnesses, const Pose& pose, const Observed& other, double tolerance) {
  constexpr double kRound = 0.5;   // weight of patches that are not flat: where these are is less sure
  constexpr double kNearby = 0.3;  // cost of those up to which they fit
  std::vector<CellSums> cells(witnesses.cells());
  Evidence evidence;
  for (std::size_t i = 0; i < witnesses.patches().size(); ++i) {
    const auto& [patch, is_clean] = witnesses.patches()[i];
    const Seen seen = seen_of(patch, pose, other, tolerance);
    count(seen, evidence.counts);
    if (!seen.is_known()) continue;
    const double weight = patch.is_flat() ? 1.0 : kRound;
    CellSums& cell = cells[witnesses.cell_of(i)];
    cell.known += weight;
    if (patch.is_flat() || seen.cost > kNearby) cell.apart += weight * seen.cost;
    if (seen.is_empty || (is_clean && !seen.is_same)) cell.refuted += weight;
  }
  add_cells(cells, evidence);
  return evidence;
}

Evidence evidence_of(const Witnesses& witnesses, std::span<const std::uint8_t> pierced, const Pose& pose,
                     const PatchLevel& other, double tolerance) {
  std::vector<CellSums> cells(witnesses.cells());
  Evidence evidence;
  for (std::size_t i = 0; i < pierced.size(); ++i) {
    const auto& [patch, is_clean] = witnesses.patches()[i];
    if (!is_clean) continue;
    const Eigen::Vector3d place = pose * patch.mean;
    const Patch* surface = counterpart_of(patch, other, place, pose.rotation);
    Seen seen;
    seen.is_empty = pierced[i] != 0;
    seen.is_same = !seen.is_empty && surface != nullptr &&
                   std::abs(surface->normal.dot(surface->mean - place)) < tolerance;
    count(seen, evidence.counts);
    CellSums& cell = cells[witnesses.cell_of(i)];
    cell.known += seen.is_known() ? 1.0 : 0.0;
    cell.refuted += seen.is_empty ? 1.0 : 0.0;
  }
  add_cells(cells, evidence);
  return evidence;
}

}  // namespace ray::align
