#pragma once
/// The figures of a cloud as a table for people and as JSON for programs.

#include <raycloud/core/cloud_info.h>
#include <raycloud/filter/cloud_summary.h>

#include <string>
#include <vector>

namespace ray::tools {

struct InfoReport {
  std::string file;
  CloudInfo info;
  CloudSummary summary;
  bool checked = false;               ///< whether the origins were audited
  std::vector<std::string> findings;  ///< of the audit, one line each
};

[[nodiscard]] std::string as_text(const InfoReport& report);

/// One object, ending in a newline. Keys are as in docs/commands/rayinfo.md; metres and seconds.
[[nodiscard]] std::string as_json(const InfoReport& report);

}  // namespace ray::tools
