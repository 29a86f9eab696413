#pragma once
/// Where rays come from and where they go, without saying what a file is. Both ends split their work in two:
/// a short serial part that touches the medium and a thread-safe part that turns bytes into rays and back, so
/// that one pipeline (exec/stream.h) overlaps reading, computing and writing on all cores, for every format.

#include <raycloud/core/cloud_info.h>
#include <raycloud/core/ray_cloud.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace ray {

/// A piece of a stream in its stored form. What `bytes` holds is the business of the source or sink that made
/// it (it may be empty where `first_row` and `rows` say all). Reused from piece to piece to save allocation.
struct RawChunk {
  std::vector<std::byte> bytes;
  std::uint64_t first_row = 0;  ///< in the source, counting invalid rows
  std::size_t rows = 0;
  std::size_t source = 0;  ///< which one, where a source is made of several
};

/// Yields the rays of a cloud, in order, chunk by chunk, in bounded memory.
class RaySource {
 public:
  virtual ~RaySource() = default;

  [[nodiscard]] virtual const CloudInfo& info() const = 0;

  /// Takes the next piece. False at the end. Called by one thread at a time. Throws Error where the medium
  /// fails or ends before the rows it promised.
  [[nodiscard]] virtual bool fetch(RawChunk& raw) = 0;

  /// Turns a fetched piece into rays, replacing what `rays` held; its extras are exactly those of info().
  /// Rows with a NaN or infinite coordinate or time are left out; returns how many were. Thread-safe.
  virtual std::size_t decode(const RawChunk& raw, RayCloud& rays) const = 0;

  /// The times of the rays that `decode` would give, and what it would return; a source may be quicker at
  /// that.
  virtual std::size_t decode_times(const RawChunk& raw, std::vector<double>& times) const;

  /// Starts again at the first ray.
  virtual void rewind() = 0;
};

/// Takes the rays of a cloud, in order, chunk by chunk. Until `finish` returns, the target is as it was; if
/// the sink is destroyed before, nothing remains of it.
class RaySink {
 public:
  virtual ~RaySink() = default;

  /// Turns rays into the stored form, replacing what `raw` held. Thread-safe. Throws PrecisionLoss where the
  /// sink stores single precision and a coordinate would lose more than 0.1 mm, and Error(out_of_range) where
  /// a value cannot be stored at all. Precondition: the extras are those the sink was made with, in that
  /// order.
  virtual void encode(const RayCloud& rays, RawChunk& raw) const = 0;

  /// As `encode`, where nobody needs `rays` any more: a sink may take their memory instead of copying it.
  virtual void consume(RayCloud& rays, RawChunk& raw) const { encode(rays, raw); }

  /// As `encode`, of the given rows of `rays` in the given order; a sink may do without a copy of them.
  virtual void encode_rows(const RayCloud& rays, std::span<const std::uint32_t> rows, RawChunk& raw) const;

  /// Adds an encoded piece. Called by one thread at a time, in order. Throws Error(file_access) on a full
  /// disk.
  virtual void write(const RawChunk& raw) = 0;

  /// As `encode_rows`, where nobody needs `rays` any more.
  virtual void consume_rows(RayCloud& rays, std::span<const std::uint32_t> rows, RawChunk& raw) const {
    encode_rows(rays, rows, raw);
  }

  /// Replaces a comment that it was made with by another of the same length, for what is known only at the
  /// end. Precondition: the target is a PLY file. Throws Error(usage) if there is no such comment.
  virtual void amend(std::string_view comment, std::string_view by);

  /// Completes the target. Called once, after the last write.
  virtual void finish() = 0;
};

}  // namespace ray
