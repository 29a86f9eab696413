#pragma once
/// A named column of one scalar type: how a ray cloud carries whatever its user's scanner recorded besides
/// the five standard columns (16-bit intensity, classification, return number, tree id …).

#include <raycloud/core/scalar.h>

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace ray {

/// Name and type: the schema of a column.
struct ColumnInfo {
  std::string name;
  ScalarType type = ScalarType::float32;
  friend bool operator==(const ColumnInfo&, const ColumnInfo&) = default;
};

/// The values, kept as raw bytes in machine order so that every row operation is one loop whatever the type.
class Column {
 public:
  explicit Column(ColumnInfo info, std::size_t rows = 0)
      : info_(std::move(info)), stride_(size_of(info_.type)), bytes_(rows * stride_) {}

  [[nodiscard]] const ColumnInfo& info() const { return info_; }
  [[nodiscard]] const std::string& name() const { return info_.name; }
  [[nodiscard]] ScalarType type() const { return info_.type; }
  /// Bytes from one value to the next.
  [[nodiscard]] std::size_t stride() const { return stride_; }
  [[nodiscard]] std::size_t size() const { return bytes_.size() / stride_; }

  /// New rows are zero.
  void resize(std::size_t rows) { bytes_.resize(rows * stride_); }
  [[nodiscard]] std::byte* data() { return bytes_.data(); }
  [[nodiscard]] const std::byte* data() const { return bytes_.data(); }

  /// The values as T. Precondition: `type() == scalar_type_of<T>()`.
  template <class T>
  [[nodiscard]] std::span<T> values() {
    assert(scalar_type_of<T>() == type());
    return {reinterpret_cast<T*>(bytes_.data()), size()};
  }
  template <class T>
  [[nodiscard]] std::span<const T> values() const {
    assert(scalar_type_of<T>() == type());
    return {reinterpret_cast<const T*>(bytes_.data()), size()};
  }

  /// One value as a double, whatever the type (64-bit integers above 2^53 are rounded).
  [[nodiscard]] double as_double(std::size_t row) const;

  /// Keeps the rows where `mask` is not 0, in order. Precondition: `mask.size() == size()`.
  void select(std::span<const std::uint8_t> mask);
  /// Precondition: the same type.
  void append(const Column& other);

  friend bool operator==(const Column&, const Column&) = default;

 private:
  ColumnInfo info_;
  std::size_t stride_;
  std::vector<std::byte> bytes_;
};

}  // namespace ray
