#pragma once
/// A tree of boxes around the faces of a mesh, to find the nearest.
///
/// Embree, which the project has for rays, has a point query too; with it the same work took half again as
/// long, and results had to be kept from depending on its single precision.

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
  /// Precondition: at least one face; every face has an area. O(n log n); 250 bytes a face.
  explicit FaceTree(const Mesh& mesh);

  /// The nearest face, of several at the same distance the first; or any face whose squared distance is less
  /// than `enough`. `near` is what was found for a point that may be near: a better one is quicker, and the
  /// result is the same.
  [[nodiscard]] NearestFace find(const Eigen::Vector3d& point, std::uint32_t near,
                                 double enough = -1.0) const;

 private:
  static constexpr std::uint32_t kLeafFaces = 4;
  /// Around the centre of the mesh, and no smaller than what is in it. Single precision, as there are many.
  struct Box {
    std::array<float, 3> low{}, high{};
  };
  /// Each of two children is a node, or faces [first, first + count).
  struct Node {
    Box boxes[2];
    std::uint32_t child[2] = {0, 0};
    std::uint32_t first[2] = {0, 0};
    std::uint32_t count[2] = {0, 0};  ///< 0: the child is a node
  };
  struct Leaf {
    Corners corners;
    std::uint32_t face = 0;
  };
  struct Part;

  Part build(std::uint32_t begin, std::uint32_t end, const std::vector<Eigen::Vector3d>& centres);
  [[nodiscard]] Bounds bounds_of(std::uint32_t begin, std::uint32_t end) const;
  [[nodiscard]] Box boxed(const Bounds& bounds) const;
  static double squared_distance(const Box& box, const Eigen::Vector3d& local);

  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;           ///< in the order of the tree
  std::vector<Box> boxes_;             ///< of each leaf
  std::vector<std::uint32_t> places_;  ///< of each face in `leaves_`
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  double slack_ = 0.0;  ///< m²; what rounding may do to a distance
};

}  // namespace ray
