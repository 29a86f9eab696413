#include "neighbour_verdicts.h"

#include "noisy_plane.h"

#include <raycloud/exec/fresh_memory.h>
#include <raycloud/exec/parallel.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <optional>

namespace ray {
namespace {

/// Student's quantile for a normal one (Cornish and Fisher 1938): the variances of sixteen neighbours, who
/// share most of theirs, amount to some forty degrees of freedom.
double for_estimated_sigma(double sigmas) {
  constexpr double kFreedom = 40.0;
  return sigmas + (sigmas * sigmas * sigmas + sigmas) / (4.0 * kFreedom);
}

class BlockJudge {
 public:
  BlockJudge(const Context& context, Block<SeenPoint>&& block, double reach, double sigmas)
      : context_(context),
        tree_(context, block.records),
        block_(without_records(std::move(block))),
        reach_(reach),
        spacing_(reach / kReachSpacings),
        sigmas_(for_estimated_sigma(sigmas)),
        planes_(touched_vector<NoisyPlane>(context, tree_.size())),
        verdicts_(touched_vector<Verdict>(context, tree_.size())),
        open_(touched_vector<Open>(context, tree_.size())) {}

  std::vector<Verdict> take_verdicts() {
    // The larger the range, the fewer have neighbours beyond.
    const std::size_t places = std::clamp<std::size_t>(tree_.size() / 64, 4096, 65536);
    parallel_for(context_, tree_.size(), places, [&](std::size_t begin, std::size_t end) {
      NeighbourSearch search(tree_);
      judge_range(search, begin, end);
    });
    if (!block_.own.empty()) find_planes_around();
    for_each_place(context_, tree_, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
      for (std::size_t place = begin; place < end; ++place)
        if (open_[place] == Open::kVerdict) judge(place, neighbours_of(search, place));
    });
    return std::move(verdicts_);
  }

 private:
  /// The tree has all that they say; others need the memory.
  static Block<SeenPoint> without_records(Block<SeenPoint>&& block) {
    block.records = std::vector<SeenPoint>();
    return std::move(block);
  }

  /// What is still to be found of a place.
  enum class Open : std::uint8_t { kNothing, kVerdict, kPlane };

  /// Who asks neighbours whose planes will soon be known.
  struct Asking {
    std::size_t place;
    std::size_t count;
    std::array<Neighbour, kSurfaceNeighbours> all;
    [[nodiscard]] std::span<const Neighbour> neighbours() const { return std::span(all).first(count); }
  };

  void judge_range(NeighbourSearch& search, std::size_t begin, std::size_t end) {
    std::vector<Asking> asking;
    const auto is_own = [&](std::size_t place) { return block_.is_own(tree_.index(place)); };
    find_planes(search, begin, end, is_own, [&](const SurfelOf& found) {
      if (is_settled(found.place)) return;
      const std::optional<Asking> asks = asking_of(found.place, *found.around);
      if (asks && are_own_of_range(asks->neighbours(), begin, end))
        asking.push_back(*asks);
      else
        open_[found.place] = Open::kVerdict;
    });
    for (const Asking& one : asking)
      judge(one.place, one.neighbours());
  }

  [[nodiscard]] bool are_own_of_range(std::span<const Neighbour> neighbours, std::size_t begin,
                                      std::size_t end) const {
    return std::all_of(neighbours.begin(), neighbours.end(), [&](const Neighbour& neighbour) {
      return neighbour.place >= begin && neighbour.place < end && block_.is_own(tree_.index(neighbour.place));
    });
  }

  /// `then` is told what is known of the nearest neighbours.
  template <class Wanted, class Then>
  void find_planes(NeighbourSearch& search, std::size_t begin, std::size_t end, const Wanted& wanted,
                   const Then& then) {
    SurfelFinder finder(search, {kSurfaceNeighbours, reach_, true});
    finder.for_each(begin, end, wanted, [&](const SurfelOf& found) {
      planes_[found.place] = noisy_plane(tree_, found.place, found.surfel);
      then(found);
    });
  }

