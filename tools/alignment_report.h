#pragma once
/// What rayalign prints and writes of a transform.

#include <raycloud/align/axes.h>
#include <raycloud/align/clouds.h>
#include <raycloud/core/pose.h>

#include <string>

namespace ray::tools {

/// The matrix, the rotation vector and the translation, in seven lines.
[[nodiscard]] std::string as_text(const Pose& pose);

/// What is known of the axes.
[[nodiscard]] std::string as_text(const AxesAlignment& alignment);

/// How well the cloud lies on the reference.
[[nodiscard]] std::string as_text(const CloudAlignment& alignment);

}  // namespace ray::tools
