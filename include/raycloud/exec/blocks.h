#pragma once
/// The neighbourhood shape of algorithm: what becomes of a ray depends on what is near its end. One function
/// works on a block of space and returns a result for each of its records; a cloud that fits the memory is
/// one block, a larger one is cut into several, which lie in temporary files until it is their turn.

#include <raycloud/exec/space_cuts.h>
#include <raycloud/exec/spill.h>
#include <raycloud/exec/stream.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <type_traits>

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

/// An even sample of the ends of the bounded rays: the same for a cloud however it is read and worked on.
struct EndSample {
  std::vector<Eigen::Vector3d> ends;  ///< every so many, in order; all of a small cloud
  std::uint64_t bounded = 0;          ///< rays of the cloud
};

struct BlockNeeds {
  std::size_t bytes_per_record = 0;  ///< memory for each at most, the record included
  /// m: no result depends on a record further away.
  std::function<double(const EndSample&)> reach;
};

namespace blocks {

/// Takes every so many of the ends of the bounded rays that it is shown.
class EndSampler {
 public:
  /// `bounded` of the rays are.
  void add(const RayCloud& rays, std::size_t bounded) {
    const std::uint64_t before = sample_.bounded;
    sample_.bounded += bounded;
    std::size_t row = 0;
    std::uint64_t passed = before;  // bounded rays in front of the row
    while (next_ < sample_.bounded) {
      if (sample_.ends.size() == kMost) thin();
      if (bounded == rays.size())
        row = static_cast<std::size_t>(next_ - before);
      else
        while (rays.bounded[row] == 0 || passed++ < next_)
          ++row;
      sample_.ends.push_back(rays.ends[row++]);
      next_ += stride_;
    }
  }
  [[nodiscard]] const EndSample& sample() const { return sample_; }

 private:
  static constexpr std::size_t kMost = 1 << 16;
  void thin() {
    for (std::size_t i = 0; i < kMost / 2; ++i)
      sample_.ends[i] = sample_.ends[2 * i];
    sample_.ends.resize(kMost / 2);
    stride_ *= 2;
  }
  EndSample sample_;
  std::uint64_t stride_ = 1;
  /// The bounded ray to be taken next. Stays so when the sample is thinned, being kMost strides from the
  /// first.
  std::uint64_t next_ = 0;
};

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

/// The blocks and their results, on disk.
template <class Record, class Result>
class SpilledBlocks {
 public:
  SpilledBlocks(const EndSample& sample, std::size_t parts, double reach, std::size_t memory)
      : cuts_(sample.ends, parts),
        reach_(reach),
        records_(cuts_.parts(), page_bytes(memory / 16)),
        own_(cuts_.parts(), page_bytes(memory / 16 / sizeof(Record))),
        results_(cuts_.parts(), page_bytes(memory / 16)) {}

  /// The records go to every block within reach. May be called at the same time.
  [[nodiscard]] Copies<Record> sort(const RayCloud& rays, const std::vector<Record>& records) const {
    std::vector<std::uint32_t> near;
    return sort(rays, records, [&](const Eigen::Vector3d& end) {
      cuts_.parts_near(end, reach_, near);
      return std::span<const std::uint32_t>(near);
    });
  }

