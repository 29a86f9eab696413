#include "combine_maps.h"

#include "cloud_to_cloud.h"
#include "step.h"

#include <raycloud/core/error.h>
#include <raycloud/io/ray_cloud_file.h>

#include <algorithm>
#include <array>
#include <system_error>

namespace ray::tools {
namespace {

using Sources = std::vector<std::unique_ptr<RaySource>>;

/// Whether both names lead to one file.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  return std::filesystem::equivalent(a, b, error) && !error;
}

std::string number_of_rays(std::uint64_t count) {
  return std::to_string(count) + (count == 1 ? " ray" : " rays");
}

void tell_counts(const MergeCounts& counts, cli::Session& session) {
  note_dropped(session, counts.stream.dropped);
  if (counts.repeated > 0)
    session.note(number_of_rays(counts.repeated) + " that another cloud has too came once");
  session.note(number_of_rays(counts.differences) + " gave way");
}

}  // namespace

CombinedSource open_all(const std::vector<std::string>& files) {
  std::vector<CloudToCombine> clouds;
  for (const std::string& file : files)
    clouds.push_back({file, [file] { return open_ray_cloud(file); }});
  return CombinedSource(std::move(clouds));
}

void tell_of(const CombinedSource& source, cli::Session& session) {
  for (const std::string& warning : source.warnings())
    session.warn(warning);
  for (const std::string& note : source.notes())
    session.note(note);
}

CloudMerge merge_of(const std::string& word) {
  static constexpr std::array kWords{"all", "min", "max", "oldest", "newest", "order"};
  return static_cast<CloudMerge>(std::find(kWords.begin(), kWords.end(), word) - kWords.begin());
}

void merge_files(const cli::Match& match, cli::Session& session, const std::vector<std::string>& files,
                 const MergeRule& rule) {
  const CombinedSource source = open_all(files);
  tell_of(source, session);
  std::vector<std::filesystem::path> outputs{cli::main_output(match, files.front(), "_combined")};
  const bool in_place = std::any_of(
      files.begin(), files.end(), [&](const std::string& file) { return same_file(file, outputs.front()); });
  if (!in_place) {
    const std::filesystem::path stem =
        match.has("--output") ? outputs.front() : std::filesystem::path(files.front());
    outputs.push_back(cli::output_name(stem, "_differences"));
  }
  Sources sources;
  std::vector<RaySource*> clouds;
  for (std::size_t i = 0; i < source.cloud_count(); ++i) {
    sources.push_back(source.alone(i));
    clouds.push_back(sources.back().get());
  }
  OutputPrecision precision(outputs.size());
  MergeCounts counts;
  const auto write_once = [&] {
    std::vector<std::unique_ptr<RaySink>> sinks;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      CloudInfo info = precision.widened(i, source.info());
      info.history.push_back(session.history());
      sinks.push_back(precision.watch(i, create_ray_cloud(outputs[i], info, {.flush_to_disk = in_place})));
    }
    counts = merge_clouds(session.context(), clouds, *sinks.front(), in_place ? nullptr : sinks.back().get(),
                          rule);
    for (const auto& sink : sinks)
      sink->finish();
  };
  while (true) {
    try {
      write_once();
      break;
    } catch (const PrecisionLoss&) {
      for (RaySource* cloud : clouds)
        cloud->rewind();  // each time one more of the outputs is double
    }
  }
  tell_counts(counts, session);
  session.summary({.rays_in = counts.stream.rays_in, .rays_out = counts.combined, .files = outputs});
}

}  // namespace ray::tools
