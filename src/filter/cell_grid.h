#pragma once
/// Cubes of a bounded piece of space, by one sortable 64-bit key each, and a table of what they hold.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace ray {

/// At most 2^21 cubes along an axis, counted from `origin`.
class CellGrid {
 public:
  static constexpr int kBits = 21;
  static constexpr std::int64_t kMost = std::int64_t{1} << kBits;

  CellGrid(const Eigen::Vector3d& origin, double width) : origin_(origin), width_(width) {}

  /// Nothing for a point outside.
  [[nodiscard]] std::optional<std::uint64_t> key(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d cell = ((point - origin_) / width_).array().floor();
    if (!((cell.array() >= 0.0).all() && (cell.array() < static_cast<double>(kMost)).all())) return {};
    return key(static_cast<std::uint64_t>(cell.x()), static_cast<std::uint64_t>(cell.y()),
               static_cast<std::uint64_t>(cell.z()));
  }
  /// Keys are in the order of x, then y, then z.
  [[nodiscard]] static std::uint64_t key(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
    return (x << (2 * kBits)) | (y << kBits) | z;
  }
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }
  [[nodiscard]] double width() const { return width_; }

 private:
  Eigen::Vector3d origin_;
  double width_;
};

/// A number for some cells: open addressing, half full at most, 32 bytes a cell.
class CellTable {
 public:
  /// Precondition: no key twice.
  explicit CellTable(const std::vector<std::uint64_t>& keys);
  /// The index in `keys`.
  [[nodiscard]] std::optional<std::size_t> find(std::uint64_t key) const;

 private:
  struct Slot {
    std::uint64_t key = kFree;
    std::uint64_t index = 0;
  };
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};  // a key has 63 bits
  [[nodiscard]] std::size_t home(std::uint64_t key) const;

  std::vector<Slot> slots_;
};

}  // namespace ray
