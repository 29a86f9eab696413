#pragma once
/// A cloud cut into blocks of space, each with what lies around it, on disk until it is their turn.

#include <raycloud/core/ray_cloud.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/space_cuts.h>
#include <raycloud/exec/spilled_rows.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace ray {

/// The records of the bounded rays whose ends are in a piece of space, and of those around it. In the order
/// of the cloud, so that an order by position in the block is the order of the rays.
template <class Record>
struct Block {
  std::vector<Record> records;
  std::vector<std::uint8_t> own;  ///< 0: around it, no result is wanted. Empty: all are its own
  Eigen::AlignedBox3d box;        ///< all ends in it are its own; empty where all are anyway

  [[nodiscard]] bool is_own(std::size_t i) const { return own.empty() || own[i] != 0; }
  /// Whether all records within the radius (m) of a place are its own for sure.
  [[nodiscard]] bool has_only_own(const Eigen::Vector3d& place, double radius) const {
    if (own.empty()) return true;
    const Eigen::Array3d margin = radius * (1.0 + 1e-12) + place.array().abs() * 1e-15;
    return (place.array() - margin > box.min().array()).all() &&
           (place.array() + margin < box.max().array()).all();
  }
};

namespace blocks {

/// The records of the bounded rays of a chunk.
template <class Record, class Extract>
std::vector<Record> extract_all(const RayCloud& rays, const Extract& extract) {
  std::vector<Record> records;
  records.reserve(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (rays.bounded[i] != 0) records.push_back(extract(rays, i));
  return records;
}

/// The records of a chunk on their way to their blocks, those of one block beside each other.
template <class Record>
struct Copies {
  struct Run {
    std::size_t part = 0;
    std::size_t end = 0;  ///< in `records`; begins where the one before ends
  };
  std::vector<Run> runs;
  std::vector<Record> records;
  std::vector<std::uint8_t> own;
};

/// The records of all blocks, on disk.
template <class Record>
class SpilledRecords {
 public:
  /// Records are within `reach` (m) of the blocks that they go to.
  SpilledRecords(SpaceCuts cuts, double reach, std::size_t memory)
      : cuts_(std::move(cuts)),
        reach_(reach),
        records_(cuts_.parts(), memory / 16),
        own_(cuts_.parts(), memory / 16 / sizeof(Record)) {}
  [[nodiscard]] const SpaceCuts& cuts() const { return cuts_; }

  /// The records of the bounded rays of a chunk go to every block within reach. May be called at the same
  /// time.
  [[nodiscard]] Copies<Record> sort(const RayCloud& rays, const std::vector<Record>& records) const {
    struct Copy {
      std::uint32_t part, record;
    };
    std::vector<Copy> copies;
    std::vector<std::uint32_t> own_part(records.size());
    std::vector<std::size_t> ends(cuts_.parts() + 1);
    std::vector<std::uint32_t> near;
    for (std::size_t i = 0, record = 0; i < rays.size(); ++i) {
      if (rays.bounded[i] == 0) continue;
      own_part[record] = static_cast<std::uint32_t>(cuts_.part_of(rays.ends[i]));
      cuts_.parts_near(rays.ends[i], reach_, near);
      for (const std::uint32_t part : near) {
        copies.push_back({part, static_cast<std::uint32_t>(record)});
        ++ends[part + 1];
      }
      ++record;
    }
    Copies<Record> sorted;
    for (std::size_t part = 0; part < cuts_.parts(); ++part) {
      if (ends[part + 1] > 0) sorted.runs.push_back({part, ends[part] + ends[part + 1]});
      ends[part + 1] += ends[part];
    }
    sorted.records.resize(copies.size());
    sorted.own.resize(copies.size());
    for (const Copy& copy : copies) {
      const std::size_t at = ends[copy.part]++;
      sorted.records[at] = records[copy.record];
      sorted.own[at] = own_part[copy.record] == copy.part ? 1 : 0;
    }
    return sorted;
  }

  void add(const Copies<Record>& copies) {
    std::size_t begin = 0;
    for (const auto& run : copies.runs) {
      records_.append(run.part, std::span(copies.records).subspan(begin, run.end - begin));
      own_.append(run.part, std::span(copies.own).subspan(begin, run.end - begin));
      begin = run.end;
    }
  }

  /// `work(block, part)` for all blocks that have records of their own. May be called again.
  template <class Work>
  void visit(const Context& context, const Work& work) {
    each_block(context, work, [&](std::size_t part) {
      records_.rewind(part);
      own_.rewind(part);
    });
  }
  /// As that, for the last time.
  template <class Work>
  void visit_and_drop(const Context& context, const Work& work) {
    each_block(context, work, [&](std::size_t part) {
      records_.drop(part);
      own_.drop(part);
    });
  }

  /// One block, for the last time.
  [[nodiscard]] Block<Record> take(std::size_t part) {
    Block<Record> block = read(part);
    records_.drop(part);
    own_.drop(part);
    return block;
  }

 private:
  template <class Work, class WhenRead>
  void each_block(const Context& context, const Work& work, const WhenRead& when_read) {
    for (std::size_t part = 0; part < cuts_.parts(); ++part) {
      check_cancelled(context);
      Block<Record> block = read(part);
      when_read(part);
      if (has_own(block)) work(std::move(block), part);
    }
  }
  Block<Record> read(std::size_t part) {
    Block<Record> block;
    block.box = cuts_.box_of(part);
    block.records = records_.read_all(part);
    block.own = own_.read_all(part);
    return block;
  }
  static bool has_own(const Block<Record>& block) {
    return std::find(block.own.begin(), block.own.end(), 1) != block.own.end();
  }

  SpaceCuts cuts_;
  double reach_;
  SpilledRows<Record> records_;
  SpilledRows<std::uint8_t> own_;
};

}  // namespace blocks

}  // namespace ray
