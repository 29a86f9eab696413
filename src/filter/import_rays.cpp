#include "source_sample.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/stream.h>
#include <raycloud/filter/import_rays.h>
#include <raycloud/filter/intensity.h>
#include <raycloud/filter/time_base.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace ray {
namespace {

constexpr double kMadeUpStep = 1e-6;  // s from one made-up time to the next

std::string counted(std::uint64_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string decimal(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

// The options with the clock applied to times and spans.
class Clock {
 public:
  explicit Clock(const ImportOptions& options) : scale_(options.time_scale), offset_(options.time_offset) {
    if (!(scale_ > 0.0) || !std::isfinite(scale_) || !std::isfinite(offset_))
      throw Error(ErrorCode::usage, "the time scale must be positive and the offset finite");
  }
  [[nodiscard]] bool is_identity() const { return scale_ == 1.0 && offset_ == 0.0; }
  [[nodiscard]] double operator()(double time) const { return time * scale_ + offset_; }

 private:
  double scale_;
  double offset_;
};

void check_source(const RaySource& points, const SourceSample& sample, const ImportOptions& options,
                  const Clock& clock) {
  const Present& present = points.info().present;
  const std::string& name = options.points_name;
  if (std::holds_alternative<OwnOrigins>(options.origin) && !present.starts)
    throw Error(ErrorCode::wrong_content,
                name +
                    ": does not say where its sensor was: give a trajectory file, the position X,Y,Z of a "
                    "fixed sensor, or ray X,Y,Z");
  if (sample.complete && sample.rays == 0 && sample.invalid > 0)
    throw Error(ErrorCode::no_data, name + ": every row has a NaN or infinite value");
  const auto* moving = std::get_if<MovingSensor>(&options.origin);
  if (moving == nullptr) return;
  if (!present.times)
    throw Error(ErrorCode::wrong_content,
                name +
                    ": has no times, so a trajectory cannot place its rays: give the "
                    "position X,Y,Z of a fixed sensor, or ray X,Y,Z");
  if (sample.rays == 0) return;
  const Trajectory& path = moving->trajectory;
  check_clocks({clock(sample.times.first), clock(sample.times.last)}, name,
               {path.times.front(), path.times.back()}, options.trajectory_name, node_spacing(path));
}

// Where the sensor started: what remove_start_position subtracts.
Eigen::Vector3d start_position(const ImportOptions& options, const SourceSample& sample) {
  if (const auto* moving = std::get_if<MovingSensor>(&options.origin))
    return moving->trajectory.positions.front();
  if (const auto* fixed = std::get_if<FixedSensor>(&options.origin)) return fixed->position;
  Eigen::Vector3d start = sample.first_start.value_or(Eigen::Vector3d::Zero());
  if (const auto* constant = std::get_if<ConstantRay>(&options.origin)) start -= constant->start_to_end;
  return start;
}

struct Plan {
  CloudInfo info;
  IntensityScale intensity;
  Eigen::Vector3d move = Eigen::Vector3d::Zero();  // added to every position
  bool made_up_times = false;
  std::vector<std::size_t> left_out;  // extras of the source, in descending order
};

// The formal extras that the sample shows to be zero throughout: they would only make the cloud larger.
std::vector<std::size_t> unrecorded_extras(const CloudInfo& info, const SourceSample& sample) {
  std::vector<std::size_t> found;
  for (std::size_t i = info.extras.size(); i-- > 0;) {
    const auto& formal = info.formal_extras;
    const bool is_formal = std::find(formal.begin(), formal.end(), info.extras[i].name) != formal.end();
    if (is_formal && sample.recorded[i] == 0) found.push_back(i);
  }
  return found;
}

void leave_out(Plan& plan, const CloudInfo& source, std::vector<std::size_t> extras) {
  plan.left_out = std::move(extras);
  plan.info.extras = source.extras;
  for (const std::size_t i : plan.left_out)
    plan.info.extras.erase(plan.info.extras.begin() + static_cast<std::ptrdiff_t>(i));
}

Plan make_plan(const RaySource& points, const SourceSample& sample, const ImportOptions& options,
               const Clock& clock) {
  Plan plan{.info = points.info()};
  plan.intensity = intensity_scale(points.info(), sample.intensity, options.max_intensity);
  plan.made_up_times = !points.info().present.times;
  plan.info.ray_count.reset();
  plan.info.present = {};
  if (!clock.is_identity()) plan.info.time_base.clear();
  if (plan.made_up_times) plan.info.time_base = "made_up";
  if (options.remove_start_position) plan.move = -start_position(options, sample);
  if (!options.history.empty()) plan.info.history.push_back(options.history);
  leave_out(plan, points.info(), unrecorded_extras(points.info(), sample));
  return plan;
}

struct Chunk {
  OriginCounts origins;
  IntensityRange intensity;
  bool lost_values = false;  // an extra that was to be left out is not zero after all
};

struct Pass {
  StreamCounts counts;
  OriginCounts origins;
  IntensityRange intensity;
  bool lost_values = false;
  OriginAudit audit;
};

// Drops the extras of the plan from a chunk; true if one of them holds a value.
bool drop_extras(const Plan& plan, RayCloud& rays) {
  bool lost = false;
  for (const std::size_t i : plan.left_out) {
    lost = lost || is_recorded(rays.extras[i]);
    rays.extras.erase(rays.extras.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return lost;
}

Pass run_pass(const Context& context, RaySource& points, RaySink& sink, const Plan& plan,
              const OriginStep& step, const Clock& clock) {
  Pass pass;
  std::uint64_t row = 0;
  const bool new_times = !plan.made_up_times && !clock.is_identity();
  const auto map = [&](RayCloud& rays) {
    if (new_times)
      for (double& time : rays.times)
        time = clock(time);
    Chunk chunk{.intensity = apply_intensity(plan.intensity, rays)};
    chunk.lost_values = drop_extras(plan, rays);
    chunk.origins = step(rays);
    if (!plan.move.isZero(0.0)) rays.transform(translation_pose(plan.move));
    return chunk;
  };
  const auto fold = [&](RayCloud& rays, const Chunk& chunk) {
    if (plan.made_up_times)
      for (double& time : rays.times)
        time = static_cast<double>(row++) * kMadeUpStep;
    pass.origins.add(chunk.origins);
    pass.intensity.add(chunk.intensity);
    pass.lost_values = pass.lost_values || chunk.lost_values;
    pass.audit.add(rays);
  };
  pass.counts = stream(context, points, &sink, map, fold);
  return pass;
}

std::vector<std::string> origin_notes(const OriginCounts& origins, const ImportOptions& options) {
  std::vector<std::string> notes;
  const auto* moving = std::get_if<MovingSensor>(&options.origin);
  const std::uint64_t outside = origins.before + origins.after;
  if (moving != nullptr && outside > 0)
    notes.push_back(counted(outside, "point is", "points are") + " outside the time of " +
                    options.trajectory_name + " (" + std::to_string(origins.before) + " before, " +
                    std::to_string(origins.after) + " after) and " +
                    (moving->clamp ? "start at its ends" : "left out (--clamp keeps them)"));
  if (origins.in_gaps > 0)
    notes.push_back(counted(origins.in_gaps, "point lies", "points lie") + " in gaps of " +
                    options.trajectory_name + " over 10 times its usual spacing, the longest " +
                    decimal(origins.longest_gap) + " s");
  return notes;
}

std::vector<std::string> notes_of(const Pass& pass, const Plan& plan, const ImportOptions& options) {
  std::vector<std::string> notes;
  for (const std::string& comment : plan.info.comments)
    if (comment.starts_with("columns by content: ")) notes.push_back(comment);
  if (!plan.intensity.reason.empty()) notes.push_back(plan.intensity.reason);
  if (plan.made_up_times) notes.emplace_back("no times: made up in file order, a microsecond apart");
  if (!plan.move.isZero(0.0))
    notes.push_back("everything is moved by " + decimal(plan.move.x()) + "," + decimal(plan.move.y()) + "," +
                    decimal(plan.move.z()));
  if (pass.counts.dropped > 0)
    notes.push_back(counted(pass.counts.dropped, "row", "rows") + " left out for a NaN or infinite value");
  for (std::string& note : origin_notes(pass.origins, options))
    notes.push_back(std::move(note));
  return notes;
}

bool same_scale(const IntensityScale& a, const IntensityScale& b) {
  return a.rule == b.rule && a.maximum == b.maximum && a.zero_is_unbounded == b.zero_is_unbounded;
}

ImportReport report_of(const Context& context, const Pass& pass, const Plan& plan,
                       const ImportOptions& options) {
  ImportReport report{.info = plan.info,
                      .rays_in = pass.counts.rays_in,
                      .rays_out = pass.counts.rays_out,
                      .invalid = pass.counts.dropped,
                      .origins = pass.origins,
                      .notes = notes_of(pass, plan, options)};
  report.audit = pass.audit.findings(
      context, {.origins_by_request = std::holds_alternative<FixedSensor>(options.origin) ||
                                      std::holds_alternative<ConstantRay>(options.origin),
                .real_times = !plan.made_up_times});
  return report;
}

}  // namespace

ImportReport import_rays(const Context& context, RaySource& points, const ImportOptions& options,
                         const SinkMaker& make_sink) {
  const OriginStep step(options.origin);
  const Clock clock(options);
  const SourceSample sample = sample_source(context, points, intensity_column(points.info()));
  check_source(points, sample, options, clock);
  Plan plan = make_plan(points, sample, options, clock);
  while (true) {
    points.rewind();
    try {
      const auto sink = make_sink(plan.info);
      const Pass pass = run_pass(context, points, *sink, plan, step, clock);
      if (pass.counts.rays_out == 0 && pass.counts.rays_in + pass.counts.dropped > 0)
        throw Error(ErrorCode::no_data,
                    options.points_name + ": no point has a time within " + options.trajectory_name);
      const IntensityScale whole = intensity_scale(points.info(), pass.intensity, options.max_intensity);
      if (same_scale(plan.intensity, whole) && !pass.lost_values) {
        plan.intensity.reason = whole.reason;
        sink->finish();
        return report_of(context, pass, plan, options);
      }
      // The sample misled: once more, now knowing better.
      plan.intensity = whole;
      if (pass.lost_values) leave_out(plan, points.info(), {});
    } catch (const PrecisionLoss&) {
      if (plan.info.precision == Precision::double_) throw;
      plan.info.precision = Precision::double_;
    }
  }
}

}  // namespace ray
