#include "outside_neighbours.h"

#include "noisy_plane.h"
#include "on_wire.h"
#include "row_bits.h"
#include "seen_through.h"
#include "surface_points.h"

#include <raycloud/core/memory_stream.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ray {
namespace {

/// Student's quantile for a normal one (Cornish and Fisher 1938): the variances of sixteen neighbours, who
/// share most of theirs, amount to some forty degrees of freedom.
double for_estimated_sigma(double sigmas) {
  constexpr double kFreedom = 40.0;
  return sigmas + (sigmas * sigmas * sigmas + sigmas) / (4.0 * kFreedom);
}

/// What is known of a point from those around it: whether it stays, is noise, or, from kSuspect on, so alone
/// that rays should tell, with so many others beside it.
using Verdict = std::uint8_t;
constexpr Verdict kStays = 0;
constexpr Verdict kNoise = 1;
constexpr Verdict kSuspect = 2;

/// Around a point of a surface there are some 27 others so near.
constexpr double kBeside = 3.0;  // spacings
constexpr std::size_t kAlone = 2;
/// Rays that pass further away than a hand is wide leave room for a leaf.
constexpr double kMostRadius = 0.1;  // m

/// How far results depend on what is around, in reaches of a surfel: a wire is looked for as far as two, and
/// what is on one, by the surfels there.
constexpr double kReaches = 3.0;

/// What of the verdicts wires are spared. A wire is looked for among the points of no surface, in which 16
/// others are nowhere near.
void spare_wires(const Context& context, const PointTree& tree, std::span<const NoisyPlane> planes,
                 double spacing, double reach, std::vector<Verdict>& verdicts) {
  constexpr double kThin = 6.0;  // spacings; on a surface it is 2.3
  std::vector<std::uint8_t> thin(tree.size());
  std::vector<std::uint32_t> place_of(tree.size());
  for (std::size_t place = 0; place < tree.size(); ++place) {
    const NoisyPlane& plane = planes[place];
    thin[tree.index(place)] =
        plane.points <= kSurfaceNeighbours || plane.is_line || plane.reach > kThin * spacing ? 1 : 0;
    place_of[tree.index(place)] = static_cast<std::uint32_t>(place);
  }
  std::vector<SeenPoint> points;
  std::vector<std::uint32_t> indices;
  for (std::size_t index = 0; index < tree.size(); ++index) {
    if (thin[index] == 0) continue;
    points.push_back({tree.point(place_of[index]), tree.to_sensor(place_of[index])});
    indices.push_back(static_cast<std::uint32_t>(index));
  }
  const PointTree thin_tree(context, points);
  for_each_place(context, thin_tree, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
    for (std::size_t place = begin; place < end; ++place) {
      Verdict& verdict = verdicts[indices[thin_tree.index(place)]];
      if (verdict != kStays && is_on_wire(search, place, spacing, reach)) verdict = kStays;
    }
  });
}

std::vector<Verdict> judge_block(const Context& context, Block<SeenPoint>&& block, double reach,
                                 double sigmas) {
  const PointTree tree(context, block.records);
  block.records = std::vector<SeenPoint>();
  const double surface_reach = reach / kReaches;
  const double spacing = surface_reach / kReachSpacings;
  std::vector<NoisyPlane> planes(tree.size());
  for_each_place(context, tree, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
    for (std::size_t place = begin; place < end; ++place)
      planes[place] =
          noisy_plane(tree, place, surfel_at(search, place, {kSurfaceNeighbours, surface_reach, true}));
  });
  std::vector<Verdict> verdicts(tree.size());
  const double most = for_estimated_sigma(sigmas);
  const double beside2 = kBeside * kBeside * spacing * spacing;
  for_each_place(context, tree, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
    for (std::size_t place = begin; place < end; ++place) {
      const NoisyPlane& plane = planes[place];
      if (!block.is_own(tree.index(place))) continue;
      Verdict& verdict = verdicts[tree.index(place)];
      if (plane.points <= kTooFew) {
        verdict = std::isfinite(reach) ? kNoise : kStays;  // in a cloud of a few rays nobody can tell
        continue;
      }
      if (is_surely_inside(plane, most, kBeside * spacing)) continue;
      const auto neighbours =
          plane.normal.isZero()
              ? search.nearest(place, kSurfaceNeighbours, plane.reach)
              : search.nearest_facing(place, kSurfaceNeighbours, plane.reach, plane.normal.cast<double>());
      const auto others = static_cast<std::size_t>(
          std::count_if(neighbours.begin(), neighbours.end(),
                        [&](const Neighbour& neighbour) { return neighbour.distance2 <= beside2; }));
      if (is_outside(tree, planes, place, neighbours, most))
        verdict = kNoise;
      else if (others <= kAlone && !plane.is_flat)
        verdict = static_cast<Verdict>(kSuspect + others);
    }
  });
  if (std::isfinite(reach)) spare_wires(context, tree, planes, spacing, reach - surface_reach, verdicts);
  return verdicts;
}

