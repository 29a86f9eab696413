#pragma once
/// Steps that look at one ray at a time, chunk by chunk, as part of reading or of writing: each chunk goes
/// through them where it is decoded or encoded, so they cost neither a thread nor a channel. The rays are to
/// the bit those of the files that the steps would have written and read.

#include "pipe_steps.h"

#include <raycloud/io/ply_channel.h>

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

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

/// One such step, applied to any number of chunks.
class ByRayStep {
 public:
  /// `step` must outlive it. `source` tells of the cloud that the chunks are of.
  ByRayStep(const CloudInfo& source, const PipeStep& step);
  ByRayStep(const ByRayStep&) = delete;
  ByRayStep& operator=(const ByRayStep&) = delete;
  /// What the step makes of the cloud, without the history.
  [[nodiscard]] const CloudInfo& info() const { return info_; }
  [[nodiscard]] const PipeStep& step() const { return step_; }
  /// Replaces the chunk by the output that goes on. Thread-safe.
  void apply(RayCloud& rays) const;
  /// Rays that were left out of the cloud before. Thread-safe.
  void add_dropped(std::size_t rays) const;
  /// Of all chunks so far.
  [[nodiscard]] const StepReport& report() const { return report_; }
  void forget() { report_ = {}; }

 private:
  template <class Tell>
  StepReport run(RayCloud& rays, const Tell& tell) const;

  CloudInfo source_;
  const PipeStep& step_;
  CloudInfo info_;
  mutable std::mutex mutex_;
  mutable StepReport report_;
};

/// What a PLY file between two steps would make of rays.
class StepMirror {
 public:
  /// `given` is what output `output` of a step is told to be; `precision`, which learns what must be double,
  /// must outlive it.
  StepMirror(const CloudInfo& given, const PipeStep& step, OutputPrecision& precision);
  [[nodiscard]] const CloudInfo& info() const { return mirror_->info(); }
  /// As those of PlyMirror. Thread-safe. Throws PrecisionLoss.
  bool reflect(RayCloud& rays) const;
  void reflect_settled(RayCloud& rays) const { mirror_->reflect_settled(rays); }

 private:
  std::size_t output_;
  OutputPrecision& precision_;
  std::optional<PlyMirror> mirror_;
};

/// A source whose rays have gone through one step or more.
class SteppedSource final : public RaySource {
 public:
  /// `precision` has one for each of the steps.
  SteppedSource(std::unique_ptr<RaySource> source, std::span<const PipeStep> steps,
                std::span<OutputPrecision* const> precision);

  const CloudInfo& info() const override { return stages_.back().mirror.info(); }
  bool fetch(RawChunk& raw) override { return source_->fetch(raw); }
  std::size_t decode(const RawChunk& raw, RayCloud& rays) const override;
  void rewind() override;

  /// Whether the places of all rays so far would stay as they are in another file of that precision.
  [[nodiscard]] bool is_settled() const { return settled_; }
  /// Of step number `one`.
  [[nodiscard]] const StepReport& report(std::size_t one) const { return stages_[one].step.report(); }

 private:
  struct Stage {
    Stage(const CloudInfo& before, const PipeStep& what, OutputPrecision& precision);
    ByRayStep step;
    StepMirror mirror;
    bool keeps_places;
  };
  std::unique_ptr<RaySource> source_;
  std::deque<Stage> stages_;
  mutable std::atomic<bool> settled_ = true;
};

/// Lets rays go through a step on their way to a sink.
class SteppedSink final : public RaySink {
 public:
  /// `mirror` is what comes before the step; `sink` is made for what comes after it. `from`, if there is one,
  /// is where the rays come from, with their places as they were.
  SteppedSink(std::unique_ptr<StepMirror> mirror, std::unique_ptr<ByRayStep> step,
              std::unique_ptr<RaySink> sink, const SteppedSource* from)
      : mirror_(std::move(mirror)), step_(std::move(step)), sink_(std::move(sink)), from_(from) {}

  void encode(const RayCloud& rays, RawChunk& raw) const override;
  void consume(RayCloud& rays, RawChunk& raw) const override;
  void consume_rows(RayCloud& rays, std::span<const std::uint32_t> rows, RawChunk& raw) const override;
  void write(const RawChunk& raw) override { sink_->write(raw); }
  void finish() override { sink_->finish(); }
  void amend(std::string_view comment, std::string_view by) override { sink_->amend(comment, by); }

 private:
  std::unique_ptr<StepMirror> mirror_;
  std::unique_ptr<ByRayStep> step_;
  std::unique_ptr<RaySink> sink_;
  const SteppedSource* from_;
};

}  // namespace ray::tools
