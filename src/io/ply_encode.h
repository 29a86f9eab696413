#pragma once
/// Rays to rows of a PLY file of ours, and its header; what becomes of the bytes is the business of others.

#include <raycloud/core/ray_stream.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace ray {

/// Thread-safe once made.
class PlyEncoder {
 public:
  /// Of rays, or with `rays` false of points. Errors begin with `name`. Throws Error(usage) for columns that
  /// cannot be named.
  PlyEncoder(std::string name, const CloudInfo& info, bool rays);
  ~PlyEncoder();

  /// From `ply` to `end_header`, with zeros for the number of rows, which has `kCountDigits` digits.
  [[nodiscard]] const std::string& header() const;
  [[nodiscard]] std::size_t count_offset() const;
  static constexpr std::size_t kCountDigits = 12;

  /// As RaySink::encode.
  void encode(const RayCloud& rays, RawChunk& raw) const;
  /// As RaySink::encode_rows.
  void encode_rows(const RayCloud& rays, std::span<const std::uint32_t> rows, RawChunk& raw) const;
  /// What encoding and decoding would make of rays, without the bytes. Throws as `encode` does. Returns
  /// whether starts and ends would stay as they are if it were done again.
  bool reflect(RayCloud& rays) const;
  /// The same where starts, ends and times are known to stay as they are.
  void reflect_settled(RayCloud& rays) const;

 private:
  class Layout;
  template <class RowAt>
  void encode_all(const RayCloud& rays, std::size_t count, const RowAt& row_at, RawChunk& raw) const;
  template <class Real>
  [[nodiscard]] bool reflect_as(RayCloud& rays) const;
  template <class Real>
  [[nodiscard]] static bool store_as(RayCloud& rays, std::size_t begin, std::size_t end);
  void check_ray(const RayCloud& rays, std::size_t row) const;
  void check_value(double value) const;
  [[noreturn]] void fail_not_finite() const;

  std::string name_;
  std::unique_ptr<const Layout> layout_;
  bool rays_;
  bool single_;
  double tolerance_ = 0.0;  ///< m
  double safe_;             ///< magnitudes below need no closer look
};

}  // namespace ray
