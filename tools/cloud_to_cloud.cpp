#include "cloud_to_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/io/ray_cloud_file.h>

#include <string>

namespace ray::tools {

namespace {

StreamCounts stream_once(const CloudToCloud& files, const CloudInfo& info, RaySource& source,
                         const StreamingCall& call) {
  const auto sink = create_ray_cloud(files.output, info);
  const StreamCounts counts = call(source, *sink);
  sink->finish();
  return counts;
}

}  // namespace

void run_cloud_to_cloud(cli::Session& session, const CloudToCloud& files, const StreamingCall& call) {
  const auto source = open_ray_cloud(files.input);
  CloudInfo info = source->info();
  info.history.push_back(session.history());
  if (files.describe) files.describe(info);
  StreamCounts counts;
  try {
    counts = stream_once(files, info, *source, call);
  } catch (const PrecisionLoss&) {
    source->rewind();
    info.precision = Precision::double_;
    counts = stream_once(files, info, *source, call);
  }
  note_dropped(session, counts.dropped);
  session.summary({.rays_in = counts.rays_in, .rays_out = counts.rays_out, .files = {files.output}});
}

void note_dropped(cli::Session& session, std::uint64_t dropped) {
  if (dropped == 0) return;
  session.note(std::to_string(dropped) + (dropped == 1 ? " ray" : " rays") +
               " with NaN or infinite values left out");
}

}  // namespace ray::tools
