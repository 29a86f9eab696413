#pragma once
/// A first look at the end points of a cloud.

#include <raycloud/core/bounds.h>
#include <raycloud/exec/stream.h>

namespace ray {

struct EndsSurvey {
  Bounds bounds;              ///< of the ends of bounded rays
  std::uint64_t bounded = 0;  ///< rays
  StreamCounts stream;
};

/// Reads the source to its end.
[[nodiscard]] inline EndsSurvey survey_ends(const Context& context, RaySource& source) {
  EndsSurvey survey;
  survey.stream = stream(
      context, source, nullptr,
      [](RayCloud& rays) {
        EndsSurvey part;
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (rays.bounded[i] == 0) continue;
          part.bounds.add(rays.ends[i]);
          ++part.bounded;
        }
        return part;
      },
      [&](RayCloud&, const EndsSurvey& part) {
        survey.bounds.add(part.bounds);
        survey.bounded += part.bounded;
      });
  survey.stream.rays_out = 0;
  return survey;
}

}  // namespace ray
