#pragma once
/// The height of a mesh at a place of the map, and clouds lifted onto a ground or set down from it.

#include <raycloud/core/mesh.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/stream.h>

#include <cstdint>
#include <memory>

namespace ray {

/// The height at a place.
struct HeightAt {
  double height = 0.0;  ///< m
  bool beyond = false;  ///< no face is above or below the place: the height is that of the nearest rim
};

/// Finds heights in O(1) for faces of like size. Where faces lie above each other the highest counts. A rim
/// is an edge that has faces on one side only as seen from above: the border of a ground, the outline of a
/// closed body.
class MeshHeight {
 public:
  /// Throws Error(no_data) if no face can be seen from above (all are vertical, or have no area). O(n log n);
  /// some 150 bytes a face.
  explicit MeshHeight(const Mesh& mesh);
  ~MeshHeight();
  MeshHeight(MeshHeight&&) noexcept;
  MeshHeight& operator=(MeshHeight&&) noexcept;

  /// Exact at vertices and without steps at edges. Thread-safe.
  [[nodiscard]] HeightAt at(double x, double y) const;

  [[nodiscard]] std::size_t faces_without_area() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct HeightShift {
  StreamCounts stream;
  std::uint64_t beyond = 0;  ///< rays whose ends are beyond the mesh
};

/// Adds to the z of every start and end `factor` times the height of the mesh there: 1 lifts a cloud onto a
/// ground, −1 makes the ground flat. One undoes the other to rounding, as x and y stay. Rays stay straight: a
/// long one over rough ground no longer passes over it where it did.
///
/// Streaming; memory: the chunks. The result depends on neither threads nor chunks. Leaves
/// `sink->finish()` to the caller.
HeightShift shift_by_height(const Context& context, RaySource& source, RaySink& sink, const MeshHeight& mesh,
                            double factor);

}  // namespace ray
