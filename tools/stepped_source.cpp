#include "stepped_source.h"

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
  void consume(RayCloud& rays, RawChunk& raw) const override {
    raw.rows = rays.size();
    std::swap(chunk_, rays);
  }
  void write(const RawChunk&) override {}
  void finish() override {}

 private:
  RayCloud& chunk_;
};

}  // namespace

/// The step on one chunk, whose place its output takes; `tell` hears what it says of the cloud.
template <class Tell>
StepReport SteppedSource::run(RayCloud& rays, const Tell& tell) const {
  RayCloud out;
  ChunkSource chunk(source_->info(), rays);
  ChunkSink sink(out);
  NoSink none;
  const StepReport report = step_.step->run(step_.match, {.threads = 1}, chunk,
                                            [&](std::size_t output, const CloudInfo& info) -> RaySink& {
                                              if (output != step_.output) return none;
                                              tell(info);
                                              return sink;
                                            });
  rays = std::move(out);
  return report;
}

SteppedSource::SteppedSource(std::unique_ptr<RaySource> source, const PipeStep& step,
                             OutputPrecision& precision)
    : source_(std::move(source)), step_(step), precision_(precision) {
  RayCloud none;
  none.set_schema(source_->info().extras);
  static_cast<void>(run(none, [&](const CloudInfo& given) {
    CloudInfo info = precision_.widened(step_.output, given);
    info.history.push_back(step_.match.history());
    mirror_.emplace(info);
  }));
  info_ = mirror_->info();
}

std::size_t SteppedSource::decode(const RawChunk& raw, RayCloud& rays) const {
  const std::size_t dropped = source_->decode(raw, rays);
  const StepReport part = run(rays, [](const CloudInfo&) {});
  try {
    mirror_->reflect(rays);
  } catch (const PrecisionLoss&) {
    precision_.lost(step_.output);
    throw;
  }
  const std::lock_guard lock(mutex_);
  report_.counts.rays_in += part.counts.rays_in;
  report_.counts.rays_out += part.counts.rays_out;
  report_.counts.dropped += dropped;
  report_.rays_out.resize(part.rays_out.size());
  for (std::size_t i = 0; i < part.rays_out.size(); ++i)
    report_.rays_out[i] += part.rays_out[i];
  return 0;
}

void SteppedSource::rewind() {
  source_->rewind();
  report_ = {};
}

}  // namespace ray::tools
