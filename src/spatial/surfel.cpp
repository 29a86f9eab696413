#include "surfel_queue.h"

#include <raycloud/spatial/surfel.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <memory>
#include <span>

namespace ray {
namespace {

/// The normal of a thicker surfel may be any.
bool is_flat(const Surfel& surfel, double flat = 0.1) {
  return surfel.variances[0] <= flat * surfel.variances[1];
}

/// So few points that rounding makes their shape are not flat.
bool is_clearly_flatter(const Surfel& a, const Surfel& b) {
  constexpr double kClearly = 0.25;
  if (!a.is_surface() || !b.is_surface()) return a.is_surface();
  return a.variances[0] * b.variances[1] < kClearly * b.variances[0] * a.variances[1];
}

/// No surface: what one beam left as it turned. Of a line, the normal may be any across it; of a sheet along
/// the ray, the noise of the range makes it, and no beam ends on a surface that it sees from its edge.
bool is_ring(const Surfel& surfel, const Eigen::Vector3d& ray) {
  constexpr double kThin = 0.05;
  constexpr double kEdgeOn = 0.1;  // cosine
  return surfel.variances[1] < kThin * surfel.variances[2] || surfel.normal.dot(ray) < kEdgeOn * ray.norm();
}

/// How many of the nearest, of any side, tell where the sides are.
std::size_t wide_count(const SurfelRule& rule) {
  return std::min(3 * rule.neighbours, NeighbourSearch::kMost);
}

/// Whether those who ask for the nearest are wont to ask for more of them then: both are one search.
class AsksForMore {
 public:
  [[nodiscard]] bool is_usual() const { return often_ >= kOften; }
  void add(bool asked) { often_ = std::clamp(often_ + (asked ? 1 : -1), 0, kLongest); }

 private:
  static constexpr int kOften = 6, kLongest = 8;
  int often_ = 0;
};

}  // namespace

Shape shape_of(const Surfel& surfel) {
  const Eigen::Vector3d extents = surfel.variances.cwiseSqrt();
  if (!(extents[2] > 0.0)) return {.sphericity = 1.0};
  return {.sphericity = extents[0] / extents[2],
          .cylindricality = (extents[2] - extents[1]) / extents[2],
          .planarity = (extents[1] - extents[0]) / extents[2]};
}

/// Step by step, each for all places before the next.
class SurfelFinder::Impl {
 public:
  Impl(NeighbourSearch& search, const SurfelRule& rule)
      : search_(search), rule_(rule), queue_(search.tree()) {}

  std::span<const SurfelOf> find(std::span<const std::size_t> places) {
    assert(places.size() <= kMost);
    count_ = places.size();
    for (std::size_t i = 0; i < count_; ++i)
      look_at_nearest(works_[i], places[i]);
    queue_.make();
    const auto each = [&](void (Impl::*step)(Work&)) {
      for (std::size_t i = 0; i < count_; ++i)
        (this->*step)(works_[i]);
      queue_.make();
    };
    if (rule_.by_side)
      for (const auto step : {&Impl::look_wide, &Impl::look_from_sides, &Impl::look_again})
        each(step);
    if (rule_.past_rings)
      for (const auto step : {&Impl::look_past_ring, &Impl::end_ring})
        each(step);
    for (std::size_t i = 0; i < count_; ++i)
      results_[i] = {places[i], *works_[i].result, &works_[i].around};
    return {results_.data(), count_};
  }

 private:
  using Some = Neighbourhood::Some;

  enum class Kind : std::uint8_t {
    kDone,
    kThick,   ///< the nearest are no flat surface
    kBehind,  ///< they are, and some of them were seen from its other side
  };

  struct Work {
    Neighbourhood around;
    std::size_t asked;  ///< all nearest that there are, if fewer than so many
    Some close;         ///< as many of them as the rule says
    Kind kind;
    bool from_behind;
    Some first_bits, other_bits;           ///< those of `around` that they are from; none: unknown
    const Surfel *first, *other, *result;  ///< one of these:
    Surfel nearest, wide, of_first, of_other, last;
  };

  [[nodiscard]] Eigen::Vector3d to_sensor(const Work& work) const {
    return unpack_direction(search_.tree().to_sensor(work.around.place()));
  }

  void search_nearest(Work& work, std::size_t place, std::size_t count) {
    work.asked = count;
    search_.nearest(place, count, rule_.reach, work.around);
    work.close = work.around.nearest(work.around.all(), rule_.neighbours);
  }

  void look_at_nearest(Work& work, std::size_t place) {
    search_nearest(work, place, more_.is_usual() ? wide_count(rule_) : rule_.neighbours);
    work.kind = Kind::kDone;
    work.result = &work.nearest;
    queue_.add(work.around, work.close, work.nearest);
  }

