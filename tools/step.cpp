#include "step.h"

#include "cloud_to_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/io/ray_cloud_file.h>

namespace ray::tools {
namespace {

using Files = std::vector<std::filesystem::path>;

/// The main output's name, and those of the others after it.
Files files_of(const Step& step, const cli::Match& match, const std::filesystem::path& input) {
  if (step.outputs.front().suffix.empty()) return {input};
  Files files{cli::main_output(match, input, step.outputs.front().suffix)};
  const std::filesystem::path stem = match.has("--output") ? files.front() : input;
  for (std::size_t i = 1; i < step.outputs.size(); ++i)
    files.push_back(cli::output_name(stem, step.outputs[i].suffix));
  return files;
}

class WatchedSink final : public RaySink {
 public:
  WatchedSink(std::unique_ptr<RaySink> sink, std::atomic<bool>& lost) : sink_(std::move(sink)), lost_(lost) {}
  void encode(const RayCloud& rays, RawChunk& raw) const override {
    watched([&] { sink_->encode(rays, raw); });
  }
  void encode_rows(const RayCloud& rays, std::span<const std::uint32_t> rows, RawChunk& raw) const override {
    watched([&] { sink_->encode_rows(rays, rows, raw); });
  }
  void write(const RawChunk& raw) override { sink_->write(raw); }
  void amend(std::string_view comment, std::string_view by) override { sink_->amend(comment, by); }
  void finish() override { sink_->finish(); }

 private:
  template <class Call>
  void watched(const Call& call) const {
    try {
      call();
    } catch (const PrecisionLoss&) {
      lost_ = true;
      throw;
    }
  }

  std::unique_ptr<RaySink> sink_;
  std::atomic<bool>& lost_;
};

bool in_place(const Step& step) {
  return step.outputs.front().suffix.empty();
}

StepReport run_once(const Step& step, const cli::Match& match, cli::Session& session, RaySource& source,
                    const Files& files, OutputPrecision& precision) {
  std::vector<std::unique_ptr<RaySink>> sinks(files.size());
  const SinkMaker make = [&](std::size_t output, const CloudInfo& given) -> RaySink& {
    CloudInfo info = precision.widened(output, given);
    info.history.push_back(session.history());
    sinks[output] =
        precision.watch(output, create_ray_cloud(files[output], info, {.flush_to_disk = in_place(step)}));
    return *sinks[output];
  };
  StepReport report = step.run(match, session.context(), source, make);
  for (const auto& sink : sinks)
    sink->finish();
  return report;
}

}  // namespace

CloudInfo OutputPrecision::widened(std::size_t output, CloudInfo info) const {
  if (lost_[output]) info.precision = Precision::double_;
  return info;
}

std::unique_ptr<RaySink> OutputPrecision::watch(std::size_t output, std::unique_ptr<RaySink> sink) {
  return std::make_unique<WatchedSink>(std::move(sink), lost_[output]);
}

StepReport report_of(const StreamCounts& counts) {
  return {.counts = counts, .rays_out = {counts.rays_out}, .notes = {}};
}

void run_step(const Step& step, const cli::Match& match, cli::Session& session) {
  const std::string& input = match.first_input();
  const auto source = open_ray_cloud(input, {.will_be_replaced = in_place(step)});
  if (step.does_nothing != nullptr && step.does_nothing(match)) {
    session.note("this changes nothing: " + input + " stays as it is");
    return;
  }
  const Files files = files_of(step, match, input);
  OutputPrecision precision(files.size());
  StepReport report;
  while (true) {
    try {
      report = run_once(step, match, session, *source, files, precision);
      break;
    } catch (const PrecisionLoss&) {
      source->rewind();  // each time one more of the outputs is double
    }
  }
  note_dropped(session, report.counts.dropped);
  for (const std::string& note : report.notes)
    session.note(note);
  for (std::size_t i = 0; files.size() > 1 && i < files.size(); ++i)
    if (report.rays_out[i] == 0)
      session.note("nothing is " + step.outputs[i].word + ": " + files[i].string() + " has no rays");
  session.summary({.rays_in = report.counts.rays_in, .rays_out = report.counts.rays_out, .files = files});
}

}  // namespace ray::tools
