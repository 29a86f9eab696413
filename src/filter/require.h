#pragma once
/// Preconditions of what users choose.

#include <raycloud/core/error.h>

namespace ray {

/// Throws Error(usage) with the message unless `sensible`.
inline void require(bool sensible, const char* message) {
  if (!sensible) throw Error(ErrorCode::usage, message);
}

}  // namespace ray
