#pragma once
/// What moves about, standing on z = 0 at the origin and facing +x.

#include <raycloud/core/mesh.h>

namespace ray {

/// 1.75 m tall, in mid-step.
[[nodiscard]] Mesh person_mesh();
/// A car of 4.2 m.
[[nodiscard]] Mesh vehicle_mesh();

}  // namespace ray
