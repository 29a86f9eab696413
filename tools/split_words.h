#pragma once
/// The ways to split a cloud in two, in words: what raysplit and a pipe have in common.

#include "cli/command.h"
#include "cli/match.h"

#include <raycloud/filter/split.h>

#include <string>
#include <vector>

namespace ray::tools {

/// The usages with an inside and an outside; each has a name.
[[nodiscard]] std::vector<cli::Usage> split_in_two_usages();

/// The rule that a match of one of them asks for. Rules that need the whole cloud first (a share of the time,
/// the gap) read `source` and rewind it. `notes` gets what the user should hear of a mesh.
[[nodiscard]] SplitRulePtr split_rule(const cli::Match& match, const Context& context, RaySource& source,
                                      std::vector<std::string>& notes);

}  // namespace ray::tools
