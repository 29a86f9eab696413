#include "range_noise.h"

#include "mix_bits.h"

#include <raycloud/exec/parallel.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>
#include <utility>

namespace ray {
namespace {

std::uint64_t hash_of_place(const Eigen::Vector3d& place) {
  std::uint64_t hash = 0;
  for (const double coordinate : {place.x(), place.y(), place.z()})
    hash = mix_bits(hash + std::bit_cast<std::uint64_t>(coordinate));
  return hash;
}

/// Which points may be within reach of one of some others: all that are, and a few more.
class NearSome {
 public:
  NearSome(std::span<const SeenPoint> points, std::span<const std::uint32_t> some, double reach)
      : width_(kMargin * reach), marks_(kMarks) {
    for (const std::uint32_t i : some) {
      const Eigen::Vector3d middle = cube_of(points[i].end);
      for (const double x : {-1.0, 0.0, 1.0})
        for (const double y : {-1.0, 0.0, 1.0})
          for (const double z : {-1.0, 0.0, 1.0})
            marks_[mark_of(middle + Eigen::Vector3d(x, y, z))] = true;
    }
  }
  [[nodiscard]] bool may_be(const Eigen::Vector3d& point) const { return marks_[mark_of(cube_of(point))]; }

 private:
  static constexpr double kMargin = 1.0 + 1e-6;  // for rounding
  static constexpr std::size_t kMarks = 1 << 20;
  [[nodiscard]] Eigen::Vector3d cube_of(const Eigen::Vector3d& point) const {
    return (point / width_).array().floor();
  }
  static std::size_t mark_of(const Eigen::Vector3d& cube) {
    return hash_of_place(cube.array() + 0.0) % kMarks;  // -0 is 0
  }

  double width_;
  std::vector<bool> marks_;  ///< of cubes, by their hashes
};

}  // namespace

RangeNoise::RangeNoise(std::uint64_t bounded, double reach) : reach_(reach) {
  constexpr std::uint64_t kSample = 4096;
  stride_ = bounded / kSample + 1;
}

bool RangeNoise::is_in_sample(const Eigen::Vector3d& point) const {
  return hash_of_place(point) % stride_ == 0;
}

void RangeNoise::add(const Surfel& surfel) {
  constexpr double kFlat = 0.1;
  const SurfelRule rule = ellipsoid_rule(reach_);
  if (surfel.count <= rule.neighbours / 2 || surfel.variances[0] > kFlat * surfel.variances[1]) return;
  const double count = surfel.count;
  scatter_.push_back(std::sqrt(surfel.variances[0] * count / (count - 3.0)));
}

void RangeNoise::add(const Context& context, const PointTree& tree) {
  std::mutex mutex;
  parallel_for(context, tree.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    NeighbourSearch search(tree);
    std::vector<Surfel> found;
    SurfelFinder(search, ellipsoid_rule(reach_))
        .for_each(
            begin, end, [&](std::size_t place) { return is_in_sample(tree.point(place)); },
            [&](const SurfelOf& one) { found.push_back(one.surfel); });
    const std::lock_guard lock(mutex);
    for (const Surfel& surfel : found)
      add(surfel);
  });
}

void RangeNoise::add(const Context& context, const Block<SeenPoint>& block) {
  std::vector<std::uint32_t> asked;
  for (std::uint32_t i = 0; i < block.records.size(); ++i)
    if (block.is_own(i) && is_in_sample(block.records[i].end)) asked.push_back(i);
  // Nearly all have their neighbours within an eighth of the reach.
  constexpr double kFirst = 0.125, kWider = 2.0;
  for (double reach = kFirst * reach_; !asked.empty(); reach = std::min(kWider * reach, reach_))
    asked = add_within(context, block.records, asked, reach);
}

std::vector<std::uint32_t> RangeNoise::add_within(const Context& context, std::span<const SeenPoint> points,
                                                  std::span<const std::uint32_t> asked, double reach) {
  const bool is_last = reach >= reach_;
  const SurfelRule rule = ellipsoid_rule(reach);
  std::vector<SeenPoint> near;
  std::vector<std::uint32_t> asked_of_near;  // by index, where it is asked about; else after the last
  const auto none = static_cast<std::uint32_t>(points.size());
  std::vector<std::uint8_t> is_near(points.size(), 1);
  if (std::isfinite(reach)) {
    const NearSome near_asked(points, asked, reach);
    parallel_for(context, points.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        is_near[i] = near_asked.may_be(points[i].end) ? 1 : 0;
    });
  }
  auto next = asked.begin();
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (is_near[i] == 0) continue;
    near.push_back(points[i]);
    const bool is_asked = next != asked.end() && *next == i;
    asked_of_near.push_back(is_asked ? i : none);
    if (is_asked) ++next;
  }
  const PointTree tree(context, near);
  NeighbourSearch search(tree);
  std::vector<std::uint32_t> left;
  SurfelFinder(search, rule)
      .for_each(
          0, tree.size(), [&](std::size_t place) { return asked_of_near[tree.index(place)] != none; },
          [&](const SurfelOf& found) {
            if (is_last || found.surfel.count > rule.neighbours)
              add(found.surfel);
            else
              left.push_back(asked_of_near[tree.index(found.place)]);
          });
  std::sort(left.begin(), left.end());
  return left;
}

double RangeNoise::value() const {
  constexpr double kUsual = 0.015, kLeast = 0.002, kMost = 0.1;  // m
  if (scatter_.empty()) return kUsual;
  std::vector<double> scatter = scatter_;
  const auto middle = scatter.begin() + static_cast<std::ptrdiff_t>(scatter.size() / 2);
  std::nth_element(scatter.begin(), middle, scatter.end());
  return std::clamp(*middle, kLeast, kMost);
}

}  // namespace ray
