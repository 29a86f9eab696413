#include "cloud_ellipsoids.h"
#include "each_chunk.h"
#include "judged_block.h"
#include "judgement_cells.h"
#include "read_ends.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/blocks.h>
#include <raycloud/exec/stream_parts.h>
#include <raycloud/volume/transients.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ray {
namespace {

const std::array<ColumnInfo, 4> kTransientColumns{{{"opacity", ScalarType::float32},
                                                   {"hits", ScalarType::uint16},
                                                   {"passes", ScalarType::uint16},
                                                   {"transience", ScalarType::float32}}};

void colour_by_evidence(Colour& colour, float opacity, std::uint16_t passes, double transience) {
  constexpr int kManyPasses = 51;
  colour.red = static_cast<std::uint8_t>(5 * std::min<int>(passes, kManyPasses));
  colour.green = static_cast<std::uint8_t>(255.0F * opacity);
  colour.blue = static_cast<std::uint8_t>(255.0 * std::min(1.0, transience));
}

/// The judgements of a chunk: of the ends of its bounded rays, and of all rays as passes, or none of those.
struct Judged {
  std::span<const JudgedEnd> ends;
  std::span<const float> passes;
};

/// Fills the columns and shares out the rows of a chunk.
void share_out(RayCloud& rays, const Judged& judged, const TransientRule& rule,
               const std::vector<ColumnInfo>& schema, std::vector<StreamPart>& parts) {
  for (const ColumnInfo& column : schema)
    if (rays.extra(column.name) == nullptr) rays.extras.emplace_back(column, rays.size());
  const auto opacities = rays.extra("opacity")->values<float>();
  const auto hits = rays.extra("hits")->values<std::uint16_t>();
  const auto passes = rays.extra("passes")->values<std::uint16_t>();
  const auto transiences = rays.extra("transience")->values<float>();
  for (std::size_t i = 0, next = 0; i < rays.size(); ++i) {
    const bool bounded = rays.bounded[i] != 0;
    const JudgedEnd end = bounded ? judged.ends[next++] : JudgedEnd{};
    opacities[i] = end.opacity;
    hits[i] = end.hits;
    passes[i] = end.passes;
    transiences[i] = std::max(end.transience, judged.passes.empty() ? 0.0F : judged.passes[i]);
    const double transience = static_cast<double>(transiences[i]);
    if (bounded && rule.colour)
      colour_by_evidence(rays.colours[i], end.opacity, end.passes, transience / rule.rays);
    parts[transience > rule.rays ? 1 : 0].rows.push_back(static_cast<std::uint32_t>(i));
  }
}

/// The last reading of the cloud. `prepare(rays, raw)`, on any thread, returns what `judge(rays, prepared)`,
/// in order, makes the judgements from.
template <class Prepare, class Judge>
TransientCounts write_judged(const Context& context, RaySource& source, RaySink& fixed, RaySink& transient,
                             const TransientRule& rule, const Prepare& prepare, const Judge& judge) {
  const std::vector<ColumnInfo> schema = transient_columns(source.info().extras);
  TransientCounts counts;
  counts.stream = stream_parts(
      context, source,
      [&](RayCloud& rays, const RawChunk& raw, std::vector<StreamPart>& parts) {
        parts.resize(2);
        parts[0].sink = &fixed;
        parts[1].sink = &transient;
        for (StreamPart& part : parts) {
          part.of_chunk = true;
          part.rows.clear();
        }
        return prepare(rays, raw);
      },
      [&](RayCloud& rays, auto& prepared, std::vector<StreamPart>& parts) {
        share_out(rays, judge(rays, prepared), rule, schema, parts);
        counts.fixed += parts[0].size();
        counts.transient += parts[1].size();
      });
  return counts;
}

TransientCounts split_whole(const Context& context, RaySource& source, RaySink& fixed, RaySink& transient,
                            ReadEnds&& ends, JudgeRule rule) {
  EllipsoidMaker maker(context, std::move(ends.points));
  RangeNoise noise(ends.sample.bounded, ends.reach);
  noise.add(context, maker.points(), {});
  rule.range_noise = noise.value();
  const JudgedBlock block(context, source, std::move(maker), rule);
  std::vector<JudgedEnd> judged;  // of a chunk
  std::size_t next = 0;
  return write_judged(
      context, source, fixed, transient, rule.transients,
      [&](const RayCloud& rays, const RawChunk&) {
        return block.judges_passes() ? block.judge_passes(rays) : std::vector<float>();
      },
      [&](const RayCloud& rays, const std::vector<float>& passes) {
        judged.clear();
        for (const std::uint8_t bounded : rays.bounded)
          if (bounded != 0) judged.push_back(block.end(next++));
        return Judged{judged, passes};
      });
}

using EndBlocks = blocks::SpilledBlocks<SeenPoint, JudgedEnd>;

/// Sends the ends of all rays to blocks. `sort(rays, ends)`, on any thread, says to which.
template <class Sort>
void spill_ends(const Context& context, RaySource& source, EndBlocks& spilled, const Sort& sort) {
  stream(
      context, source, nullptr,
      [&](const RayCloud& rays) { return sort(rays, blocks::extract_all<SeenPoint>(rays, seen_end)); },
      [&](const RayCloud&, const blocks::Copies<SeenPoint>& copies) { spilled.add(copies); });
  source.rewind();
}

/// Ends go to the blocks of space that need them, on disk: first to find how far what each block depends on
/// reaches, then by that. Each block is judged by all rays of the cloud that go through it.
TransientCounts split_in_blocks(const Context& context, RaySource& source, RaySink& fixed, RaySink& transient,
                                const ReadEnds& ends, JudgeRule rule) {
  constexpr std::size_t kMostBlocks = 1024;
  const std::size_t memory = memory_budget(context);
  // What lies around a block takes room too.
  const std::size_t parts = std::min(2 * (ends.sample.bounded * kJudgedPointBytes / memory + 1), kMostBlocks);
  JudgementCells cells(ends.reach);
  {
    RangeNoise noise(ends.sample.bounded, ends.reach);
    EndBlocks near(ends.sample, parts, ends.reach, memory);
    spill_ends(context, source, near, [&](const RayCloud& rays, const std::vector<SeenPoint>& points) {
      return near.sort(rays, points);
    });
    near.visit(context, [&](Block<SeenPoint>&& block, std::size_t part) {
      const PointTree points(context, block.records);
      noise.add(context, points, block.own);
      cells.add(context, points, block.own, part);
    });
    rule.range_noise = noise.value();
  }
  cells.find_parts(rule.range_noise);
  EndBlocks spilled(ends.sample, parts, ends.reach, memory);
  spill_ends(context, source, spilled, [&](const RayCloud& rays, const std::vector<SeenPoint>& points) {
    return spilled.sort(rays, points, [&](const Eigen::Vector3d& end) { return cells.parts_for(end); });
  });

  std::vector<float> passes;
  spilled.compute(context, [&](const Context&, Block<SeenPoint>&& records, double) {
    const std::vector<std::uint8_t> own = std::move(records.own);
    JudgedBlock block(context, source, EllipsoidMaker(context, std::move(records.records)), rule);
    if (block.judges_passes()) {
      passes.resize(ends.rows);
      block.keep_passes_of(own);
      each_chunk(context, source, [&](const RayCloud& rays, const RawChunk& raw) {
        const std::vector<float> of_chunk = block.judge_passes(rays);
        const auto of_cloud = passes.begin() + static_cast<std::ptrdiff_t>(raw.first_row);
        std::transform(of_chunk.begin(), of_chunk.end(), of_cloud, of_cloud,
                       [](float a, float b) { return std::max(a, b); });
      });
    }
    std::vector<JudgedEnd> judged(own.size());
    for (std::size_t i = 0; i < own.size(); ++i)
      if (own[i] != 0) judged[i] = block.end(i);
    return judged;
  });

  struct Where {
    std::uint64_t first_row;
    std::vector<std::uint32_t> parts;
  };
  return write_judged(
      context, source, fixed, transient, rule.transients,
      [&](const RayCloud& rays, const RawChunk& raw) {
        Where where{raw.first_row, {}};
        for (std::size_t i = 0; i < rays.size(); ++i)
          if (rays.bounded[i] != 0)
            where.parts.push_back(static_cast<std::uint32_t>(spilled.part_of(rays.ends[i])));
        return where;
      },
      [&](const RayCloud& rays, const Where& where) {
        return Judged{spilled.take(where.parts),
                      passes.empty() ? std::span<const float>()
                                     : std::span<const float>(passes).subspan(where.first_row, rays.size())};
      });
}

}  // namespace

