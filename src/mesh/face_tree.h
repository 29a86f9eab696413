#pragma once
/// A tree of boxes around the faces of a mesh, to find the nearest.
///
/// Embree, which the project has for rays, has a point query too; with it the same work took half again as
/// long as with a plain tree of two boxes a node, and results had to be kept from depending on its single
/// precision.

#include "nearest_on_triangle.h"

#include <raycloud/core/bounds.h>

#include <array>
#include <cstdint>
#include <vector>

namespace ray {

struct NearestFace {
  NearestPlace nearest;
  std::uint32_t face = 0;
};

class FaceTree {
 public:
  /// Precondition: at least one face; every face has an area. O(n log n); 150 bytes a face. At most 2^31
  /// faces.
  explicit FaceTree(const Mesh& mesh);

  static constexpr std::uint32_t kNoFace = 0xFFFFFFFFu;

  /// The nearest face, of several at the same distance the first. `near` is what was found for a point that
  /// may be near: a better one is quicker, and the result is the same.
  [[nodiscard]] NearestFace find(const Eigen::Vector3d& point, std::uint32_t near) const;

  /// The same among faces at a squared distance up to `most`: kNoFace if there is none; or any face whose
  /// squared distance is less than `enough`. The quicker the smaller `most` is. `near` may be kNoFace.
  [[nodiscard]] NearestFace find_within(const Eigen::Vector3d& point, std::uint32_t near, double most,
                                        double enough) const;

 private:
  static constexpr std::size_t kWide = 4;
  static constexpr std::uint32_t kFaceBit = std::uint32_t{1} << 31;
  using Wide = std::array<float, kWide>;
  /// Boxes around the centre of the mesh, no smaller than what is in them, side by side and in single
  /// precision.
  struct Node {
    std::array<Wide, 3> low{}, high{};
    std::array<std::uint32_t, kWide> child{};  ///< a node, or with kFaceBit a place in `faces_`
    std::uint32_t count = 0;
  };
  struct Leaf {
    Corners corners;
    std::uint32_t face = 0;
    double spread = 0.0;  ///< m²; a third of the square of the longest side
  };
  struct Search;
  void run(Search& search, double enough) const;

  /// Makes the node of faces [begin, end) and returns its place; `bounds` gets what it holds.
  std::uint32_t build(std::uint32_t begin, std::uint32_t end, const std::vector<Eigen::Vector3d>& centres,
                      Bounds& bounds);
  std::uint32_t split(std::uint32_t begin, std::uint32_t end, const std::vector<Eigen::Vector3d>& centres);
  void set_child(Node& node, std::uint32_t child, const Bounds& bounds) const;

  std::vector<Node> nodes_;
  std::vector<Leaf> faces_;            ///< in the order of the tree
  std::vector<std::uint32_t> places_;  ///< of each face in `faces_`
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  double half_size_ = 0.0;
};

}  // namespace ray
