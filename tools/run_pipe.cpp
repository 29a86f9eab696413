#include "by_ray_step.h"
#include "pipe_steps.h"

#include <raycloud/core/error.h>
#include <raycloud/io/ply_channel.h>
#include <raycloud/io/ray_cloud_file.h>

#include <algorithm>
#include <deque>
#include <exception>
#include <future>
#include <system_error>
#include <thread>
#include <utility>

namespace ray::tools {
namespace {

using std::filesystem::path;

/// A file that is gone when this is.
class PassingFile {
 public:
  explicit PassingFile(path file) : file_(std::move(file)) {}
  ~PassingFile() {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
  }
  PassingFile(const PassingFile&) = delete;
  PassingFile& operator=(const PassingFile&) = delete;
  [[nodiscard]] const path& file() const { return file_; }

 private:
  path file_;
};

/// A source that knows how many rays it has, as a file would: they are counted first if they must be.
class CountedSource final : public RaySource {
 public:
  CountedSource(const Context& context, RaySource& source, bool count)
      : source_(source), info_(source.info()) {
    if (!count || info_.ray_count) return;
    info_.ray_count = stream(
                          context, source, nullptr, [](const RayCloud&) { return Nothing{}; },
                          [](const RayCloud&, Nothing) {})
                          .rays_in;
    source.rewind();
  }
  const CloudInfo& info() const override { return info_; }
  bool fetch(RawChunk& raw) override { return source_.fetch(raw); }
  std::size_t decode(const RawChunk& raw, RayCloud& rays) const override { return source_.decode(raw, rays); }
  void rewind() override { source_.rewind(); }

 private:
  RaySource& source_;
  CloudInfo info_;
};

/// What the steps have taught by failing; the pipe then runs again from the last file.
struct Lessons {
  explicit Lessons(std::span<const PipeStep> steps) : reads_twice(steps.size(), false) {
    for (const PipeStep& step : steps)
      precision.emplace_back(step.step->outputs.size());
  }
  std::vector<bool> reads_twice;
  std::deque<OutputPrecision> precision;  // of each step
};

enum class Ending { done, precision_lost, cannot_rewind, failed, given_up };

/// Steps `first` to `last` (excluded), from a file to a file.
class Section {
 public:
  Section(const Context& context, std::span<const PipeStep> steps, Lessons& lessons, std::size_t first,
          std::size_t last)
      : context_(context), steps_(steps), lessons_(lessons), first_(first), reports_(last - first) {
    // Steps by ray go with a driver: with the one behind them, as part of its reading, or at the end with the
    // one before, as part of its writing.
    const auto by_ray = [&](std::size_t i) {
      return steps[i].step->by_ray != nullptr && steps[i].step->by_ray(steps[i].match);
    };
    std::size_t last_driver = last - 1;
    while (last_driver > first && by_ray(last_driver))
      --last_driver;
    if (by_ray(last_driver)) last_driver = last - 1;  // all are
    std::size_t begin = first;
    for (std::size_t i = first; i <= last_driver; ++i) {
      if (i < last_driver && by_ray(i)) continue;
      stages_.emplace_back().first = begin;
      stages_.back().driver = i;
      begin = i + 1;
    }
    end_ = last;
  }

  /// True when done, with the reports; false when it should be tried again. Throws what cannot be mended.
  bool run(const path& input, const path& output) {
    stages_.front().source.set_value(open_ray_cloud(input));
    std::vector<std::thread> threads;
    for (std::size_t i = 1; i < stages_.size(); ++i)
      threads.emplace_back([this, i, &output] { run_guarded(i, output); });
    run_guarded(0, output);
    for (std::thread& thread : threads)
      thread.join();
    return judge();
  }

  [[nodiscard]] const std::vector<StepReport>& reports() const { return reports_; }

 private:
  /// What runs on one thread: a step that drives, and before it those that work ray by ray where it reads.
  struct Stage {
    std::size_t first = 0;
    std::size_t driver = 0;
    std::promise<std::unique_ptr<RaySource>> source;
    std::exception_ptr error;
  };

