#include "grow_tree.h"

#include "turn.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ray {
namespace {

// Of a branch, by its order (1 leaves the trunk).
struct Axis {
  std::size_t from;
  Eigen::Vector3d direction;
  double length;
  int order;
};

class Growth {
 public:
  Growth(const Species& species, const TreePlan& plan, const RandomStream& random)
      : species_(species), plan_(plan), random_(random) {}

  Tree grow() {
    tree_.segments.push_back({.position = plan_.foot});
    grow_trunk();
    stretch();
    fill_pipes();
    return std::move(tree_);
  }

 private:
  double next() { return random_.uniform(draws_++); }
  double next(double low, double high) { return low + (high - low) * next(); }
  Eigen::Vector3d next_direction() {
    draws_ += 1;
    return random_direction(random_, draws_, 1);
  }

  std::size_t add(std::size_t parent, const Eigen::Vector3d& position) {
    tree_.segments.push_back({.position = position, .parent = parent});
    return tree_.segments.size() - 1;
  }

  // How far the crown reaches, as a fraction of its radius, from its base (0) to the top (1).
  double reach(double level) const {
    const double ball = std::sqrt(std::max(0.0, 1 - (1.6 * level - 0.6) * (1.6 * level - 0.6)));
    return std::max(0.1, (1 - species_.cone) * ball + species_.cone * (1 - level));
  }

  void grow_trunk() {
    constexpr int kBareNodes = 4;
    const double base = species_.crown_base * plan_.height;
    std::size_t node = 0;
    Eigen::Vector3d sway = Eigen::Vector3d::Zero();
    const auto grow_to = [&](double height) {
      const double step = plan_.foot.z() + height - tree_.segments[node].position.z();
      sway += 0.25 * species_.wobble * next_direction();
      sway.z() = 0;
      node = add(node, tree_.segments[node].position + step * (Eigen::Vector3d::UnitZ() + 0.5 * sway));
    };
    for (int i = 1; i <= kBareNodes; ++i)
      grow_to(base * i / kBareNodes);
    double around = next();
    for (int whorl = 0; whorl < species_.whorls; ++whorl) {
      const double level = static_cast<double>(whorl) / species_.whorls;
      if (whorl > 0) grow_to(base + (plan_.height - base) * level);
      for (int limb = 0; limb < species_.limbs; ++limb) {
        around += 1.0 / species_.limbs + next(-0.06, 0.06);
        grow_limb(node, level, around);
      }
      around += 0.381966;  // the golden angle
    }
    grow_to(plan_.height);
  }

  void grow_limb(std::size_t node, double level, double around) {
    const double rise =
        species_.rise_low + (species_.rise_high - species_.rise_low) * level + next(-0.12, 0.12);
    const Eigen::Vector2d out = turned(around);
    const double radius = species_.crown_radius * plan_.height * reach(level) * next(0.8, 1.1);
    // Never above the top of the tree.
    const double room = plan_.height * (1 - species_.crown_base) * (1 - level);
    const double length = std::min(radius * std::sqrt(1 + rise * rise),
                                   rise > 0 ? 0.7 * room * std::sqrt(1 + 1 / (rise * rise)) : radius * 2);
    grow_axis({node, Eigen::Vector3d(out.x(), out.y(), rise).normalized(), length, 1});
  }

  void grow_axis(const Axis& axis) {
    static constexpr std::array<int, 5> kNodes{0, 6, 3, 2, 1};
    const int nodes = axis.order < species_.orders ? kNodes.at(static_cast<std::size_t>(axis.order)) : 1;
    std::size_t node = axis.from;
    Eigen::Vector3d direction = axis.direction;
    double around = next();
    for (int i = 0; i < nodes; ++i) {
      direction =
          (direction + species_.wobble * next_direction() + 0.06 * Eigen::Vector3d::UnitZ()).normalized();
      node = add(node, tree_.segments[node].position + axis.length / nodes * direction);
      if (axis.order >= species_.orders) continue;
      const double along = (i + 1.0) / nodes;
      const int twigs = axis.order == 1 ? (i == 0 ? 1 : 2) : species_.twigs;
      for (int twig = 0; twig < twigs; ++twig) {
        around += 0.5 + next(-0.1, 0.1);
        grow_twig(axis, node, direction, around, along);
      }
      around += 0.22;
    }
  }

  void grow_twig(const Axis& axis, std::size_t node, const Eigen::Vector3d& direction, double around,
                 double along) {
    const AcrossAxes sides = across(direction);
    const Eigen::Vector2d out = turned(around);
    const double spread = next(0.7, 1.1);
    const Eigen::Vector3d twig =
        (direction + spread * (out.x() * sides.first + out.y() * sides.second)).normalized();
    const double length = axis.length * next(0.34, 0.5) * (1.15 - 0.45 * along);
    grow_axis({node, twig, std::max(length, 0.08), axis.order + 1});
  }

  // To the height asked for, whatever the highest twig does.
  void stretch() {
    const double factor = plan_.height / tree_height(tree_);
    for (TreeSegment& segment : tree_.segments)
      segment.position = plan_.foot + factor * (segment.position - plan_.foot);
  }

  void fill_pipes() {
    std::vector<double> ends(tree_.segments.size(), 0.0);
    for (std::size_t i = ends.size(); i-- > 0;) {
      if (ends[i] == 0.0) ends[i] = 1.0;
      if (i > 0) ends[tree_.segments[i].parent] += ends[i];
    }
    for (std::size_t i = 0; i < ends.size(); ++i)
      tree_.segments[i].radius = plan_.foot_radius * std::sqrt(ends[i] / ends[0]);
  }

  const Species& species_;
  const TreePlan& plan_;
  const RandomStream& random_;
  Tree tree_;
  std::uint64_t draws_ = 0;
};

}  // namespace

const Species& broadleaf() {
  static const Species kSpecies{.name = "broadleaf",
                                .crown_base = 0.25,
                                .crown_radius = 0.32,
                                .cone = 0.5,
                                .rise_low = 0.15,
                                .rise_high = 0.8,
                                .foliage = {.leaves_per_end = 8, .leaf_area = 0.013, .leaf_length = 0.18}};
  return kSpecies;
}

const Species& conifer() {
  static const Species kSpecies{.name = "conifer",
                                .crown_base = 0.2,
                                .crown_radius = 0.17,
                                .cone = 1.0,
                                .rise_low = -0.35,
                                .rise_high = 0.35,
                                .whorls = 16,
                                .limbs = 3,
                                .orders = 2,
                                .wobble = 0.08,
                                .slenderness = 50.0,
                                .foliage = {.leaves_per_end = 12, .leaf_area = 0.012, .leaf_length = 0.3}};
  return kSpecies;
}

const Species& birch() {
  static const Species kSpecies{.name = "birch",
                                .crown_base = 0.4,
                                .crown_radius = 0.16,
                                .cone = 0.3,
                                .rise_low = 0.9,
                                .rise_high = 1.8,
                                .wobble = 0.14,
                                .slenderness = 65.0,
                                .foliage = {.leaves_per_end = 7, .leaf_area = 0.009, .leaf_length = 0.15}};
  return kSpecies;
}

Tree grow_tree(const Species& species, const TreePlan& plan, const RandomStream& random) {
  return Growth(species, plan, random).grow();
}

}  // namespace ray
