#include "outside_neighbours.h"

#include <raycloud/core/error.h>

namespace ray {

Denoised outside_neighbours(const Context&, RaySource&, RaySink&, double) {
  throw Error(ErrorCode::usage, "not built yet");
}

}  // namespace ray
