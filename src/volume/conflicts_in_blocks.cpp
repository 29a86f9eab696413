#include "conflicts_in_blocks.h"

#include "block_regions.h"
#include "conflict_evidence.h"
#include "crossing_rays.h"
#include "ellipsoid_blocks.h"
#include "judgement.h"

#include <algorithm>
#include <memory>

namespace ray {
namespace {

constexpr std::size_t kAtOnce = 1 << 14;

/// Of an ellipsoid of a block whose passes may contradict it: how the rays of another cloud met it.
struct PassedEllipsoid {
  std::uint32_t number = 0;
  Encounters other;
};
struct KnownEvidence {
  std::uint32_t number = 0;
  Evidence evidence;
};

/// Those whose passes contradict some ellipsoids, and the rays of their cloud.
struct ContradictingCloud {
  std::size_t cloud = 0;
  std::unique_ptr<CrossingRays> rays;
  std::unique_ptr<SpilledRows<PassConflict>> conflicts;
};

class ConflictBlocks {
 public:
  ConflictBlocks(const Context& context, const ConflictQuestion& question, const ReadEnds& ends)
      : context_(context),
        page_memory_(memory_budget(context) / 64),
        question_(question),
        blocks_(context, *question.clouds[question.own].source, ends, kJudgedPointBytes),
        rule_(context, question, blocks_.range_noise()) {}

  void hear(std::size_t other) {
    auto rays = crossing(blocks_.boxes(), other);
    SpilledRows<PassedEllipsoid> passed(blocks_.parts(), page_memory_);
    std::vector<Eigen::AlignedBox3d> boxes(blocks_.parts());
    each_part([&](std::size_t part) {
      boxes[part] = find_passed(part, rule_.rays_of(other, *rays, part), passed);
    });
    const Sides& sides = rule_.sides(other);
    if (!sides.passes) rays.reset();
    if (std::all_of(boxes.begin(), boxes.end(), [](const auto& box) { return box.isEmpty(); })) return;
    SpilledRows<KnownEvidence> evidence(blocks_.parts(), page_memory_);
    {
      const auto own_rays = crossing(boxes, question_.own);
      each_part([&](std::size_t part) {
        if (passed.size(part) > 0) find_evidence(part, *own_rays, passed, evidence);
      });
    }
    if (sides.ends) raise_ends(evidence, *sides.ends);
    if (sides.passes) {
      passes_.push_back({other, std::move(rays),
                         std::make_unique<SpilledRows<PassConflict>>(blocks_.parts(), page_memory_)});
      find_pass_conflicts(evidence, *sides.passes, *passes_.back().conflicts);
    }
  }

  void tell(const TellConflicts& to) {
    each_part([&](std::size_t part) {
      for (ContradictingCloud& by : passes_)
        tell_passes_of(part, by, to.passes);
    });
    passes_.clear();
    if (!ends_) return;
    std::vector<std::uint32_t> parts;
    tell_ends(
        context_, question_.clouds[question_.own],
        [&](const RayCloud& rays) {
          parts.clear();
          for (std::size_t i = 0; i < rays.size(); ++i)
            if (rays.bounded[i] != 0)
              parts.push_back(static_cast<std::uint32_t>(blocks_.part_of(rays.ends[i])));
          return ends_->take(parts);
        },
        to.ends);
  }

 private:
  template <class Work>
  void each_part(const Work& work) {
    for (std::size_t part = 0; part < blocks_.parts(); ++part) {
      if (blocks_.size(part) == 0) continue;
      check_cancelled(context_);
      work(part);
    }
  }

  std::unique_ptr<CrossingRays> crossing(const std::vector<Eigen::AlignedBox3d>& boxes, std::size_t cloud) {
    auto rays = std::make_unique<CrossingRays>(boxes, memory_budget(context_) / 16);
    rays->add(context_, *question_.clouds[cloud].source, rule_.numbering(cloud));
    return rays;
  }

  /// Returns the box of those whose passes may contradict them.
  Eigen::AlignedBox3d find_passed(std::size_t part, const MeetingRays& rays,
                                  SpilledRows<PassedEllipsoid>& passed) {
    const std::unique_ptr<EllipsoidTree> tree = blocks_.tree(context_, part);
    const SomeEllipsoids some = some_of(context_, *tree, rule_.passed_slots(*tree, rays));
    if (some.empty()) return {};
    const std::vector<Encounters> met = rule_.met_by(*some.tree, rays);
    std::vector<std::uint32_t> numbers(tree->size());
    for (std::uint32_t number = 0; number < numbers.size(); ++number)
      numbers[tree->slot(number)] = number;
    std::vector<PassedEllipsoid> rows;
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < some.slots.size(); ++i) {
      const Encounters& of_slot = met[some.tree->slot(i)];
      if (!rule_.may_contradict(of_slot)) continue;
      rows.push_back({numbers[some.slots[i]], of_slot});
      box.extend(box_of(tree->at_slot(some.slots[i])));
    }
    passed.append(part, rows);
    return box;
  }