  /// Where the nearest neighbours are no flat surface: round or thick? More of them may tell.
  void look_wide(Work& work) {
    const bool flat = is_flat(work.nearest);
    work.from_behind = (work.close & ~work.around.seen_from(work.nearest.normal)) != 0;
    const bool thick = !flat && !are_seen_alike(work);
    more_.add(thick);
    if (flat && work.from_behind) work.kind = Kind::kBehind;
    if (!thick) return;
    work.kind = Kind::kThick;
    if (work.asked < wide_count(rule_)) search_nearest(work, work.around.place(), wide_count(rule_));
    queue_.add(work.around, work.around.all(), work.wide);
  }

  /// From within 30 degrees of the direction that this point was seen from: one side.
  [[nodiscard]] bool are_seen_alike(const Work& work) const {
    constexpr double kAlike = 0.87 * 32767.0 * 32767.0;
    const PackedDirection& own = search_.tree().to_sensor(work.around.place());
    return (work.close & ~work.around.seen_from(Eigen::Vector3d(own[0], own[1], own[2]), kAlike)) == 0;
  }

  /// If more of the neighbours are flat, as they are where the two sides of a wall are no further apart than
  /// their points, their normal says where the sides are, else the ray.
  void look_from_sides(Work& work) {
    constexpr double kFlatEnough = 0.4;  // for that many
    if (work.kind == Kind::kDone) return;
    work.first_bits = work.other_bits = 0;
    work.first = &work.nearest, work.other = nullptr;
    if (work.kind == Kind::kThick) {
      const Eigen::Vector3d side = is_flat(work.wide, kFlatEnough) ? work.wide.normal : to_sensor(work);
      // The nearest of a side are the nearest, if those are of it.
      if (!work.from_behind && (work.close & ~work.around.seen_from(side)) == 0) {
        work.kind = Kind::kDone;
        return;
      }
      work.other = of_side(work, side, work.of_other, work.other_bits);
    }
    if (work.from_behind) work.first = of_side(work, work.nearest.normal, work.of_first, work.first_bits);
  }

  /// The first normal does, if that leaves a clearly flatter surface.
  void look_again(Work& work) {
    if (work.kind == Kind::kDone) return;
    const bool first = work.other == nullptr || is_clearly_flatter(*work.first, *work.other);
    Some bits = 0;
    work.result = of_side(work, (first ? work.first : work.other)->normal, work.last, bits);
  }

  /// The surfel of the nearest neighbours that were seen from a side: one that is known, or else `surfel`,
  /// when the queue is made. `bits` says who they were chosen from.
  const Surfel* of_side(Work& work, const Eigen::Vector3d& side, Surfel& surfel, Some& bits) {
    const Some facing = work.around.seen_from(side);
    if (facing == work.around.all()) return &work.nearest;
    const auto count = static_cast<std::size_t>(std::popcount(facing));
    if (count < rule_.neighbours && work.around.size() == work.asked) {
      search_side(work.around.place(), rule_.neighbours, side, surfel);
      return &surfel;
    }
    if (facing != 0 && facing == work.first_bits) return work.first;
    if (facing != 0 && facing == work.other_bits) return work.other;
    bits = facing;
    queue_.add(work.around, work.around.nearest(facing, rule_.neighbours), surfel);
    return &surfel;
  }

  void search_side(std::size_t place, std::size_t count, const Eigen::Vector3d& side, Surfel& surfel) {
    search_.nearest_facing(place, count, rule_.reach, side, of_side_);
    queue_.add(of_side_, of_side_.all(), surfel);
  }

  /// With more of the neighbours seen from the side of the ray, if these are a surface.
  void look_past_ring(Work& work) {
    const Eigen::Vector3d ray = to_sensor(work);
    work.other = nullptr;
    if (!is_ring(*work.result, ray)) return;
    work.other = &work.wide;
    search_side(work.around.place(), wide_count(rule_), ray, work.wide);
  }
  void end_ring(Work& work) {
    if (work.other != nullptr && is_flat(work.wide) && !is_ring(work.wide, to_sensor(work)))
      work.result = &work.wide;
  }

  NeighbourSearch& search_;
  SurfelRule rule_;
  SurfelQueue queue_;
  AsksForMore more_;
  std::array<Work, kMost> works_;
  std::size_t count_ = 0;
  Neighbourhood of_side_;
  std::array<SurfelOf, kMost> results_;
};

SurfelFinder::SurfelFinder(NeighbourSearch& search, const SurfelRule& rule)
    : search_(search), impl_(std::make_unique<Impl>(search, rule)) {}
SurfelFinder::~SurfelFinder() = default;

std::span<const SurfelOf> SurfelFinder::find(std::span<const std::size_t> places) {
  return impl_->find(places);
}

Surfel surfel_at(NeighbourSearch& search, std::size_t place, const SurfelRule& rule) {
  return SurfelFinder(search, rule).find({&place, 1}).front().surfel;
}

}  // namespace ray
