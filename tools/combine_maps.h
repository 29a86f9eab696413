#pragma once
/// What the forms of raycombine that merge share.

#include "cli/cli.h"

#include <raycloud/filter/combine.h>
#include <raycloud/volume/merge_clouds.h>

#include <string>
#include <vector>

namespace ray::tools {

/// The clouds of these files.
[[nodiscard]] CombinedSource open_all(const std::vector<std::string>& files);

/// Says what is to be said of clouds that are put together.
void tell_of(const CombinedSource& source, cli::Session& session);

/// The merge that a word stands for.
[[nodiscard]] CloudMerge merge_of(const std::string& word);

/// Merges the clouds and writes CLOUD1_combined and, unless the result takes the place of one of them,
/// CLOUD1_differences.
void merge_files(const cli::Match& match, cli::Session& session, const std::vector<std::string>& files,
                 const MergeRule& rule);

/// Merges two branches of a map: the files are the map and the two. A map without a byte is one without rays,
/// which is how git tells that the branches have none in common. Writes as above, but no differences for
/// `all`.
void merge_branches(const cli::Match& match, cli::Session& session, const std::vector<std::string>& files,
                    const MergeRule& rule);

}  // namespace ray::tools
