#pragma once
/// A cloud as it will lie: moved, and bent.

#include <raycloud/core/bend.h>
#include <raycloud/core/pose.h>
#include <raycloud/core/ray_stream.h>

namespace ray::align {

/// Another source's rays, which it reads and which must outlive it.
class BentSource final : public RaySource {
 public:
  BentSource(RaySource& source, const Pose& pose, const Bend& bend)
      : source_(source), pose_(pose), bend_(bend) {}
  [[nodiscard]] const CloudInfo& info() const override { return source_.info(); }
  [[nodiscard]] bool fetch(RawChunk& raw) override { return source_.fetch(raw); }
  std::size_t decode(const RawChunk& raw, RayCloud& rays) const override {
    const std::size_t dropped = source_.decode(raw, rays);
    rays.transform(pose_);
    bend_rays(bend_, rays);
    return dropped;
  }
  void rewind() override { source_.rewind(); }

 private:
  RaySource& source_;
  Pose pose_;
  Bend bend_;
};

}  // namespace ray::align
