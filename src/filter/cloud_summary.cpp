#include "travelled_path.h"

#include <raycloud/exec/stream.h>
#include <raycloud/filter/cloud_summary.h>
#include <raycloud/spatial/point_sample.h>
#include <raycloud/spatial/point_spacing.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ray {
namespace {

/// Sums are taken in the order of the rays, never by parts, so that the chunks leave no trace in the last
/// bit.
struct Running {
  std::uint64_t count = 0;
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
  double sum = 0.0;

  void add(double value) {
    if (std::isnan(value)) return;
    count++;
    min = std::min(min, value);
    max = std::max(max, value);
    sum += value;
  }
  [[nodiscard]] Statistics statistics() const {
    if (count == 0) return {};
    return {count, min + 0.0, sum / static_cast<double>(count) + 0.0, max + 0.0};  // no −0
  }
};

/// Of the bytes red, green, blue and intensity. Whole numbers may be summed in any order.
struct RunningColours {
  std::uint64_t count = 0;
  std::array<std::uint8_t, 4> min = {255, 255, 255, 255};
  std::array<std::uint8_t, 4> max = {0, 0, 0, 0};
  std::array<std::uint64_t, 4> sum = {0, 0, 0, 0};

  void add(const Colour& colour) {
    const std::array<std::uint8_t, 4> bytes = {colour.red, colour.green, colour.blue, colour.intensity};
    count++;
    for (std::size_t c = 0; c < 4; c++) {
      min[c] = std::min(min[c], bytes[c]);
      max[c] = std::max(max[c], bytes[c]);
      sum[c] += bytes[c];
    }
  }
  void add(const RunningColours& other) {
    count += other.count;
    for (std::size_t c = 0; c < 4; c++) {
      min[c] = std::min(min[c], other.min[c]);
      max[c] = std::max(max[c], other.max[c]);
      sum[c] += other.sum[c];
    }
  }
  [[nodiscard]] Statistics statistics(std::size_t c) const {
    if (count == 0) return {};
    return {count, static_cast<double>(min[c]), static_cast<double>(sum[c]) / static_cast<double>(count),
            static_cast<double>(max[c])};
  }
};

struct Times {
  double first = 0.0;  // in the file
  double last = 0.0;
  double earliest = std::numeric_limits<double>::infinity();
  double latest = -std::numeric_limits<double>::infinity();
  std::uint64_t backward_steps = 0;
};

/// What one chunk can find out alone.
struct Part {
  std::uint64_t rays = 0;
  std::uint64_t zero_length = 0;
  Bounds starts;
  Bounds ends;
  Bounds bounded_ends;
  Times times;
  std::vector<double> bounded_lengths;  // to be summed in order
  RunningColours colours;               // of bounded rays
  std::vector<Eigen::Vector3d> sample;
  TravelledPath path;
};

Times times_of(const std::vector<double>& values) {
  Times times;
  if (values.empty()) return times;
  times.first = values.front();
  times.last = values.back();
  double before = times.first;
  for (const double time : values) {
    times.backward_steps += time < before ? 1 : 0;
    times.earliest = std::min(times.earliest, time);
    times.latest = std::max(times.latest, time);
    before = time;
  }
  return times;
}

Bounds bounds_of(const std::vector<Eigen::Vector3d>& points) {
  Bounds bounds;
  for (const Eigen::Vector3d& point : points)
    bounds.add(point);
  return bounds;
}

/// One short loop for each figure: each keeps its own in registers, which is twice as fast as one loop for
/// all.
Part summarise_chunk(const RayCloud& rays, const PointSample& sample) {
  Part part;
  const std::size_t count = rays.size();
  part.rays = count;
  part.starts = bounds_of(rays.starts);
  part.ends = bounds_of(rays.ends);
  part.times = times_of(rays.times);
  part.sample = sample.candidates(rays.ends, rays.bounded);
  for (std::size_t i = 0; i < count; i++)
    part.path.add(rays.times[i], rays.starts[i]);
  Bounds bounded_ends;
  RunningColours colours;
  for (std::size_t i = 0; i < count; i++) {
    if (rays.bounded[i] == 0) continue;
    bounded_ends.add(rays.ends[i]);
    colours.add(rays.colours[i]);
  }
  part.bounded_ends = bounded_ends;
  part.colours = colours;
  part.bounded_lengths.resize(count);
  std::size_t bounded = 0;
  for (std::size_t i = 0; i < count; i++) {
    const double length = (rays.ends[i] - rays.starts[i]).norm();
    part.zero_length += rays.ends[i] == rays.starts[i] ? 1 : 0;
    part.bounded_lengths[bounded] = length;
    bounded += rays.bounded[i] != 0 ? 1 : 0;
  }
  part.bounded_lengths.resize(bounded);
  return part;
}

/// Puts the parts together, in file order.
class Whole {
 public:
  explicit Whole(const std::vector<ColumnInfo>& extras) : extras_(extras.size()) {}

