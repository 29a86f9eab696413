#pragma once
/// Where a merge of maps goes: the result and, unless it takes the place of one of the clouds, the
/// differences.

#include "cli/cli.h"

#include <raycloud/core/ray_stream.h>
#include <raycloud/volume/merge_clouds.h>

#include <filesystem>
#include <string>
#include <vector>

namespace ray::tools {

struct ToMerge {
  CloudInfo info;             ///< of the result
  RaySource* kept = nullptr;  ///< rays that come before all others, if any
  std::vector<RaySource*> clouds;
};

/// The result and, if there is one, the differences.
struct MergedFiles {
  std::vector<std::filesystem::path> names;
  bool in_place = false;
  std::string format;  ///< in place, that of the file
};

[[nodiscard]] MergedFiles merged_files(const cli::Match& match, const std::vector<std::string>& inputs,
                                       bool differences);

/// Merges and writes, each file in the precision that it needs.
MergeCounts write_merged(cli::Session& session, const ToMerge& merge, const MergeRule& rule,
                         const MergedFiles& files);

}  // namespace ray::tools