/// Points alone, and where their rays are in the cloud.
struct Suspects {
  std::vector<std::uint64_t> rows;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint8_t> beside;  // others

  void add(std::uint64_t row, const Eigen::Vector3d& point, Verdict verdict) {
    rows.push_back(row);
    points.push_back(point);
    beside.push_back(verdict - kSuspect);
  }
};

/// What all blocks say: which rays are noise, and which are suspect.
class Findings {
 public:
  void add(const RayCloud& rays, std::span<const Verdict> verdicts) {
    std::vector<std::uint8_t> mask(rays.size());
    for (std::size_t i = 0, next = 0; i < rays.size(); ++i) {
      if (rays.bounded[i] == 0) continue;
      const Verdict verdict = verdicts[next++];
      if (verdict == kNoise) mask[i] = 1;
      if (verdict >= kSuspect) suspects_.add(rows_ + i, rays.ends[i], verdict);
    }
    noise_.set(rows_, mask);
    rows_ += rays.size();
  }

  /// Lets all rays of the cloud tell of the suspects, and rewinds it.
  void ask_rays(const Context& context, RaySource& source, double radius) {
    if (suspects_.points.empty() || !(radius > 0.0)) return;
    SeenThrough balls(std::move(suspects_.points), radius);
    stream(
        context, source, nullptr,
        [&](const RayCloud& rays) {
          for (std::size_t i = 0; i < rays.size(); ++i)
            balls.add(rays.starts[i], rays.ends[i], rays.bounded[i] != 0);
          return Nothing{};
        },
        [](const RayCloud&, Nothing) {});
    source.rewind();
    constexpr std::array<std::uint8_t, 1> kSet{1};
    for (std::size_t i = 0; i < balls.size(); ++i)
      if (is_seen_through(balls.passes(i), suspects_.beside[i])) noise_.set(suspects_.rows[i], kSet);
  }

  StreamCounts write_rest(const Context& context, RaySource& source, RaySink& sink) const {
    std::uint64_t row = 0;
    return stream(
        context, source, &sink, [](const RayCloud&) { return Nothing{}; },
        [&](const RayCloud& rays, Nothing&) {
          std::vector<std::uint8_t> mask = noise_.mask(row, rays.size());
          for (std::uint8_t& stays : mask)
            stays ^= 1;
          row += rays.size();
          return mask;
        });
  }

 private:
  /// A point of which so many rays took no notice is none of a thing.
  static bool is_seen_through(std::uint32_t passes, std::uint8_t beside) {
    constexpr std::uint32_t kFewestPasses = 3;
    constexpr double kPasses = 4.0;  // for each point
    return passes >= kFewestPasses && passes >= kPasses * (beside + 0.5);
  }

  std::uint64_t rows_ = 0;
  RowBits noise_;
  Suspects suspects_;
};

}  // namespace

Denoised outside_neighbours(const Context& context, RaySource& source, RaySink& sink, double sigmas) {
  double radius = 0.0;
  const auto reach_of = [&](const EndSample& sample) {
    const double reach = neighbour_reach(sample);
    radius = std::min(kBeside * reach / kReachSpacings, kMostRadius);
    return kReaches * reach;
  };
  const auto compute = [&](const Context& with, Block<SeenPoint>&& block, double reach) {
    return judge_block(with, std::move(block), reach, sigmas);
  };
  Findings findings;
  const auto collect = [&](const RayCloud& rays, std::span<const Verdict> verdicts) {
    findings.add(rays, verdicts);
    return std::vector<std::uint8_t>(rays.size());  // nothing is written yet
  };
  MemorySink nowhere(source.info().extras);
  run_blocks<SeenPoint, Verdict>(context, source, nowhere, {.bytes_per_record = 90, .reach = reach_of},
                                 seen_point, compute, collect);
  source.rewind();
  findings.ask_rays(context, source, radius);
  return {.counts = findings.write_rest(context, source, sink)};
}

}  // namespace ray
