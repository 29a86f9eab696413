#pragma once
/// The neighbourhood shape of algorithm: what becomes of a ray depends on what is near its end. One function
/// works on a block of space and returns a result for each of its records; a cloud that fits the memory is
/// one block, a larger one is cut into several, which lie in temporary files until it is their turn.

#include <raycloud/exec/block_cuts.h>
#include <raycloud/exec/end_sample.h>
#include <raycloud/exec/fresh_memory.h>
#include <raycloud/exec/spilled_records.h>
#include <raycloud/exec/stream.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <type_traits>

namespace ray {

struct BlockNeeds {
  std::size_t bytes_per_record = 0;  ///< memory for each at most, the record included
  /// m: no result depends on a record further away.
  std::function<double(const EndSample&)> reach;
};

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
  const auto extract_chunk = [&](const RayCloud& rays) { return blocks::extract_all<Record>(rays, extract); };
  const std::size_t memory = memory_budget(context);

  // All in one block, unless it turns out to be too large.
  blocks::EndSampler sampler;
  Block<Record> whole;
  const std::size_t fitting = memory / needs.bytes_per_record;
  if (source.info().ray_count)
    reserve_touched(context, whole.records, std::min<std::uint64_t>(*source.info().ray_count, fitting));
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
  std::unique_ptr<blocks::SpilledRecords<Record>> spilled;
  std::unique_ptr<SpilledRows<Result>> spilled_results;
  if (sample.bounded <= fitting) {
    results = compute(context, std::move(whole), reach);
  } else {
    spilled = std::make_unique<blocks::SpilledRecords<Record>>(blocks::cuts_for(sample, reach, fitting),
                                                               reach, memory);
    spilled_results = std::make_unique<SpilledRows<Result>>(spilled->cuts().parts(), memory / 16);
    stream(
        context, source, nullptr,
        [&](const RayCloud& rays) { return spilled->sort(rays, extract_chunk(rays)); },
        [&](const RayCloud&, const blocks::Copies<Record>& copies) { spilled->add(copies); });
    source.rewind();
    spilled->visit_and_drop(context, [&](Block<Record>&& block, std::size_t part) {
      const std::vector<std::uint8_t> own = block.own;
      std::vector<Result> of_block = compute(context, std::move(block), reach);
      std::size_t count = 0;
      for (std::size_t i = 0; i < own.size(); ++i)
        if (own[i] != 0) of_block[count++] = of_block[i];
      spilled_results->append(part, std::span(of_block).first(count));
    });
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
      if (spilled) wanted.parts.push_back(static_cast<std::uint32_t>(spilled->cuts().part_of(rays.ends[i])));
    }
    return wanted;
  };
  std::size_t next = 0;
  return stream(context, source, &sink, wanted_of, [&](RayCloud& rays, const Wanted& wanted) {
    next += wanted.count;
    return apply(rays, spilled ? spilled_results->take(wanted.parts)
                               : std::span<const Result>(results).subspan(next - wanted.count, wanted.count));
  });
}

}  // namespace ray
