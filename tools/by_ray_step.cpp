#include "by_ray_step.h"

#include <utility>

namespace ray::tools {
namespace {

/// The one chunk that it was made with, taken out by the reader.
class ChunkSource final : public RaySource {
 public:
  ChunkSource(const CloudInfo& info, RayCloud& chunk) : info_(info), chunk_(chunk) {}
  const CloudInfo& info() const override { return info_; }
  bool fetch(RawChunk& raw) override {
    raw.rows = chunk_.size();
    return !std::exchange(taken_, true);
  }
  std::size_t decode(const RawChunk&, RayCloud& rays) const override {
    std::swap(rays, chunk_);
    return 0;
  }
  void rewind() override { throw CannotRewind(); }

 private:
  const CloudInfo& info_;
  RayCloud& chunk_;
  bool taken_ = false;
};

/// Keeps what it is given. Only for one chunk.
class ChunkSink final : public RaySink {
 public:
  explicit ChunkSink(RayCloud& chunk) : chunk_(chunk) {}
  void encode(const RayCloud& rays, RawChunk& raw) const override {
    chunk_ = rays;
    raw.rows = rays.size();
  }
  void encode_rows(const RayCloud& rays, std::span<const std::uint32_t> rows, RawChunk& raw) const override {
    chunk_.assign_rows(rays, rows);
    raw.rows = rows.size();
  }
  void consume_rows(RayCloud& rays, std::span<const std::uint32_t> rows, RawChunk& raw) const override {
    rays.keep_rows(rows);
    consume(rays, raw);
  }
  void consume(RayCloud& rays, RawChunk& raw) const override {
    raw.rows = rays.size();
    std::swap(chunk_, rays);
  }
  void write(const RawChunk&) override {}
  void finish() override {}

 private:
  RayCloud& chunk_;
};

CloudInfo noted(CloudInfo info, const PipeStep& step) {
  info.history.push_back(step.match.history());
  return info;
}

}  // namespace

ByRayStep::ByRayStep(const CloudInfo& source, const PipeStep& step) : source_(source), step_(step) {
  RayCloud none;
  none.set_schema(source.extras);
  static_cast<void>(run(none, [&](const CloudInfo& given) { info_ = given; }));
}

/// `tell` hears what the step says of the cloud.
template <class Tell>
StepReport ByRayStep::run(RayCloud& rays, const Tell& tell) const {
  RayCloud out;
  ChunkSource chunk(source_, rays);
  ChunkSink sink(out);
  NoSink none;
  StepReport report = step_.step->run(step_.match, {.threads = 1}, chunk,
                                      [&](std::size_t output, const CloudInfo& info) -> RaySink& {
                                        if (output != step_.output) return none;
                                        tell(info);
                                        return sink;
                                      });
  rays = std::move(out);
  return report;
}

void ByRayStep::apply(RayCloud& rays) const {
  const StepReport part = run(rays, [](const CloudInfo&) {});
  const std::lock_guard lock(mutex_);
  report_.counts.rays_in += part.counts.rays_in;
  report_.counts.rays_out += part.counts.rays_out;
  report_.rays_out.resize(part.rays_out.size());
  for (std::size_t i = 0; i < part.rays_out.size(); ++i)
    report_.rays_out[i] += part.rays_out[i];
}

void ByRayStep::add_dropped(std::size_t rays) const {
  const std::lock_guard lock(mutex_);
  report_.counts.dropped += rays;
}

StepMirror::StepMirror(const CloudInfo& given, const PipeStep& step, OutputPrecision& precision)
    : output_(step.output), precision_(precision) {
  mirror_.emplace(noted(precision.widened(output_, given), step));
}

bool StepMirror::reflect(RayCloud& rays) const {
  try {
    return mirror_->reflect(rays);
  } catch (const PrecisionLoss&) {
    precision_.lost(output_);
    throw;
  }
}

SteppedSource::Stage::Stage(const CloudInfo& before, const PipeStep& what, OutputPrecision& precision)
    : step(before, what),
      mirror(step.info(), what, precision),
      keeps_places(what.step->keeps_places != nullptr && what.step->keeps_places(what.match)) {}

SteppedSource::SteppedSource(std::unique_ptr<RaySource> source, std::span<const PipeStep> steps,
                             std::span<OutputPrecision* const> precision)
    : source_(std::move(source)) {
  for (std::size_t i = 0; i < steps.size(); ++i)
    stages_.emplace_back(i == 0 ? source_->info() : info(), steps[i], *precision[i]);
}

/// What the file behind it would have dropped is dropped here, and not for the next one to tell.
std::size_t SteppedSource::decode(const RawChunk& raw, RayCloud& rays) const {
  stages_.front().step.add_dropped(source_->decode(raw, rays));
  bool settled = false;
  for (const Stage& stage : stages_) {
    stage.step.apply(rays);
    if (settled && stage.keeps_places)
      stage.mirror.reflect_settled(rays);
    else
      settled = stage.mirror.reflect(rays);
  }
  if (!settled) settled_ = false;
  return 0;
}

void SteppedSource::rewind() {
  source_->rewind();
  for (Stage& stage : stages_)
    stage.step.forget();
}

void SteppedSink::encode(const RayCloud& rays, RawChunk& raw) const {
  RayCloud copy = rays;
  consume(copy, raw);
}

void SteppedSink::consume_rows(RayCloud& rays, std::span<const std::uint32_t> rows, RawChunk& raw) const {
  rays.keep_rows(rows);
  consume(rays, raw);
}

void SteppedSink::consume(RayCloud& rays, RawChunk& raw) const {
  // These rays have been decoded, so what is known of all so far is true of them.
  if (from_ != nullptr && from_->is_settled())
    mirror_->reflect_settled(rays);
  else
    mirror_->reflect(rays);
  step_->apply(rays);
  sink_->consume(rays, raw);
}

}  // namespace ray::tools
