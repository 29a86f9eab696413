#pragma once
/// Which side of a mesh is its front.

#include "edges.h"

namespace ray {

/// Turns faces so that those on both sides of an edge agree, as far as they can (edges of three faces or more
/// and one-sided surfaces cannot); then all of a mesh that is closed and encloses a negative volume, or open
/// with every face looking down. Each connected part keeps the front of its first face until then.
/// `sides`, those of the mesh, stay so.
void orient(Mesh& mesh, std::vector<FaceSide>& sides);

}  // namespace ray
