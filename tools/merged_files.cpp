#include "merged_files.h"

#include "step.h"

#include <raycloud/io/ray_cloud_file.h>

#include <memory>
#include <system_error>

namespace ray::tools {
namespace {

/// Whether both names lead to one file.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  return std::filesystem::equivalent(a, b, error) && !error;
}

MergeCounts write_once(cli::Session& session, const ToMerge& merge, const MergeRule& rule,
                       const MergedFiles& files, OutputPrecision& precision) {
  std::vector<std::unique_ptr<RaySink>> sinks;
  for (std::size_t i = 0; i < files.names.size(); ++i) {
    CloudInfo info = precision.widened(i, merge.info);
    info.history.push_back(session.history());
    sinks.push_back(precision.watch(
        i,
        create_ray_cloud(files.names[i], info, {.flush_to_disk = files.in_place, .format = files.format})));
  }
  if (merge.kept != nullptr)
    stream_each(session.context(), *merge.kept, *sinks.front(), [](const RayCloud&) {});
  const MergeCounts counts = merge_clouds(session.context(), merge.clouds, *sinks.front(),
                                          sinks.size() > 1 ? sinks.back().get() : nullptr, rule);
  for (const auto& sink : sinks)
    sink->finish();
  return counts;
}

}  // namespace

MergedFiles merged_files(const cli::Match& match, const std::vector<std::string>& inputs, bool differences) {
  const std::filesystem::path& input = inputs.front();
  MergedFiles files;
  files.names.push_back(cli::main_output(match, input, "_combined"));
  for (const std::string& file : inputs) {
    if (!same_file(file, files.names.front())) continue;
    files.in_place = true;
    files.format = cloud_format(file);
  }
  if (differences && !files.in_place)
    files.names.push_back(
        cli::output_name(match.has("--output") ? files.names.front() : input, "_differences"));
  return files;
}

MergeCounts write_merged(cli::Session& session, const ToMerge& merge, const MergeRule& rule,
                         const MergedFiles& files) {
  OutputPrecision precision(files.names.size());
  while (true) {
    try {
      return write_once(session, merge, rule, files, precision);
    } catch (const PrecisionLoss&) {
      // Each time one more of the outputs is double.
      if (merge.kept != nullptr) merge.kept->rewind();
      for (RaySource* cloud : merge.clouds)
        cloud->rewind();
    }
  }
}

}  // namespace ray::tools
