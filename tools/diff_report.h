#pragma once
/// What is different between two clouds as a table for people and as JSON for programs.

#include <raycloud/volume/compare_clouds.h>

#include <string>

namespace ray::tools {

[[nodiscard]] std::string as_text(const CloudComparison& comparison);

/// One object, ending in a newline. Keys are as in docs/algorithms/differences.md; metres.
[[nodiscard]] std::string as_json(const CloudComparison& comparison);

}  // namespace ray::tools
