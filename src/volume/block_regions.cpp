#include "block_regions.h"

#include <algorithm>

namespace ray {
namespace {

/// For each ellipsoid of a group, at most.
constexpr std::size_t kMemberBytes = 170;

constexpr std::size_t kMembersAtOnce = 256;

}  // namespace

BlockRegions::BlockRegions(EllipsoidBlocks& blocks, const SpreadSteps& steps)
    : blocks_(blocks), steps_(steps), states_(blocks.cells().size()) {}

void BlockRegions::see(std::size_t part, std::span<const RegionSeed> seeds,
                       std::span<const PackedEllipsoid> ellipsoids) {
  const std::vector<std::uint32_t> cells = blocks_.cells_of(part);
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    if (!is_awake(seeds[i])) continue;
    CellState& state = states_[cells[i]];
    state.awake.extend(centre_of(ellipsoids[i]));
    state.awake_semi = std::max(state.awake_semi, RegionCells::semi_axis_within(unpacked(ellipsoids[i])));
    state.has_evidence = state.has_evidence || seeds[i].own > 0.0F;
    state.is_source = state.is_source || is_source(seeds[i], steps_);
  }
}

void BlockRegions::judge(const Context& context,
                         const std::function<std::vector<RegionSeed>(std::size_t part)>& seeds_of) {
  const std::size_t memory = memory_budget(context);
  groups_ = blocks_.cells().groups(states_, steps_.all(), memory / 4 * 3 / kMemberBytes);
  states_ = {};
  if (groups_.count == 0) return;
  members_ = std::make_unique<SpilledRows<Member>>(groups_.count, memory / 64);
  scores_ = std::make_unique<SpilledRows<float>>(groups_.count, memory / 64);
  for (std::size_t part = 0; part < blocks_.parts(); ++part) {
    if (blocks_.size(part) == 0) continue;
    check_cancelled(context);
    send(part, seeds_of(part));
  }
  for (std::size_t group = 0; group < groups_.count; ++group) {
    check_cancelled(context);
    judge_group(context, group);
  }
  members_.reset();
}

void BlockRegions::send(std::size_t part, const std::vector<RegionSeed>& seeds) {
  const std::vector<std::uint32_t> cells = blocks_.cells_of(part);
  const std::vector<PackedEllipsoid> ellipsoids = blocks_.load(part);
  std::vector<std::vector<Member>> of_groups(groups_.count);
  for (std::size_t i = 0; i < ellipsoids.size(); ++i)
    for (const std::uint32_t group : groups_.needed_by[cells[i]]) {
      std::vector<Member>& members = of_groups[group];
      members.push_back({ellipsoids[i], seeds[i], groups_.owner[cells[i]] == group ? 1U : 0U});
      if (members.size() < kMembersAtOnce) continue;
      members_->append(group, members);
      members.clear();
    }
  for (std::size_t group = 0; group < groups_.count; ++group)
    members_->append(group, of_groups[group]);
}

void BlockRegions::judge_group(const Context& context, std::size_t group) {
  const std::vector<Member> members = members_->read_all(group);
  members_->drop(group);
  const std::unique_ptr<EllipsoidTree> tree = tree_of(
      context, members.size(), [&](std::size_t i) -> const PackedEllipsoid& { return members[i].ellipsoid; });
  std::vector<RegionSeed> seeds(members.size());
  std::vector<std::uint32_t> owned;
  for (std::size_t i = 0; i < members.size(); ++i) {
    seeds[tree->slot(i)] = members[i].seed;
    if (members[i].owned != 0) owned.push_back(tree->slot(i));
  }
  const std::vector<float> of_slots = transient_regions(
      context, *tree, [&](std::size_t slot) { return seeds[slot]; }, steps_);
  std::vector<float> scores(owned.size());
  std::transform(owned.begin(), owned.end(), scores.begin(),
                 [&](std::uint32_t slot) { return of_slots[slot]; });
  scores_->append(group, scores);
}

std::vector<float> BlockRegions::scores(std::size_t part) {
  std::vector<float> scores(blocks_.size(part));
  if (groups_.count == 0 || scores.empty()) return scores;
  const std::vector<std::uint32_t> cells = blocks_.cells_of(part);
  std::vector<std::uint32_t> groups, which;
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    const std::uint32_t owner = groups_.owner[cells[i]];
    if (owner == CellGroups::kNone) continue;
    groups.push_back(owner);
    which.push_back(i);
  }
  const std::span<const float> taken = scores_->take(groups);
  for (std::size_t i = 0; i < which.size(); ++i)
    scores[which[i]] = taken[i];
  return scores;
}

}  // namespace ray
