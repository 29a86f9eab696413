#pragma once
/// What rayalign prints and writes of a transform.

#include <raycloud/align/axes.h>
#include <raycloud/align/clouds.h>
#include <raycloud/core/bend.h>
#include <raycloud/core/pose.h>
#include <raycloud/io/transform_file.h>

#include <string>

namespace ray::tools {

/// A transform, and what is known of it: lines to print, and lines for its file.
struct Found {
  Pose pose;
  Bend bend;  ///< follows the pose
  std::string report;
  TransformNotes notes;
};

[[nodiscard]] Found found(const AxesAlignment& alignment);
/// `nonrigid`: a bend was looked for.
[[nodiscard]] Found found(const CloudAlignment& alignment, bool nonrigid);

/// The matrix, the rotation vector, the translation and the report.
[[nodiscard]] std::string as_text(const Found& found);

}  // namespace ray::tools
