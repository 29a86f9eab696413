#pragma once
/// A source and a sink in memory: what tests use, and library users who already hold a cloud.

#include <raycloud/core/ray_stream.h>

namespace ray {

/// Streams a cloud that somebody else owns, which must outlive it, in chunks of `chunk_rays`. Rays with NaN
/// or infinite values are left out as a file's are.
class MemorySource final : public RaySource {
 public:
  explicit MemorySource(const RayCloud& cloud, std::size_t chunk_rays = 32768);
  MemorySource(const RayCloud& cloud, CloudInfo info, std::size_t chunk_rays = 32768);
  [[nodiscard]] const CloudInfo& info() const override { return info_; }
  [[nodiscard]] bool fetch(RawChunk& raw) override;
  std::size_t decode(const RawChunk& raw, RayCloud& rays) const override;
  void rewind() override { next_ = 0; }

 private:
  const RayCloud& cloud_;
  CloudInfo info_;
  std::size_t chunk_rays_;
  std::size_t next_ = 0;
};

/// Collects a stream into one cloud, which is complete when `finish` has been called. Encoding is a plain
/// copy, so every bit survives.
class MemorySink final : public RaySink {
 public:
  explicit MemorySink(std::vector<ColumnInfo> extras = {});
  void encode(const RayCloud& rays, RawChunk& raw) const override;
  void write(const RawChunk& raw) override;
  void finish() override { finished_ = true; }
  [[nodiscard]] const RayCloud& cloud() const { return cloud_; }
  [[nodiscard]] bool finished() const { return finished_; }

 private:
  RayCloud cloud_;
  bool finished_ = false;
};

}  // namespace ray
