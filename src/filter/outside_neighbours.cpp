#include "outside_neighbours.h"

#include "neighbour_verdicts.h"
#include "on_wire.h"
#include "row_bits.h"
#include "surface_points.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/spatial/seen_through.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ray {
namespace {

/// Rays that pass further away than a hand is wide leave room for a leaf.
constexpr double kMostRadius = 0.1;  // m
/// How far wires are looked for, in reaches of a surfel.
constexpr double kWireReaches = 2.0;

/// What all blocks say: which rays are noise, and which may be, and the points among which to look for wires.
class Findings {
 public:
  void add(const RayCloud& rays, std::span<const Verdict> verdicts) {
    std::vector<std::uint8_t> mask(rays.size());
    for (std::size_t i = 0, next = 0; i < rays.size(); ++i) {
      if (rays.bounded[i] == 0) continue;
      const Verdict verdict = verdicts[next++];
      const Candidate candidate{rows_ + i, verdict.is_thin ? thin_.size() : kNotThin};
      if (verdict.is_thin) thin_.push_back(seen_point(rays, i));
      if (verdict.kind == Verdict::kSuspect) {
        suspects_.push_back({candidate, verdict.beside});
        suspect_points_.push_back(rays.ends[i]);
      }
      if (verdict.kind != Verdict::kNoise) continue;
      if (verdict.is_thin)
        candidates_.push_back(candidate);
      else
        mask[i] = 1;
    }
    noise_.set(rows_, mask);
    rows_ += rays.size();
  }

  /// Lets all rays of the cloud tell of the suspects, and rewinds it.
  void ask_rays(const Context& context, RaySource& source, double radius) {
    if (suspects_.empty() || !(radius > 0.0)) return;
    SeenThrough balls(suspect_points_, radius);
    suspect_points_ = std::vector<Eigen::Vector3d>();
    stream(
        context, source, nullptr,
        [&](const RayCloud& rays) {
          for (std::size_t i = 0; i < rays.size(); ++i)
            balls.add(rays.starts[i], rays.ends[i], rays.bounded[i] != 0);
          return Nothing{};
        },
        [](const RayCloud&, Nothing) {});
    source.rewind();
    for (std::size_t i = 0; i < balls.size(); ++i)
      if (is_seen_through(balls.passes(i), suspects_[i].beside)) candidates_.push_back(suspects_[i].ray);
    suspects_ = std::vector<Suspect>();
  }

  /// Of the rays that may be noise those are, that did not end on a wire. A wire is looked for among the
  /// points of no surface.
  void spare_wires(const Context& context, double spacing) {
    std::vector<std::uint8_t> on_wire(thin_.size());
    if (std::isfinite(spacing)) {
      constexpr std::uint8_t kAsked = 2;
      for (const Candidate& candidate : candidates_)
        if (candidate.thin != kNotThin) on_wire[candidate.thin] = kAsked;
      const PointTree tree(context, thin_);
      thin_ = std::vector<SeenPoint>();
      for_each_place(context, tree, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
        for (std::size_t place = begin; place < end; ++place) {
          std::uint8_t& is_on = on_wire[tree.index(place)];
          if (is_on == kAsked)
            is_on = is_on_wire(search, place, spacing, kWireReaches * kReachSpacings * spacing) ? 1 : 0;
        }
      });
    }
    constexpr std::array<std::uint8_t, 1> kSet{1};
    for (const Candidate& candidate : candidates_)
      if (candidate.thin == kNotThin || on_wire[candidate.thin] == 0) noise_.set(candidate.row, kSet);
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

  static constexpr std::size_t kNotThin = ~std::size_t{0};
  struct Candidate {
    std::uint64_t row;
    std::size_t thin;  // which of thin_
  };
  struct Suspect {
    Candidate ray;
    std::uint8_t beside;  // others
  };

  std::uint64_t rows_ = 0;
  RowBits noise_;
  std::vector<Candidate> candidates_;
  std::vector<Suspect> suspects_;
  std::vector<Eigen::Vector3d> suspect_points_;
  std::vector<SeenPoint> thin_;
};

}  // namespace

Denoised outside_neighbours(const Context& context, RaySource& source, RaySink& sink, double sigmas) {
  double spacing = 0.0;
  const auto reach_of = [&](const EndSample& sample) {
    const double reach = neighbour_reach(sample);
    spacing = reach / kReachSpacings;
    return kVerdictReaches * reach;
  };
  const auto compute = [&](const Context& with, Block<SeenPoint>&& block, double reach) {
    return judge_block(with, std::move(block), reach / kVerdictReaches, sigmas);
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
  findings.ask_rays(context, source, std::min(kBeside * spacing, kMostRadius));
  findings.spare_wires(context, spacing);
  return {.counts = findings.write_rest(context, source, sink)};
}

}  // namespace ray
