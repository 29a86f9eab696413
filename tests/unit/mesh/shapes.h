#pragma once
/// Meshes whose shape is known.

#include <raycloud/core/mesh.h>
#include <raycloud/exec/random.h>

#include <cmath>
#include <functional>
#include <map>
#include <utility>

namespace ray::test {

inline Mesh box_shape(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1) ? high.x() : low.x(), (i & 2) ? high.y() : low.y(),
                               (i & 4) ? high.z() : low.z());
  const std::uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& quad : quads) {
    mesh.faces.push_back({quad[0], quad[1], quad[2]});
    mesh.faces.push_back({quad[0], quad[2], quad[3]});
  }
  return mesh;
}

/// A sphere around the origin whose vertices `radius(direction)` moves: star-shaped, with dents and spikes.
inline Mesh sphere_shape(int levels, const std::function<double(const Eigen::Vector3d&)>& radius) {
  Mesh mesh = box_shape({-1, -1, -1}, {1, 1, 1});
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), mesh.vertices.size());
      if (is_new) mesh.vertices.emplace_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
      return found->second;
    };
    std::vector<Mesh::Face> faces;
    for (const auto& [a, b, c] : std::vector<Mesh::Face>(mesh.faces)) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      faces.insert(faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.faces = std::move(faces);
  }
  for (Eigen::Vector3d& vertex : mesh.vertices)
    vertex = vertex.normalized() * radius(vertex.normalized());
  return mesh;
}

/// `size` by `size` vertices 1 m apart from 0,0 on, fronts upwards.
inline Mesh ground_shape(int size, const std::function<double(int, int)>& height) {
  Mesh mesh;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      mesh.vertices.emplace_back(x, y, height(x, y));
  for (int y = 0; y + 1 < size; ++y) {
    for (int x = 0; x + 1 < size; ++x) {
      const auto a = static_cast<std::uint32_t>(y * size + x);
      const auto above = a + static_cast<std::uint32_t>(size);
      mesh.faces.push_back({a, a + 1, above + 1});
      mesh.faces.push_back({a, above + 1, above});
    }
  }
  return mesh;
}

/// A ring of `steps` squares that closes after `turns` half turns: 0 a band, 1 a Möbius band.
inline Mesh band_shape(int steps, int turns) {
  Mesh mesh;
  for (int i = 0; i < steps; ++i) {
    const double angle = 2 * M_PI * i / steps;
    const double twist = turns * angle / 2;
    for (const double side : {-1.0, 1.0}) {
      const double away = 3 + side * std::sin(twist);
      mesh.vertices.emplace_back(away * std::cos(angle), away * std::sin(angle), side * std::cos(twist));
    }
  }
  const auto count = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t i = 0; i < count; i += 2) {
    std::uint32_t c = i + 2, d = i + 3;
    if (c == count) {
      c = turns % 2 == 0 ? 0 : 1;
      d = 1 - c;
    }
    mesh.faces.push_back({i, c, i + 1});
    mesh.faces.push_back({c, d, i + 1});
  }
  return mesh;
}

inline Mesh torus_shape(std::uint32_t around, std::uint32_t across) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = 2 * M_PI * i / around, v = 2 * M_PI * j / across;
      mesh.vertices.emplace_back((3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u),
                                 std::sin(v));
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return i % around * across + j % across; };
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

/// Each face with vertices of its own, as many programs write them.
inline Mesh unwelded(const Mesh& mesh) {
  Mesh soup;
  for (const Mesh::Face& face : mesh.faces) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t vertex : face)
      soup.vertices.push_back(mesh.vertices[vertex]);
    soup.faces.push_back({first, first + 1, first + 2});
  }
  return soup;
}

inline Eigen::Vector3d random_place(const RandomStream& random, std::uint64_t i, double half) {
  return half * (2.0 * Eigen::Vector3d(random.uniform(i, 0), random.uniform(i, 1), random.uniform(i, 2)) -
                 Eigen::Vector3d::Ones());
}

}  // namespace ray::test