  void run_guarded(std::size_t i, const path& output) {
    try {
      run_one(i, output);
    } catch (...) {
      stages_[i].error = std::current_exception();
      if (i + 1 == stages_.size()) return;
      try {  // the next one may still wait for what this one was to make
        stages_[i + 1].source.set_exception(stages_[i].error);
      } catch (const std::future_error&) {
        // It has it.
      }
    }
  }

  void run_one(std::size_t i, const path& output) {
    const std::size_t driver = stages_[i].driver;
    std::unique_ptr<RaySource> source = take_source(i);
    const std::size_t first = stages_[i].first;
    const SteppedSource* stepped = nullptr;
    if (first < driver) {
      std::vector<OutputPrecision*> precision;
      for (std::size_t one = first; one < driver; ++one)
        precision.push_back(&lessons_.precision[one]);
      auto all = std::make_unique<SteppedSource>(std::move(source), steps_.subspan(first, driver - first),
                                                 precision);
      stepped = all.get();
      source = std::move(all);
    }
    // One of them speaks for all.
    Context context = context_;
    if (i > 0) context.progress = nullptr;
    reports_[driver - first_] = drive(context, i, *source, stepped, output);
    for (std::size_t one = 0; one < driver - first; ++one)
      reports_[first + one - first_] = stepped->report(one);
  }

  /// `stepped` is the source if it is one of those.
  StepReport drive(const Context& context, std::size_t i, RaySource& source, const SteppedSource* stepped,
                   const path& output) {
    const PipeStep& step = steps_[stages_[i].driver];
    std::vector<std::unique_ptr<RaySink>> sinks(step.step->outputs.size());
    const SinkMaker make = [&](std::size_t number, const CloudInfo& given) -> RaySink& {
      if (number == step.output)
        sinks[number] = next_sink(i, given, stepped, output);
      else
        sinks[number] = std::make_unique<NoSink>();
      return *sinks[number];
    };
    const bool can_amend = i + 1 == stages_.size() && output.extension() == ".ply";
    CountedSource counted(context, source, step.step->tells_count && !can_amend);
    StepReport report = step.step->run(step.match, context, counted, make);
    sinks[step.output]->finish();
    const bool is_last = i + 1 == stages_.size();
    for (std::size_t one = 0; is_last && one < written_.size(); ++one)
      reports_[stages_[i].driver + 1 + one - first_] = written_[one]->report();
    return report;
  }

  std::unique_ptr<RaySource> take_source(std::size_t i) {
    try {
      return stages_[i].source.get_future().get();
    } catch (...) {
      // The one before failed and says so itself.
      throw Error(ErrorCode::cancelled, "the step before failed");
    }
  }

  /// For the output of the driver of stage `i` that goes on.
  std::unique_ptr<RaySink> next_sink(std::size_t i, const CloudInfo& given, const SteppedSource* stepped,
                                     const path& output) {
    if (i + 1 == stages_.size()) {
      written_.clear();
      const PipeStep& driver = steps_[stages_[i].driver];
      const bool keeps = driver.step->keeps_places != nullptr && driver.step->keeps_places(driver.match);
      return final_sink(stages_[i].driver, given, keeps ? stepped : nullptr, output);
    }
    OutputPrecision& precision = lessons_.precision[stages_[i].driver];
    const PipeStep& step = steps_[stages_[i].driver];
    CloudInfo info = precision.widened(step.output, given);
    info.history.push_back(step.match.history());
    PlyChannel channel = make_ply_channel(info);
    stages_[i + 1].source.set_value(std::move(channel.source));
    return precision.watch(step.output, std::move(channel.sink));
  }