  /// They go to the blocks `parts_for(end)`, of which that with the end is one.
  template <class PartsFor>
  [[nodiscard]] Copies<Record> sort(const RayCloud& rays, const std::vector<Record>& records,
                                    const PartsFor& parts_for) const {
    struct Copy {
      std::uint32_t part, record;
    };
    std::vector<Copy> copies;
    std::vector<std::uint32_t> own_part(records.size());
    std::vector<std::size_t> ends(cuts_.parts() + 1);
    for (std::size_t i = 0, record = 0; i < rays.size(); ++i) {
      if (rays.bounded[i] == 0) continue;
      own_part[record] = static_cast<std::uint32_t>(cuts_.part_of(rays.ends[i]));
      for (const std::uint32_t part : parts_for(rays.ends[i])) {
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
      records_.append(run.part, &copies.records[begin], (run.end - begin) * sizeof(Record));
      own_.append(run.part, &copies.own[begin], run.end - begin);
      begin = run.end;
    }
  }

  /// `work(block, part)` for all blocks that have records of their own, before the results are computed.
  template <class Work>
  void visit(const Context& context, const Work& work) {
    for (std::size_t part = 0; part < cuts_.parts(); ++part) {
      check_cancelled(context);
      Block<Record> block = load(part);
      records_.rewind(part);
      own_.rewind(part);
      if (has_own(block)) work(std::move(block), part);
    }
  }

  template <class Compute>
  void compute(const Context& context, const Compute& compute) {
    for (std::size_t part = 0; part < cuts_.parts(); ++part) {
      check_cancelled(context);
      Block<Record> block = load(part);
      records_.drop(part);
      own_.drop(part);
      if (!has_own(block)) continue;
      const std::vector<std::uint8_t> own = block.own;
      std::vector<Result> results = compute(context, std::move(block), reach_);
      std::size_t count = 0;
      for (std::size_t i = 0; i < own.size(); ++i)
        if (own[i] != 0) results[count++] = results[i];
      results_.append(part, results.data(), count * sizeof(Result));
    }
  }

  /// The next results of these parts.
  std::span<const Result> take(const std::vector<std::uint32_t>& parts) {
    std::vector<std::size_t> next(cuts_.parts() + 1);
    for (const std::uint32_t part : parts)
      ++next[part + 1];
    by_part_.resize(parts.size());
    for (std::size_t part = 0; part < cuts_.parts(); ++part) {
      if (next[part + 1] > 0) results_.read(part, &by_part_[next[part]], next[part + 1] * sizeof(Result));
      next[part + 1] += next[part];
    }
    taken_.resize(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i)
      taken_[i] = by_part_[next[parts[i]]++];
    return taken_;
  }

  [[nodiscard]] std::size_t part_of(const Eigen::Vector3d& end) const { return cuts_.part_of(end); }

 private:
  [[nodiscard]] std::size_t page_bytes(std::size_t memory) const {
    return std::clamp<std::size_t>(memory / cuts_.parts(), std::size_t{1} << 12, std::size_t{1} << 18);
  }

  Block<Record> load(std::size_t part) {
    const std::size_t count = own_.size(part);
    Block<Record> block;
    block.box = cuts_.box_of(part);
    block.records.resize(count);
    block.own.resize(count);
    records_.read(part, block.records.data(), count * sizeof(Record));
    own_.read(part, block.own.data(), count);
    return block;
  }
  static bool has_own(const Block<Record>& block) {
    return std::find(block.own.begin(), block.own.end(), 1) != block.own.end();
  }

  SpaceCuts cuts_;
  double reach_;
  Spill records_;
  Spill own_;  ///< a byte for each record
  Spill results_;
  std::vector<Result> by_part_, taken_;
};

}  // namespace blocks

/// Reads `source` twice, three times where blocks go to disk.
///
/// `extract(rays, i)` makes a Record, a plain struct, of a bounded ray. `compute(context, Block<Record>&&
/// block, reach)` returns a Result, a plain struct too, for each record of the block; it may use all threads.
/// `apply(rays, results)`, in order, changes a chunk by the results of its bounded rays, or returns a mask of
/// the rays that stay.
///
/// The outcome does not depend on context.memory if what `compute` returns for a record depends only on the
/// records within reach of it and their order. Memory: context.memory, but at least about 20 MB, and the
/// chunks.
template <class Record, class Result, class Extract, class Compute, class Apply>
StreamCounts run_blocks(const Context& context, RaySource& source, RaySink& sink, const BlockNeeds& needs,
                        const Extract& extract, const Compute& compute, const Apply& apply) {
  // Eigen's vectors are not trivially copyable by the letter; their bytes are all there is to them.
  static_assert(std::is_trivially_destructible_v<Record> && std::is_trivially_destructible_v<Result>);
  constexpr std::size_t kMostBlocks = 1024;
  const auto extract_chunk = [&](const RayCloud& rays) { return blocks::extract_all<Record>(rays, extract); };
  const std::size_t memory = memory_budget(context);

  // All in one block, unless it turns out to be too large.
  blocks::EndSampler sampler;
  Block<Record> whole;
  const std::size_t fitting = memory / needs.bytes_per_record;
  if (source.info().ray_count)
    whole.records.reserve(std::min<std::uint64_t>(*source.info().ray_count, fitting));
  stream(context, source, nullptr, extract_chunk,
         [&](const RayCloud& rays, const std::vector<Record>& records) {
           sampler.add(rays, records.size());
           if (sampler.sample().bounded <= fitting)
             whole.records.insert(whole.records.end(), records.begin(), records.end());
           else
             whole.records = std::vector<Record>();
         });
  source.rewind();
  const EndSample& sample = sampler.sample();
  const double reach = needs.reach(sample);

  std::vector<Result> results;
  std::unique_ptr<blocks::SpilledBlocks<Record, Result>> spilled;
  if (sample.bounded <= fitting) {
    results = compute(context, std::move(whole), reach);
  } else {
    // What lies around a block takes room too.
    const std::size_t parts = 2 * (sample.bounded * needs.bytes_per_record / memory + 1);
    spilled = std::make_unique<blocks::SpilledBlocks<Record, Result>>(sample, std::min(parts, kMostBlocks),
                                                                      reach, memory);
    stream(
        context, source, nullptr,
        [&](const RayCloud& rays) { return spilled->sort(rays, extract_chunk(rays)); },
        [&](const RayCloud&, const blocks::Copies<Record>& copies) { spilled->add(copies); });
    source.rewind();
    spilled->compute(context, compute);
  }

  /// Which results a chunk takes: so many, and from where.
  struct Wanted {
    std::size_t count = 0;
    std::vector<std::uint32_t> parts;
  };
  const auto wanted_of = [&](const RayCloud& rays) {
    Wanted wanted;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (rays.bounded[i] == 0) continue;
      ++wanted.count;
      if (spilled) wanted.parts.push_back(static_cast<std::uint32_t>(spilled->part_of(rays.ends[i])));
    }
    return wanted;
  };
  std::size_t next = 0;
  return stream(context, source, &sink, wanted_of, [&](RayCloud& rays, const Wanted& wanted) {
    next += wanted.count;
    return apply(rays, spilled ? spilled->take(wanted.parts)
                               : std::span<const Result>(results).subspan(next - wanted.count, wanted.count));
  });
}

}  // namespace ray