std::vector<ColumnInfo> transient_columns(std::vector<ColumnInfo> source) {
  for (const ColumnInfo& column : kTransientColumns) {
    const auto known = std::find_if(source.begin(), source.end(),
                                    [&](const ColumnInfo& other) { return other.name == column.name; });
    if (known == source.end())
      source.push_back(column);
    else if (known->type != column.type)
      throw Error(ErrorCode::wrong_content, "the column " + column.name + " is " +
                                                std::string(name_of(known->type)) + ", not " +
                                                std::string(name_of(column.type)));
  }
  return source;
}

TransientCounts split_transients(const Context& context, RaySource& source, RaySink& fixed,
                                 RaySink& transient, const TransientRule& rule) {
  if (!(rule.rays > 0.0) || !std::isfinite(rule.rays))
    throw Error(ErrorCode::usage, "the number of rays must be above 0");
  const std::size_t memory = memory_budget(context);
  ReadEnds ends = read_ends(context, source, memory / kJudgedPointBytes);
  if (ends.rays > 1 && ends.sample.bounded > 0 && !(ends.first_time < ends.last_time))
    throw Error(ErrorCode::no_data,
                "all rays have the same time: without an order in time nothing can be told to come or go");
  const JudgeRule judge{rule, ends.reach, 0.0, TimeScale(ends.first_time, ends.last_time)};
  return ends.fits() ? split_whole(context, source, fixed, transient, std::move(ends), judge)
                     : split_in_blocks(context, source, fixed, transient, ends, judge);
}

}  // namespace ray
