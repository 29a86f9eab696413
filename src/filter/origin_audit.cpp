#include "surface_crossings.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/filter/origin_audit.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>

namespace ray {
namespace {

constexpr std::size_t kMostSampled = 400'000;
constexpr std::size_t kMostWalked = 20'000;
constexpr std::size_t kMostSteps = std::size_t{1} << 18;
constexpr std::uint64_t kAllUpTo = 1'000'000;  // rays; of the later ones some say enough
constexpr std::uint64_t kOneIn = 7;            // shares no factor with the number of beams
constexpr double kZeroLength = 1e-6;           // m

// Lengths in a histogram by the leading bits of their square: 64 bins an octave, from 1 µm to 1000 km.
constexpr int kBinBits = 5;
constexpr std::uint64_t kLowestBin = std::uint64_t{1023 - 40} << kBinBits;
constexpr std::size_t kBins = std::size_t{80} << kBinBits;

std::size_t bin_of(double squared) {
  const std::uint64_t bin = std::bit_cast<std::uint64_t>(squared) >> (52 - kBinBits);
  return std::min<std::uint64_t>(std::max(bin, kLowestBin) - kLowestBin, kBins - 1);
}

double lowest_square_of(std::size_t bin) {
  return std::bit_cast<double>((static_cast<std::uint64_t>(bin) + kLowestBin) << (52 - kBinBits));
}

// What has to be exceeded before something is said.
constexpr double kManyZero = 0.01;
constexpr double kManyTooLong = 0.003;
constexpr double kManyThrough = 0.06;       // twice that of a busy street with right origins
constexpr std::size_t kFewestThrough = 30;  // below, a halving may be chance
constexpr double kHalved = 0.5;
constexpr double kSameVector = 1e-3;  // m

template <class... Numbers>
std::string line(const char* format, Numbers... numbers) {
  char text[256];
  std::snprintf(text, sizeof text, format, numbers...);
  return text;
}

}  // namespace

OriginAudit::OriginAudit() : lengths_(kBins, 0), random_(0, "origin audit") {}

void OriginAudit::add(const RayCloud& rays) {
  if (rays.empty()) return;
  if (count_ == 0) {
    first_start_ = anchor_ = rays.starts.front();
    first_end_ = rays.ends.front();
    anchor_time_ = rays.times.front();
  }
  add_sameness(rays);
  const std::uint64_t end = count_ + rays.size();
  for (; next_measured_ < end; next_measured_ += next_measured_ < kAllUpTo ? 1 : kOneIn) {
    const std::size_t i = next_measured_ - count_;
    add_length((rays.ends[i] - rays.starts[i]).squaredNorm(), rays.bounded[i] != 0);
    add_step(rays.times[i], rays.starts[i]);
    ++measured_;
  }
  for (; next_sampled_ < end; next_sampled_ = sampled_of(++block_))
    add_sample(rays, next_sampled_ - count_);
  count_ = end;
}

// Stops looking at the first difference, which for most clouds is their second ray.
void OriginAudit::add_sameness(const RayCloud& rays) {
  const auto [earliest, latest] = std::minmax_element(rays.times.begin(), rays.times.end());
  first_time_ = std::min(first_time_, *earliest);
  last_time_ = std::max(last_time_, *latest);
  const Eigen::Vector3d first_vector = first_end_ - first_start_;
  for (std::size_t i = 0; i < rays.size() && one_start_; ++i)
    one_start_ = rays.starts[i] == first_start_;
  for (std::size_t i = 0; i < rays.size() && one_vector_; ++i) {
    const Eigen::Vector3d vector = rays.ends[i] - rays.starts[i];
    one_vector_ = (vector - first_vector).squaredNorm() < kSameVector * kSameVector;
  }
}

void OriginAudit::add_length(double squared, bool bounded) {
  if (squared < kZeroLength * kZeroLength)
    ++zero_;
  else if (bounded)
    ++lengths_[bin_of(squared)];
}

void OriginAudit::add_step(double time, const Eigen::Vector3d& start) {
  const double duration = time - anchor_time_;
  if (duration >= 0.0 && duration < step_duration_) return;
  if (duration > 0.0)
    steps_.push_back({static_cast<float>((start - anchor_).norm()), static_cast<float>(duration)});
  anchor_time_ = time;
  anchor_ = start;
  if (steps_.size() < kMostSteps) return;
  for (std::size_t i = 0; 2 * i < steps_.size(); ++i)
    steps_[i] = {steps_[2 * i].length + steps_[2 * i + 1].length,
                 steps_[2 * i].duration + steps_[2 * i + 1].duration};
  steps_.resize(kMostSteps / 2);
  step_duration_ *= 2.0;
}

// Of two neighbouring blocks of 2^(level-1) rays, the sampled ray of which one is that of both.
bool OriginAudit::takes_second(std::uint64_t block, unsigned level) const {
  return (random_.bits(block, level) & 1) != 0;
}

std::uint64_t OriginAudit::sampled_of(std::uint64_t block) const {
  for (unsigned level = level_; level > 0; --level)
    block = 2 * block + (takes_second(block, level) ? 1 : 0);
  return block;
}

void OriginAudit::add_sample(const RayCloud& rays, std::size_t i) {
  sample_.push_back({random_.bits(next_sampled_), rays.times[i], (rays.starts[i] - first_end_).cast<float>(),
                     (rays.ends[i] - first_end_).cast<float>(), rays.bounded[i] != 0});
  if (sample_.size() < kMostSampled) return;
  ++level_;
  for (std::size_t pair = 0; 2 * pair < sample_.size(); ++pair)
    sample_[pair] = sample_[2 * pair + (takes_second(pair, level_) ? 1 : 0)];
  sample_.resize(kMostSampled / 2);
  block_ = sample_.size() - 1;
}

OriginFindings OriginAudit::findings(const Context& context, const AuditOptions& options) const {
  OriginFindings result;
  if (count_ == 0) return result;
  judge_lengths(result);
  judge_path(result, options);
  if (one_vector_ && count_ > 1 && !options.origins_by_request)
    result.findings.emplace_back(
        "every ray has the same vector, so free space is assumed rather than measured: give "
        "a trajectory if there is one");
  if (!one_vector_) judge_surfaces(context, result, options);
  return result;
}

void OriginAudit::judge_lengths(OriginFindings& result) const {
  const auto total = std::accumulate(lengths_.begin(), lengths_.end(), std::uint64_t{0});
  result.zero_length = static_cast<double>(zero_) / static_cast<double>(measured_);
  if (result.zero_length > kManyZero)
    result.findings.push_back(
        line("%.1f %% of the rays have no length: missed returns recorded at the sensor, or no "
             "origin is known (give a trajectory or X,Y,Z)",
             100.0 * result.zero_length));
  if (total == 0) return;
  std::size_t bin = 0;
  for (std::uint64_t below = lengths_[0]; below < total - total / 100; below += lengths_[bin])
    ++bin;
  const double usual = std::sqrt(lowest_square_of(bin));
  const std::size_t limit = bin_of(9.0 * lowest_square_of(bin));
  std::uint64_t longer = 0;
  for (std::size_t i = limit + 1; i < kBins; ++i)
    longer += lengths_[i];
  result.too_long = static_cast<double>(longer) / static_cast<double>(total);
  if (result.too_long > kManyTooLong)
    result.findings.push_back(
        line("%.2f %% of the rays are longer than %.1f m, three times what 99 %% have: check "
             "the trajectory and --time_offset",
             100.0 * result.too_long, 3.0 * usual));
}

void OriginAudit::judge_path(OriginFindings& result, const AuditOptions& options) const {
  const double duration = last_time_ - first_time_;
  if (!options.real_times || one_vector_) return;
  if (one_start_ && duration > 0.0 && !options.origins_by_request)
    result.findings.push_back(
        line("all rays start at one point while %.3g s pass: give a trajectory, unless the "
             "scanner stood still",
             duration));
  if (steps_.empty()) return;
  std::vector<double> speeds;
  for (const Step& step : steps_) {
    result.path_length += static_cast<double>(step.length);
    speeds.push_back(static_cast<double>(step.length) / static_cast<double>(step.duration));
  }
  const auto middle = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2);
  std::nth_element(speeds.begin(), middle, speeds.end());
  result.median_speed = *middle;
  double longest = 0.0;
  for (const Step& step : steps_) {
    const double length = static_cast<double>(step.length);
    const double speed = length / static_cast<double>(step.duration);
    if (length < 1.0 || speed < std::max(10.0, 10.0 * result.median_speed)) continue;
    ++result.jumps;
    longest = std::max(longest, length);
  }
  if (result.jumps > 0)
    result.findings.push_back(
        line("the sensor jumps %llu times, %.1f m at most, where its usual speed is %.2f m/s: "
             "check the trajectory, or --time_scale",
             static_cast<unsigned long long>(result.jumps), longest, result.median_speed));
}