  void add(const RayCloud& rays, const Part& part, PointSample& sample) {
    if (part.rays == 0) return;
    summary_.zero_length += part.zero_length;
    summary_.starts.add(part.starts);
    summary_.ends.add(part.ends);
    summary_.bounded_ends.add(part.bounded_ends);
    summary_.backward_steps += part.times.backward_steps;
    if (summary_.rays != 0 && part.times.first < times_.last) summary_.backward_steps++;
    times_.last = part.times.last;
    times_.earliest = std::min(times_.earliest, part.times.earliest);
    times_.latest = std::max(times_.latest, part.times.latest);
    for (const double length : part.bounded_lengths)
      lengths_.add(length);
    colours_.add(part.colours);
    sample.add(part.sample);
    path_.append(part.path);
    for (std::size_t c = 0; c < extras_.size(); c++)
      add_column(extras_[c], rays.extras[c]);
    summary_.rays += part.rays;
  }

  [[nodiscard]] CloudSummary finish(const PointSample& sample, const StreamCounts& counts,
                                    const std::vector<ColumnInfo>& extras) {
    summary_.bounded = colours_.count;
    summary_.unbounded = summary_.rays - summary_.bounded;
    summary_.dropped = counts.dropped;
    for (Bounds* bounds : {&summary_.starts, &summary_.ends, &summary_.bounded_ends}) {
      bounds->min.array() += 0.0;  // no −0
      bounds->max.array() += 0.0;
    }
    if (summary_.rays != 0) {
      summary_.earliest_time = times_.earliest + 0.0;
      summary_.latest_time = times_.latest + 0.0;
    }
    summary_.bounded_lengths = lengths_.statistics();
    summary_.mean_spacing = estimate_spacing(sample.points(), summary_.bounded);
    summary_.path_length = {path_.length()};
    summary_.red = colours_.statistics(0);
    summary_.green = colours_.statistics(1);
    summary_.blue = colours_.statistics(2);
    summary_.intensity = colours_.statistics(3);
    for (std::size_t c = 0; c < extras.size(); c++) {
      summary_.extras.push_back({extras[c], extras_[c].statistics()});
    }
    return summary_;
  }

 private:
  static void add_column(Running& running, const Column& column) {
    visit_scalar(column.type(), [&]<class T>() {
      for (const T value : column.values<T>())
        running.add(static_cast<double>(value));
    });
  }

  CloudSummary summary_;
  Times times_;
  Running lengths_;
  RunningColours colours_;
  TravelledPath path_;
  std::vector<Running> extras_;
};

}  // namespace

CloudSummary summarise_cloud(const Context& context, RaySource& source) {
  constexpr std::size_t kSamplePoints = std::size_t{1} << 18;
  PointSample sample(kSamplePoints);
  Whole whole(source.info().extras);
  const StreamCounts counts = stream(
      context, source, nullptr, [&](const RayCloud& rays) { return summarise_chunk(rays, sample); },
      [&](const RayCloud& rays, const Part& part) { whole.add(rays, part, sample); });
  return whole.finish(sample, counts, source.info().extras);
}

}  // namespace ray
