#include "tree_mesh.h"

#include "turn.h"

#include <raycloud/synth/scenes.h>

#include <algorithm>

namespace ray {
namespace {

constexpr std::size_t kNone = TreeSegment::kNoParent;

// Enough for the eye; the volume is right for any number.
std::size_t sides_of(double radius) {
  if (radius > 0.05) return 24;
  if (radius > 0.02) return 10;
  return radius > 0.01 ? 6 : 5;
}

bool has_length(const Tree& tree, const TreeSegment& segment) {
  return segment.parent != kNone && segment.position != tree.segments[segment.parent].position;
}

std::vector<double> lower_radii(const Tree& tree) {
  const std::vector<std::size_t> next = continuations(tree);
  std::vector<double> radii(tree.segments.size());
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const TreeSegment& segment = tree.segments[i];
    const bool continues = segment.parent != kNone && next[segment.parent] == i;
    radii[i] = continues ? tree.segments[segment.parent].radius : segment.radius;
  }
  return radii;
}

std::vector<std::size_t> ends_of(const Tree& tree) {
  const std::vector<std::size_t> next = continuations(tree);
  std::vector<std::size_t> ends;
  for (std::size_t i = 0; i < next.size(); ++i) {
    if (next[i] == kNone && has_length(tree, tree.segments[i])) ends.push_back(i);
  }
  return ends;
}

}  // namespace

std::vector<std::size_t> continuations(const Tree& tree) {
  std::vector<std::size_t> next(tree.segments.size(), kNone);
  for (std::size_t i = 0; i < tree.segments.size(); ++i) {
    const std::size_t parent = tree.segments[i].parent;
    if (parent == kNone) continue;
    if (next[parent] == kNone || tree.segments[i].radius > tree.segments[next[parent]].radius)
      next[parent] = i;
  }
  return next;
}

double wood_volume(const Tree& tree) {
  const std::vector<double> lower = lower_radii(tree);
  double volume = 0.0;
  for (std::size_t i = 0; i < tree.segments.size(); ++i) {
    const TreeSegment& segment = tree.segments[i];
    if (!has_length(tree, segment)) continue;
    const double length = (segment.position - tree.segments[segment.parent].position).norm();
    const double a = lower[i];
    const double b = segment.radius;
    volume += 3.141592653589793 / 3 * length * (a * a + a * b + b * b);
  }
  return volume;
}

Wood wood_mesh(const Tree& tree) {
  const std::vector<double> lower = lower_radii(tree);
  const std::vector<std::size_t> next = continuations(tree);
  std::vector<std::uint8_t> is_trunk(tree.segments.size(), 0);
  for (std::size_t i = 0; i < tree.segments.size(); ++i) {
    const std::size_t parent = tree.segments[i].parent;
    is_trunk[i] = parent == kNone || (is_trunk[parent] != 0 && next[parent] == i) ? 1 : 0;
  }
  MeshBuilder trunk;
  MeshBuilder branches;
  for (std::size_t i = 0; i < tree.segments.size(); ++i) {
    const TreeSegment& segment = tree.segments[i];
    if (!has_length(tree, segment)) continue;
    MeshBuilder& part = is_trunk[i] != 0 ? trunk : branches;
    part.tube(tree.segments[segment.parent].position, lower[i], segment.position, segment.radius,
              sides_of(lower[i]));
  }
  return {trunk.take(), branches.take()};
}

Eigen::Vector3d random_direction(const RandomStream& random, std::uint64_t index, std::uint64_t draw) {
  const double z = 2 * random.uniform(index, draw) - 1;
  const Eigen::Vector2d around = std::sqrt(1 - z * z) * turned(random.uniform(index, draw + 1));
  return {around.x(), around.y(), z};
}

std::size_t leaf_count(const Tree& tree, const Foliage& foliage) {
  return ends_of(tree).size() * foliage.leaves_per_end;
}

Mesh leaf_mesh(const Tree& tree, const Foliage& foliage, const RandomStream& random) {
  MeshBuilder builder;
  for (const std::size_t end : ends_of(tree)) {
    const TreeSegment& segment = tree.segments[end];
    const Eigen::Vector3d& from = tree.segments[segment.parent].position;
    const Eigen::Vector3d along = (segment.position - from).normalized();
    for (std::size_t i = 0; i < foliage.leaves_per_end; ++i) {
      const std::uint64_t index = end * foliage.leaves_per_end + i;
      const double fraction =
          (static_cast<double>(i) + random.uniform(index, 0)) / static_cast<double>(foliage.leaves_per_end);
      const Eigen::Vector3d place = from + fraction * (segment.position - from);
      const Eigen::Vector3d out = (random_direction(random, index, 1) + 0.6 * along).normalized();
      const Eigen::Vector3d stem = place + segment.radius * out;
      const AcrossAxes axes = across(out);
      const Eigen::Vector2d spin = turned(random.uniform(index, 3));
      builder.leaf(stem, stem + foliage.leaf_length * out, spin.x() * axes.first + spin.y() * axes.second,
                   spin.x() * axes.second - spin.y() * axes.first, foliage.leaf_area, 0.25);
    }
  }
  return builder.take();
}

double tree_height(const Tree& tree) {
  double top = tree.segments.front().position.z();
  for (const TreeSegment& segment : tree.segments)
    top = std::max(top, segment.position.z());
  return top - tree.segments.front().position.z();
}

double crown_radius(const Tree& tree) {
  double radius = 0.0;
  for (const TreeSegment& segment : tree.segments)
    radius = std::max(radius, (segment.position - tree.segments.front().position).head<2>().norm());
  return radius;
}

}  // namespace ray