  void find_evidence(std::size_t part, CrossingRays& own_rays, SpilledRows<PassedEllipsoid>& passed,
                     SpilledRows<KnownEvidence>& evidence) {
    const std::vector<PassedEllipsoid> rows = passed.read_all(part);
    const std::vector<PackedEllipsoid> ellipsoids = blocks_.load(part);
    const std::unique_ptr<EllipsoidTree> tree =
        tree_of(context_, rows.size(),
                [&](std::size_t i) -> const PackedEllipsoid& { return ellipsoids[rows[i].number]; });
    const std::vector<Encounters> met = rule_.met_by(*tree, rule_.rays_of(question_.own, own_rays, part));
    std::vector<KnownEvidence> known(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      known[i] = {rows[i].number, rule_.evidence(met[tree->slot(i)], rows[i].other)};
    evidence.append(part, known);
  }

  /// The numbers that transience_scores gives the ellipsoids of a block.
  class Scores {
   public:
    Scores(ConflictBlocks& of, SpilledRows<KnownEvidence>& evidence, const Contradiction& which)
        : of_(of), evidence_(evidence), which_(which) {
      if (of.rule_.paper()) return;
      regions_ = std::make_unique<BlockRegions>(of.blocks_, kBetweenClouds);
      of.each_part([&](std::size_t part) {
        if (evidence.size(part) > 0) regions_->see(part, seeds(part), of.blocks_.load(part));
      });
      regions_->judge(of.context_, [&](std::size_t part) { return seeds(part); });
    }
    /// Called in the order of blocks.
    std::vector<float> of_part(std::size_t part) {
      if (regions_) return regions_->scores(part);
      std::vector<float> scores(of_.blocks_.size(part));
      for (const KnownEvidence& known : evidence_.load(part))
        scores[known.number] = paper_score(known.evidence, which_);
      return scores;
    }

   private:
    std::vector<RegionSeed> seeds(std::size_t part) {
      std::vector<RegionSeed> seeds(of_.blocks_.size(part));
      const std::vector<KnownEvidence> known = evidence_.load(part);
      parallel_for(of_.context_, known.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          seeds[known[i].number] = region_seed(known[i].evidence, which_);
      });
      return seeds;
    }

    ConflictBlocks& of_;
    SpilledRows<KnownEvidence>& evidence_;
    const Contradiction& which_;
    std::unique_ptr<BlockRegions> regions_;
  };

  void raise_ends(SpilledRows<KnownEvidence>& evidence, const Contradiction& which) {
    Scores scores(*this, evidence, which);
    auto ends = std::make_unique<SpilledRows<float>>(blocks_.parts(), page_memory_);
    each_part([&](std::size_t part) {
      std::vector<float> of_part = scores.of_part(part);
      const std::vector<float> so_far = ends_ ? ends_->read_all(part) : std::vector<float>();
      for (std::size_t i = 0; i < so_far.size(); ++i)
        of_part[i] = std::max(of_part[i], so_far[i]);
      ends->append(part, of_part);
    });
    ends_ = std::move(ends);
  }

  void find_pass_conflicts(SpilledRows<KnownEvidence>& evidence, const Contradiction& which,
                           SpilledRows<PassConflict>& conflicts) {
    Scores scores(*this, evidence, which);
    each_part([&](std::size_t part) {
      const std::vector<float> of_part = scores.of_part(part);
      std::vector<PassConflict> found;
      for (const KnownEvidence& known : evidence.load(part))
        add_pass_conflict(known.number, of_part[known.number], known.evidence, rule_.paper(), found);
      conflicts.append(part, found);
    });
  }

  void tell_passes_of(std::size_t part, ContradictingCloud& by, const TellScores& to) {
    std::vector<PassConflict> conflicts = by.conflicts->read_all(part);
    const std::vector<float> ends = ends_ ? ends_->load(part) : std::vector<float>();
    std::erase_if(conflicts, [&](const PassConflict& conflict) {
      return !rule_.gives_way(conflict.score) || (!ends.empty() && rule_.gives_way(ends[conflict.ellipsoid]));
    });
    if (conflicts.empty()) return;
    const std::vector<PackedEllipsoid> ellipsoids = blocks_.load(part);
    const std::unique_ptr<EllipsoidTree> tree =
        tree_of(context_, conflicts.size(),
                [&](std::size_t i) -> const PackedEllipsoid& { return ellipsoids[conflicts[i].ellipsoid]; });
    tell_passes(*tree, conflicts, rule_.counting().guard, rule_.rays_of(by.cloud, *by.rays, part), to);
  }

  const Context& context_;
  std::size_t page_memory_;
  const ConflictQuestion& question_;
  EllipsoidBlocks blocks_;
  ConflictRule rule_;
  std::unique_ptr<SpilledRows<float>> ends_;  ///< by the numbers of the ellipsoids; none: none gives way
  std::vector<ContradictingCloud> passes_;
};

}  // namespace

void find_conflicts_in_blocks(const Context& context, const ConflictQuestion& question, const ReadEnds& ends,
                              const TellConflicts& tell) {
  ConflictBlocks blocks(context, question, ends);
  for (std::size_t other = 0; other < question.clouds.size(); ++other)
    if (other != question.own) blocks.hear(other);
  blocks.tell(tell);
}

}  // namespace ray
