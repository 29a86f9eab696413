#pragma once
/// Steps that look at one ray at a time, as part of reading.

#include "pipe_steps.h"

#include <raycloud/io/ply_channel.h>

#include <memory>
#include <mutex>
#include <optional>

namespace ray::tools {

/// Takes what goes nowhere.
class NoSink final : public RaySink {
 public:
  void encode(const RayCloud& rays, RawChunk& raw) const override { raw.rows = rays.size(); }
  void encode_rows(const RayCloud&, std::span<const std::uint32_t> rows, RawChunk& raw) const override {
    raw.rows = rows.size();
  }
  void write(const RawChunk&) override {}
  void finish() override {}
};

/// What a step that looks at one ray at a time makes of a source: each chunk goes through the step by itself,
/// where it is decoded, so such steps cost neither a thread nor a channel. The rays are to the bit those of
/// the file that the step would have written.
class SteppedSource final : public RaySource {
 public:
  /// `step` and `precision`, which learns what must be double, must outlive it.
  SteppedSource(std::unique_ptr<RaySource> source, const PipeStep& step, OutputPrecision& precision);

  const CloudInfo& info() const override { return info_; }
  bool fetch(RawChunk& raw) override { return source_->fetch(raw); }
  std::size_t decode(const RawChunk& raw, RayCloud& rays) const override;
  void rewind() override;

  [[nodiscard]] const StepReport& report() const { return report_; }

 private:
  template <class Tell>
  StepReport run(RayCloud& rays, const Tell& tell) const;

  std::unique_ptr<RaySource> source_;
  const PipeStep& step_;
  OutputPrecision& precision_;
  std::optional<PlyMirror> mirror_;
  CloudInfo info_;
  mutable std::mutex mutex_;
  mutable StepReport report_;
};

}  // namespace ray::tools
