#include "cloud_to_cloud.h"
#include "steps/split.h"
#include "steps/steps.h"

#include <raycloud/core/error.h>
#include <raycloud/filter/partition.h>
#include <raycloud/io/ray_cloud_file.h>

#include <utility>

namespace {

using namespace ray::cli;
using std::filesystem::path;

/// `split(info)` until the precision is enough.
template <class Split>
auto in_enough_precision(ray::CloudInfo info, ray::RaySource& source, const Split& split) {
  try {
    return split(info);
  } catch (const ray::PrecisionLoss&) {
    source.rewind();
    info.precision = ray::Precision::double_;
    return split(info);
  }
}

ray::PartitionRulePtr partition_rule(const Match& match, Session& session, ray::RaySource& source) {
  if (match.usage() == "grid") {
    const std::vector<double>& widths = match.components("WX,WY,WZ[,WT]");
    return ray::partition_by_grid({.widths = match.vector("WX,WY,WZ[,WT]"),
                                   .period = widths.size() > 3 ? widths[3] : 0.0,
                                   .overlap = match.has("OVERLAP") ? match.number("OVERLAP") : 0.0,
                                   .stored = source.info().precision});
  }
  const std::size_t colours = ray::count_colours(session.context(), source);
  source.rewind();
  if (colours > ray::kMostParts) {
    throw ray::Error(ray::ErrorCode::out_of_range,
                     match.text("CLOUD") + ": has " + std::to_string(colours) + " colours: at most " +
                         std::to_string(ray::kMostParts) + " can have a cloud each");
  }
  return ray::partition_by_colour();
}

/// What is added to the name of the cloud.
std::string part_suffix(const Match& match, const ray::PartKey& key) {
  if (match.usage() == "segments") return "_" + std::to_string(key[0] + 256 * key[1] + 65536 * key[2]);
  std::string suffix;
  for (std::size_t axis = 0; axis < key.size(); ++axis) {
    bool split = axis < 3;
    if (match.usage() == "grid") {
      const std::vector<double>& widths = match.components("WX,WY,WZ[,WT]");
      split = axis < widths.size() && widths[axis] > 0.0;
    }
    if (split) suffix += "_" + std::to_string(key[axis]);
  }
  return suffix;
}

void split_in_parts(const Match& match, Session& session) {
  constexpr std::size_t kChunkRays = 8192;  // few, as each has pieces
  const auto opened = ray::open_ray_cloud(match.text("CLOUD"), {.chunk_rays = kChunkRays});
  ray::RaySource& source = *opened;
  ray::CloudInfo info = source.info();
  info.history.push_back(session.history());
  const path base = main_output(match, match.text("CLOUD"), "");
  const auto name_of = [&](const ray::PartKey& key) { return output_name(base, part_suffix(match, key)); };
  const ray::PartitionRulePtr rule = partition_rule(match, session, source);
  info.extras = rule->columns(std::move(info.extras));
  const auto partition = in_enough_precision(info, source, [&](const ray::CloudInfo& written) {
    const auto make_sink = [&](const ray::PartKey& key) {
      return ray::create_ray_cloud(name_of(key), written, {.close_between_writes = true});
    };
    ray::Partition parts = ray::partition_cloud(session.context(), source, *rule, make_sink);
    for (const auto& [key, part] : parts.parts)
      part.sink->finish();
    return parts;
  });
  ray::tools::note_dropped(session, partition.stream.dropped);
  if (partition.parts.empty()) session.note("no rays, so no clouds are written");
  std::vector<path> files;
  for (const auto& [key, part] : partition.parts)
    files.push_back(name_of(key));
  session.summary({.rays_in = partition.stream.rays_in,
                   .rays_out = partition.stream.rays_out,
                   .files = std::move(files)});
}

void run(const Match& match, Session& session) {
  if (ray::tools::splits_in_parts(match))
    split_in_parts(match, session);
  else
    run_step(ray::tools::kSplitStep, match, session);
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(ray::tools::kSplitStep.command, run, argc, argv);
}