  /// For what step number `from` gives, through the steps behind it, into the file. `places` is where the
  /// places come from, if the step leaves them as they are.
  std::unique_ptr<RaySink> final_sink(std::size_t from, const CloudInfo& given, const SteppedSource* places,
                                      const path& output) {
    OutputPrecision& precision = lessons_.precision[from];
    const PipeStep& step = steps_[from];
    if (from + 1 == end_) {
      CloudInfo info = precision.widened(step.output, given);
      info.history.push_back(step.match.history());
      return precision.watch(step.output, create_ray_cloud(output, info));
    }
    auto mirror = std::make_unique<StepMirror>(given, step, precision);
    auto next = std::make_unique<ByRayStep>(mirror->info(), steps_[from + 1]);
    written_.push_back(next.get());
    auto sink = final_sink(from + 1, next->info(), nullptr, output);
    const bool same = places != nullptr && places->info().precision == mirror->info().precision;
    return std::make_unique<SteppedSink>(std::move(mirror), std::move(next), std::move(sink),
                                         same ? places : nullptr);
  }

  static Ending ending_of(const std::exception_ptr& error) {
    if (!error) return Ending::done;
    try {
      std::rethrow_exception(error);
    } catch (const PrecisionLoss&) {
      return Ending::precision_lost;
    } catch (const CannotRewind&) {
      return Ending::cannot_rewind;
    } catch (const Error& given) {
      return given.code() == ErrorCode::cancelled ? Ending::given_up : Ending::failed;
    } catch (...) {
      return Ending::failed;
    }
  }

  bool judge() {
    bool again = false;
    std::exception_ptr fatal;
    std::exception_ptr cancelled;
    for (const Stage& stage : stages_) {
      const Ending ending = ending_of(stage.error);
      if (ending == Ending::cannot_rewind) lessons_.reads_twice[stage.first] = true;
      again = again || ending == Ending::cannot_rewind || ending == Ending::precision_lost;
      if (ending == Ending::failed && !fatal) fatal = stage.error;
      if (ending == Ending::given_up && !cancelled) cancelled = stage.error;
    }
    if (fatal) std::rethrow_exception(fatal);
    if (!again && !cancelled) return true;  // also when Ctrl-C comes after the file was complete
    check_cancelled(context_);
    if (!again) std::rethrow_exception(cancelled);
    return false;
  }

  const Context& context_;
  std::span<const PipeStep> steps_;
  Lessons& lessons_;
  std::size_t first_;
  std::vector<StepReport> reports_;
  std::deque<Stage> stages_;
  std::size_t end_ = 0;                    // one past the last step
  std::vector<const ByRayStep*> written_;  // the steps behind the last driver, owned by its sink
};

/// The first step from `first` on that must have a file before it, or the number of steps.
std::size_t section_end(const Lessons& lessons, std::size_t first) {
  const auto begin = lessons.reads_twice.begin() + static_cast<std::ptrdiff_t>(first);
  const auto next = std::find(begin + 1, lessons.reads_twice.end(), true);
  return static_cast<std::size_t>(next - lessons.reads_twice.begin());
}

path passing_name(const path& output, std::size_t step) {
  return output.parent_path() /
         ("." + output.stem().string() + "_before_step_" + std::to_string(step + 1) + ".ply");
}

}  // namespace

PipeReport run_pipe(const Context& context, const path& input, std::span<const PipeStep> steps,
                    const path& output) {
  Lessons lessons(steps);
  PipeReport report;
  std::deque<PassingFile> passing;
  path from = input;
  std::size_t first = 0;
  while (first < steps.size()) {
    const std::size_t last = section_end(lessons, first);
    const bool whole = last == steps.size();
    if (!whole) passing.emplace_back(passing_name(output, last));
    const path to = whole ? output : passing.back().file();
    Section section(context, steps, lessons, first, last);
    if (!section.run(from, to)) {
      if (!whole) passing.pop_back();
      continue;
    }
    report.steps.insert(report.steps.end(), section.reports().begin(), section.reports().end());
    from = to;
    first = last;
  }
  return report;
}

}  // namespace ray::tools
