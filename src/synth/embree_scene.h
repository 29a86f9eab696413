#pragma once
/// Embree, which nothing else of this room knows, finds the triangles near a ray. Which of them is hit,
/// and where, is decided here in double precision, so that Embree's version, the processor's instructions and
/// the shape of the tree do not show in a result.

#include <raycloud/core/mesh.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace ray {

struct EmbreePart {
  const Mesh* mesh = nullptr;  ///< not owned
  double from = 0.0;           ///< s; there from this time on
  double until = 0.0;          ///< s; and no longer at this one
};

struct EmbreeHit {
  double range = 0.0;      ///< m
  std::uint32_t part = 0;  ///< index of the part
  std::uint32_t face = 0;
};

class EmbreeScene {
 public:
  /// Built on all cores. Parts without faces are allowed. Throws Error(out_of_range) where there is not
  /// enough memory.
  explicit EmbreeScene(const std::vector<EmbreePart>& parts);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// The nearest triangle within `longest` of the parts that are there at `time`; of several at the same
  /// range that of the first part, then the first face. `direction` has unit length. Thread-safe. Ranges up
  /// to 1 km are found surely.
  [[nodiscard]] std::optional<EmbreeHit> nearest(const Eigen::Vector3d& origin,
                                                 const Eigen::Vector3d& direction, double longest,
                                                 double time) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ray
