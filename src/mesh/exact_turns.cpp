#include "exact_turns.h"

#include <array>
#include <cmath>

namespace ray {
namespace {

/// A sum of doubles of which none overlaps another, so that the last decides its sign.
class Expansion {
 public:
  void add(double value) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const double sum = value + parts_[i];
      const double of_part = sum - value;
      const double rest = (value - (sum - of_part)) + (parts_[i] - of_part);
      if (rest != 0.0) parts_[kept++] = rest;
      value = sum;
    }
    if (value != 0.0 || kept == 0) parts_[kept++] = value;
    size_ = kept;
  }
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  void add_product(double a, double b, double c) {
    const double product = a * b;
    add_product(product, c);
    add_product(std::fma(a, b, -product), c);
  }
  [[nodiscard]] int sign() const {
    const double last = size_ > 0 ? parts_[size_ - 1] : 0.0;
    return last > 0.0 ? 1 : last < 0.0 ? -1 : 0;
  }

 private:
  std::array<double, 104> parts_{};
  std::size_t size_ = 0;
};

void add_determinant(Expansion& sum, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                     const Eigen::Vector3d& c, double sign) {
  for (int x = 0; x < 3; ++x) {
    const int y = (x + 1) % 3, z = (x + 2) % 3;
    sum.add_product(sign * a[x], b[y], c[z]);
    sum.add_product(-sign * a[x], b[z], c[y]);
  }
}

int sign_of_turn(double value) {
  return value > 0.0 ? 1 : value < 0.0 ? -1 : 0;
}

}  // namespace

int turn_in_space(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                  const Eigen::Vector3d& d) {
  const Eigen::Vector3d u = b - a, v = c - a, w = d - a;
  const double determinant = u.x() * (v.y() * w.z() - v.z() * w.y()) +
                             u.y() * (v.z() * w.x() - v.x() * w.z()) +
                             u.z() * (v.x() * w.y() - v.y() * w.x());
  const Eigen::Vector3d most = u.cwiseAbs().cwiseMax(v.cwiseAbs()).cwiseMax(w.cwiseAbs());
  // Six products of three differences, each of which suffers eight roundings of 2^-53 at most.
  const double doubt = 6e-15 * most.prod();
  if (std::abs(determinant) > doubt && doubt > 0.0) return sign_of_turn(determinant);
  Expansion sum;  // of the four places as they are
  add_determinant(sum, b, c, d, 1.0);
  add_determinant(sum, a, c, d, -1.0);
  add_determinant(sum, a, b, d, 1.0);
  add_determinant(sum, a, b, c, -1.0);
  return sum.sign();
}

int turn_in_plan(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const double left = (b.x() - a.x()) * (c.y() - a.y());
  const double right = (b.y() - a.y()) * (c.x() - a.x());
  const double doubt = 1e-15 * (std::abs(left) + std::abs(right));
  if (std::abs(left - right) > doubt && doubt > 0.0) return sign_of_turn(left - right);
  Expansion sum;
  const auto add = [&](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
    sum.add_product(p.x(), q.y());
    sum.add_product(-p.y(), q.x());
  };
  add(a, b);
  add(b, c);
  add(c, a);
  return sum.sign();
}

}  // namespace ray
