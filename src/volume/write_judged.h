#pragma once
/// The last reading of a cloud of which all is judged.

#include "judgement.h"

#include <raycloud/exec/stream_parts.h>
#include <raycloud/volume/transients.h>

#include <span>
#include <vector>

namespace ray {

/// The judgements of a chunk: of the ends of its bounded rays, and of all rays as passes, or none of those.
struct JudgedChunk {
  std::span<const JudgedEnd> ends;
  std::span<const float> passes;
};

/// Fills the columns and shares out the rows of a chunk.
void share_out(RayCloud& rays, const JudgedChunk& judged, const TransientRule& rule,
               const std::vector<ColumnInfo>& schema, std::vector<StreamPart>& parts);

/// `prepare(rays, raw)`, on any thread, returns what `judge(rays, prepared)`, in order, makes the judgements
/// from.
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

}  // namespace ray