  /// Gives a verdict where there is no need to ask the neighbours. True if so.
  bool is_settled(std::size_t place) {
    constexpr double kThin = 6.0;  // spacings within which 16 neighbours are; on a surface it is 2.3
    const NoisyPlane& plane = planes_[place];
    Verdict& verdict = verdicts_[tree_.index(place)];
    verdict.is_thin = plane.points <= kSurfaceNeighbours || plane.is_line || plane.reach > kThin * spacing_;
    if (plane.points > kTooFew) return is_surely_inside(plane, sigmas_, kBeside * spacing_);
    // In a cloud of a few rays nobody can tell.
    verdict.kind = std::isfinite(reach_) ? Verdict::kNoise : Verdict::kStays;
    return true;
  }

  /// The same as neighbours_of finds, from the nearest of any side. None if these are too few to tell.
  std::optional<Asking> asking_of(std::size_t place, const Neighbourhood& around) const {
    const NoisyPlane& plane = planes_[place];
    if (plane.normal.isZero()) return {};
    const double reach2 = static_cast<double>(plane.reach) * static_cast<double>(plane.reach);
    const Neighbourhood::Some facing = around.seen_from(plane.normal.cast<double>());
    const auto count = static_cast<std::size_t>(std::popcount(facing));
    if (count < kSurfaceNeighbours && around.furthest2() <= reach2) return {};
    Asking asking{place, 0, {}};
    for (Neighbourhood::Some some = around.nearest(facing, kSurfaceNeighbours); some != 0; some &= some - 1) {
      const Neighbour neighbour = around.neighbour(static_cast<std::size_t>(std::countr_zero(some)));
      if (neighbour.distance2 <= reach2) asking.all[asking.count++] = neighbour;
    }
    return asking;
  }

  std::span<const Neighbour> neighbours_of(NeighbourSearch& search, std::size_t place) const {
    const NoisyPlane& plane = planes_[place];
    return plane.normal.isZero()
               ? search.nearest(place, kSurfaceNeighbours, plane.reach)
               : search.nearest_facing(place, kSurfaceNeighbours, plane.reach, plane.normal.cast<double>());
  }

  /// Of what lies around the block, the planes of those who will be asked.
  void find_planes_around() {
    const auto open = [&](std::size_t place) { return std::atomic_ref(open_[place]); };
    for_each_place(context_, tree_, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
      for (std::size_t place = begin; place < end; ++place) {
        if (open(place).load(std::memory_order_relaxed) != Open::kVerdict ||
            block_.has_only_own(tree_.point(place), planes_[place].reach))
          continue;
        for (const Neighbour& neighbour : neighbours_of(search, place))
          if (!block_.is_own(tree_.index(neighbour.place)))
            open(neighbour.place).store(Open::kPlane, std::memory_order_relaxed);
      }
    });
    for_each_place(context_, tree_, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
      find_planes(
          search, begin, end, [&](std::size_t place) { return open_[place] == Open::kPlane; },
          [](const SurfelOf&) {});
    });
  }

  void judge(std::size_t place, std::span<const Neighbour> neighbours) {
    Verdict& verdict = verdicts_[tree_.index(place)];
    if (is_outside(tree_, planes_, place, neighbours, sigmas_)) {
      verdict.kind = Verdict::kNoise;
      return;
    }
    if (planes_[place].is_flat) return;
    const double beside2 = kBeside * kBeside * spacing_ * spacing_;
    const auto others = std::count_if(neighbours.begin(), neighbours.end(), [&](const Neighbour& neighbour) {
      return neighbour.distance2 <= beside2;
    });
    if (others > static_cast<std::ptrdiff_t>(kAlone)) return;
    verdict.kind = Verdict::kSuspect;
    verdict.beside = static_cast<std::uint8_t>(others);
  }

  const Context& context_;
  PointTree tree_;
  Block<SeenPoint> block_;
  double reach_, spacing_;  // m
  double sigmas_;
  std::vector<NoisyPlane> planes_;  // by place
  std::vector<Verdict> verdicts_;   // by index
  std::vector<Open> open_;          // by place
};

}  // namespace

std::vector<Verdict> judge_block(const Context& context, Block<SeenPoint>&& block, double reach,
                                 double sigmas) {
  return BlockJudge(context, std::move(block), reach, sigmas).take_verdicts();
}

}  // namespace ray
