#pragma once
/// Convex hulls, built point by point: triangles that close to a sphere, those that the new point sees
/// replaced by a fan around it. What a point sees is exact (whole numbers), so nothing can go wrong: no edge
/// is split, no face twice, and points that are not strictly outside change nothing.
///
/// Geometry says what the points are:
///   bool sees(a, b, c, p)       strictly outside of the face a, b, c (anticlockwise from outside)
///   bool passes(a, b, p)        on the way to p from the inside of a face, its side a → b is crossed
///   static constexpr bool kInfinite   the last vertex is at infinity; faces that have it have it last

#include <raycloud/core/mesh.h>
#include <raycloud/exec/fresh_memory.h>

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace ray {

template <class Geometry>
class HullComplex {
 public:
  using Index = std::uint32_t;
  struct Face {
    std::array<Index, 3> vertices{};
    std::array<Index, 3> neighbours{};  ///< each beyond the side opposite the vertex of that place
  };

  /// Begins with a hull of four vertices, each face anticlockwise from outside when `a, b, c` is and `d` is
  /// behind it. `vertices` is their number in all, that at infinity included; at most 2^31.
  HullComplex(const Geometry& geometry, std::size_t vertices, std::array<Index, 4> first)
      : geometry_(geometry), fan_(vertices) {
    const auto [a, b, c, d] = first;
    // Each face lacks one of the four.
    faces_ = {{{b, a, d}, {}}, {{c, b, d}, {}}, {{a, c, d}, {}}, {{a, b, c}, {}}};
    faces_[0].neighbours = {2, 1, 3};
    faces_[1].neighbours = {0, 2, 3};
    faces_[2].neighbours = {1, 0, 3};
    faces_[3].neighbours = {1, 2, 0};
    seen_.assign(4, 0);
    created_ = {0, 1, 2, 3};
    start_ = 3;
  }

  /// Has the memory that all points take ready, touched by all threads: for who adds them all.
  void make_room(const Context& context) {
    std::vector<Face> faces;
    reserve_touched(context, faces, 2 * fan_.size());
    faces.assign(faces_.begin(), faces_.end());
    faces_ = std::move(faces);
    std::vector<std::uint32_t> seen;
    reserve_touched(context, seen, 2 * fan_.size());
    seen.assign(seen_.begin(), seen_.end());
    seen_ = std::move(seen);
  }

  /// Adds point `p` if it is outside. The walk to it begins where the last point was added.
  bool insert(Index p) { return insert(p, start_); }
  bool insert(Index p, Index near) {
    const Index at = locate(p, near);
    if (!is_seen(at, p)) return false;
    remove_seen(at, p);
    add_fan(p);
    return true;
  }

  /// The face that p lies over, or one that has the vertex at infinity and that p sees.
  [[nodiscard]] Index locate(Index p, Index near) const {
    Index at = near;
    if (is_infinite(at)) at = faces_[at].neighbours[2];
    Index from = at;
    while (true) {
      const Face& face = faces_[at];
      Index next = at;
      for (std::size_t i = 0; i < 3; ++i) {
        if (face.neighbours[i] == from && from != at) continue;
        if (geometry_.passes(face.vertices[(i + 1) % 3], face.vertices[(i + 2) % 3], p)) {
          next = face.neighbours[i];
          break;
        }
      }
      if (next == at || is_infinite(next)) return next;
      from = at;
      at = next;
    }
  }

  /// Places in faces(); those that the last insertion removed and created may be the same.
  [[nodiscard]] std::span<const Index> removed() const { return removed_; }
  [[nodiscard]] std::span<const Index> created() const { return created_; }

  [[nodiscard]] const Face& face(Index at) const { return faces_[at]; }
  [[nodiscard]] std::size_t places() const { return faces_.size(); }
  [[nodiscard]] bool is_alive(Index at) const { return faces_[at].vertices[0] != faces_[at].vertices[1]; }
  [[nodiscard]] bool is_infinite(Index at) const {
    return Geometry::kInfinite && faces_[at].vertices[2] + 1 == fan_.size();
  }

  /// The faces, without those at infinity, by place.
  [[nodiscard]] std::vector<Mesh::Face> finite_faces(const Context& context = {}) const {
    std::vector<Mesh::Face> faces;
    reserve_touched(context, faces, faces_.size());
    for (Index at = 0; at < faces_.size(); ++at)
      if (is_alive(at) && !is_infinite(at)) faces.push_back(faces_[at].vertices);
    return faces;
  }

 private:
  [[nodiscard]] bool is_seen(Index at, Index p) const {
    const auto& [a, b, c] = faces_[at].vertices;
    if (!is_infinite(at)) return geometry_.sees(a, b, c, p);
    // The face stands on the side a → b of a finite one. In its plane, what is seen is decided by the other.
    if (geometry_.passes(a, b, p)) return false;
    if (geometry_.passes(b, a, p)) return true;
    const auto& [d, e, f] = faces_[faces_[at].neighbours[2]].vertices;
    return geometry_.sees(d, e, f, p);
  }

  void remove_seen(Index at, Index p) {
    removed_.assign(1, at);
    rim_.clear();
    ++stamp_;
    seen_[at] = 2 * stamp_ + 1;
    for (std::size_t done = 0; done < removed_.size(); ++done) {
      const Index own = removed_[done];
      for (std::size_t i = 0; i < 3; ++i) {
        const Index other = faces_[own].neighbours[i];
        if (seen_[other] < 2 * stamp_) {
          seen_[other] = 2 * stamp_ + (is_seen(other, p) ? 1 : 0);
          if (seen_[other] % 2 == 1) removed_.push_back(other);
        }
        if (seen_[other] % 2 == 0) {
          rim_.push_back({faces_[own].vertices[(i + 1) % 3], faces_[own].vertices[(i + 2) % 3], other, own});
        }
      }
    }
  }

  void add_fan(Index p) {
    free_.insert(free_.end(), removed_.begin(), removed_.end());
    created_.clear();
    for (const Rim& rim : rim_) {
      Index place = 0;
      if (free_.empty()) {
        place = static_cast<Index>(faces_.size());
        faces_.emplace_back();
        seen_.push_back(0);
      } else {
        place = free_.back();
        free_.pop_back();
      }
      created_.push_back(place);
      fan_[rim.from] = place;
    }
    // Neighbours beyond the rim still name the removed face, whose place may be taken: all are linked before
    // any face is written.
    for (std::size_t i = 0; i < rim_.size(); ++i) {
      Face& beyond = faces_[rim_[i].beyond];
      for (std::size_t j = 0; j < 3; ++j) {
        if (beyond.vertices[(j + 1) % 3] == rim_[i].to && beyond.vertices[(j + 2) % 3] == rim_[i].from)
          beyond.neighbours[j] = created_[i];
      }
    }
    for (std::size_t i = 0; i < rim_.size(); ++i) {
      const Rim& rim = rim_[i];
      Face& face = faces_[created_[i]];
      face.vertices = {rim.from, rim.to, p};
      face.neighbours = {fan_[rim.to], 0, rim.beyond};
    }
    for (std::size_t i = 0; i < rim_.size(); ++i)
      faces_[fan_[rim_[i].to]].neighbours[1] = created_[i];
    if constexpr (Geometry::kInfinite) {
      for (const Index place : created_)
        put_infinity_last(faces_[place]);
    }
    for (const Index place : free_)
      faces_[place].vertices = {0, 0, 0};
    start_ = created_.front();
  }

  void put_infinity_last(Face& face) const {
    const auto infinity = static_cast<Index>(fan_.size() - 1);
    for (int turns = 0; turns < 2 && face.vertices[2] != infinity; ++turns) {
      if (face.vertices[0] != infinity && face.vertices[1] != infinity) return;
      face.vertices = {face.vertices[1], face.vertices[2], face.vertices[0]};
      face.neighbours = {face.neighbours[1], face.neighbours[2], face.neighbours[0]};
    }
  }

  /// A side of the hole, as the removed face has it.
  struct Rim {
    Index from, to, beyond, removed;
  };

  const Geometry& geometry_;
  std::vector<Face> faces_;
  std::vector<Index> free_;
  std::vector<std::uint32_t> seen_;  ///< 2 stamp + 1: seen by the point of that stamp
  std::uint32_t stamp_ = 0;
  std::vector<Index> removed_;
  std::vector<Index> created_;
  std::vector<Rim> rim_;
  std::vector<Index> fan_;  ///< the new face whose rim begins at each vertex
  Index start_ = 0;
};

}  // namespace ray
