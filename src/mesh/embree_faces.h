#pragma once
/// The nearest face of a mesh, by the point queries of Embree.

#include "nearest_on_triangle.h"

#include <cstdint>
#include <memory>

namespace ray {

struct NearestFace {
  NearestPlace nearest;
  std::uint32_t face = 0;
};

/// Embree finds the boxes that are near enough. What is nearest, and where, is decided here in double
/// precision, so that Embree's version, the processor's instructions and the shape of the tree do not show in
/// a result.
class EmbreeFaces {
 public:
  /// Precondition: at least one face; every face has an area. O(n log n); 200 bytes a face. At most 2^31
  /// faces. Throws Error, if memory does not suffice.
  explicit EmbreeFaces(const Mesh& mesh);
  ~EmbreeFaces();
  EmbreeFaces(const EmbreeFaces&) = delete;
  EmbreeFaces& operator=(const EmbreeFaces&) = delete;

  static constexpr std::uint32_t kNoFace = 0xFFFFFFFFu;

  /// The nearest face, of several at the same distance the first. `near` is what was found for a point that
  /// may be near: a better one is quicker, and the result is the same.
  [[nodiscard]] NearestFace find(const Eigen::Vector3d& point, std::uint32_t near) const;

  /// The same among faces at a squared distance up to `most`: kNoFace if there is none; or any face whose
  /// squared distance is less than `enough`. The quicker the smaller `most` is. `near` may be kNoFace.
  [[nodiscard]] NearestFace find_within(const Eigen::Vector3d& point, std::uint32_t near, double most,
                                        double enough) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace ray