namespace {

// A change of all origins that is tried out.
struct Move {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  double clock = 0.0;  // s
  std::string text;
};

std::vector<Move> moves_to_try(double speed) {
  std::vector<Move> moves;
  for (const double distance : {1.0, 3.0}) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        // Up by 3 m looks over moving things near the ground, so it always seems better.
        if (axis == 2 && sign > 0.0 && distance > 1.0) continue;
        Move move;
        move.shift[axis] = sign * distance;
        move.text =
            line("moving all origins by %.0f m along %c%c", distance, sign > 0.0 ? '+' : '-', 'x' + axis);
        moves.push_back(move);
      }
    }
    if (speed <= 0.0) continue;
    for (const double sign : {-1.0, 1.0}) {
      const double clock = sign * distance / speed;
      moves.push_back({.clock = clock, .text = line("changing the clock by %+.3g s", clock)});
    }
  }
  return moves;
}

class Walk {
 public:
  Walk(const Context& context, std::vector<OriginAudit::Sampled> sample)
      : context_(context), by_time_(std::move(sample)), patches_(context, bounded_ends(by_time_)) {
    std::vector<OriginAudit::Sampled> by_key = by_time_;
    std::erase_if(by_key,
                  [](const auto& ray) { return !ray.bounded || (ray.end - ray.start).norm() < 2.0f; });
    const auto smaller_key = [](const auto& a, const auto& b) { return a.key < b.key; };
    const std::size_t walked = std::min(by_key.size(), kMostWalked);
    const auto end = by_key.begin() + static_cast<std::ptrdiff_t>(walked);
    std::nth_element(by_key.begin(), end, by_key.end(), smaller_key);
    std::sort(by_key.begin(), end, smaller_key);
    by_key.resize(walked);
    walked_ = std::move(by_key);
    parallel_sort(context, by_time_.begin(), by_time_.end(),
                  [](const auto& a, const auto& b) { return a.time < b.time; });
  }

