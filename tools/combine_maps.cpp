#include "combine_maps.h"

#include "cli/grouped.h"
#include "cloud_to_cloud.h"
#include "merged_files.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/io/ray_cloud_file.h>
#include <raycloud/volume/three_way.h>

#include <algorithm>
#include <array>
#include <system_error>

namespace ray::tools {
namespace {

using Sources = std::vector<std::unique_ptr<RaySource>>;

std::string number_of_rays(std::uint64_t count) {
  return cli::grouped(count) + (count == 1 ? " ray" : " rays");
}

Sources each_alone(const CombinedSource& source) {
  Sources sources;
  for (std::size_t i = 0; i < source.cloud_count(); ++i)
    sources.push_back(source.alone(i));
  return sources;
}

std::vector<RaySource*> pointers_to(const Sources& sources) {
  std::vector<RaySource*> pointers;
  for (const auto& source : sources)
    pointers.push_back(source.get());
  return pointers;
}

/// An empty file instead of a map.
bool is_no_map(const std::string& file) {
  std::error_code error;
  return std::filesystem::is_regular_file(file, error) && std::filesystem::file_size(file, error) == 0;
}

ThreeWayColumns columns_of(const std::vector<std::string>& files, bool no_map) {
  ThreeSchemas schemas;
  for (std::size_t i = no_map ? 1 : 0; i < schemas.size(); ++i)
    schemas[i] = open_ray_cloud(files[i])->info().extras;
  if (!no_map) return three_way_columns(schemas);
  ThreeWayColumns columns;
  for (const auto& schema : schemas)
    for (const ColumnInfo& column : schema)
      if (std::find(columns.result.begin(), columns.result.end(), column.name) == columns.result.end())
        columns.result.push_back(column.name);
  return columns;
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
  const Sources sources = each_alone(source);
  const MergedFiles outputs = merged_files(match, files, true);
  const MergeCounts counts =
      write_merged(session, {.info = source.info(), .clouds = pointers_to(sources)}, rule, outputs);
  note_dropped(session, counts.stream.dropped);
  if (counts.repeated > 0)
    session.note(number_of_rays(counts.repeated) + " that another cloud has too came once");
  session.note(number_of_rays(counts.differences) + " gave way");
  session.summary({.rays_in = counts.stream.rays_in, .rays_out = counts.combined, .files = outputs.names});
}

void merge_branches(const cli::Match& match, cli::Session& session, const std::vector<std::string>& files,
                    const MergeRule& rule) {
  const bool no_map = is_no_map(files.front());
  const CombinedSource source = open_all(no_map ? std::vector(files.begin() + 1, files.end()) : files);
  for (const std::string& warning : source.warnings())
    session.warn(warning);
  RayCloud no_rays;
  no_rays.set_schema(source.info().extras);
  Sources sources = each_alone(source);
  if (no_map) {
    CloudInfo info = source.info();
    info.ray_count = 0;
    sources.insert(sources.begin(), std::make_unique<MemorySource>(no_rays, info));
  }
  const ThreeWay parts(session.context(), {sources[0].get(), sources[1].get(), sources[2].get()},
                       columns_of(files, no_map));
  const auto kept = parts.kept(), added1 = parts.added(0), added2 = parts.added(1);
  const MergedFiles outputs = merged_files(match, files, rule.merge != CloudMerge::all);
  CloudInfo info = source.info();
  info.extras = kept->info().extras;
  const MergeCounts merged = write_merged(
      session, {.info = info, .kept = kept.get(), .clouds = {added1.get(), added2.get()}}, rule, outputs);
  const ThreeWay::Counts& counts = parts.counts();
  session.note(number_of_rays(counts.kept) + " as before, " + cli::grouped(counts.base - counts.kept) +
               " removed, " + cli::grouped(counts.added[0]) + " and " + cli::grouped(counts.added[1]) +
               " added" +
               (merged.repeated > 0 ? ", " + cli::grouped(merged.repeated) + " of these by both" : ""));
  if (rule.merge != CloudMerge::all) session.note(number_of_rays(merged.differences) + " gave way");
  session.summary(
      {.rays_in = counts.rays, .rays_out = counts.kept + merged.combined, .files = outputs.names});
}

}  // namespace ray::tools