  [[nodiscard]] std::size_t walked() const { return walked_.size(); }

  // How many of the walked rays pass through a surface if the origins are moved; counting stops soon after
  // `enough`.
  [[nodiscard]] std::size_t through(const Move& move, std::size_t enough) const {
    constexpr std::size_t kBatch = 2048;
    std::size_t blocked = 0;
    for (std::size_t first = 0; first < walked_.size() && blocked <= enough; first += kBatch)
      blocked += through(move, first, std::min(first + kBatch, walked_.size()));
    return blocked;
  }

 private:
  [[nodiscard]] std::size_t through(const Move& move, std::size_t first, std::size_t last) const {
    return parallel_reduce(
        context_, last - first, 256, std::size_t{0},
        [&](std::size_t begin, std::size_t end) {
          std::size_t blocked = 0;
          for (std::size_t i = first + begin; i < first + end; ++i)
            blocked += patches_.blocks(moved_start(walked_[i], move), walked_[i].end.cast<double>()) ? 1 : 0;
          return blocked;
        },
        std::plus<>());
  }

  static std::vector<Eigen::Vector3d> bounded_ends(const std::vector<OriginAudit::Sampled>& sample) {
    std::vector<Eigen::Vector3d> ends;
    for (const auto& ray : sample)
      if (ray.bounded) ends.push_back(ray.end.cast<double>());
    return ends;
  }

  [[nodiscard]] Eigen::Vector3d moved_start(const OriginAudit::Sampled& ray, const Move& move) const {
    if (move.clock == 0.0) return ray.start.cast<double>() + move.shift;
    const auto later = std::lower_bound(by_time_.begin(), by_time_.end(), ray.time + move.clock,
                                        [](const auto& other, double time) { return other.time < time; });
    return (later == by_time_.end() ? by_time_.back() : *later).start.cast<double>();
  }

  const Context& context_;
  std::vector<OriginAudit::Sampled> by_time_;
  SurfacePatches patches_;
  std::vector<OriginAudit::Sampled> walked_;
};

}  // namespace

void OriginAudit::judge_surfaces(const Context& context, OriginFindings& result,
                                 const AuditOptions& options) const {
  const Walk walk(context, sample_);
  if (walk.walked() == 0) return;
  const std::size_t as_it_is = walk.through({}, walk.walked());
  result.through = static_cast<double>(as_it_is) / static_cast<double>(walk.walked());
  if (as_it_is < kFewestThrough) return;
  const double duration = last_time_ - first_time_;
  const double speed = options.real_times && duration > 0.0 ? result.path_length / duration : 0.0;
  std::size_t fewest = static_cast<std::size_t>(kHalved * static_cast<double>(as_it_is));
  std::string best;
  for (const Move& move : moves_to_try(speed)) {
    const std::size_t through = walk.through(move, fewest);
    if (through > fewest || (through == fewest && !best.empty())) continue;
    fewest = through;
    best = move.text;
  }
  if (!best.empty())
    result.findings.push_back(
        best + line(" would leave %.0f %% fewer rays passing through surfaces: check the origin, "
                    "--traj_offset and --time_offset",
                    100.0 - 100.0 * static_cast<double>(fewest) / static_cast<double>(as_it_is)));
  else if (result.through > kManyThrough)
    result.findings.push_back(
        line("%.0f %% of the rays pass through surfaces that others hit: check the trajectory, "
             "--time_offset and --traj_offset",
             100.0 * result.through));
}

}  // namespace ray
