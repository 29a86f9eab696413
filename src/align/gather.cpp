#include "patches.h"

#include <raycloud/exec/stream.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <deque>

namespace ray::align {
namespace {

constexpr double kOffsetSteps = 1024.0;      // of a width, in which offsets are summed
constexpr std::uint32_t kMostPoints = 4095;  // so that sums of squares fit in 32 bits
constexpr double kFurthest = 1 << 19;        // widths
constexpr double kDirectionSteps = 7.0;      // so that sums fit in 16 bits

/// An end on its way to its patch.
struct Sighting {
  std::uint64_t key;
  std::array<std::uint16_t, 3> offset;
  std::array<std::int8_t, 3> to_sensor;
  std::uint32_t row;
};

/// The sums of a patch.
struct Sums {
  std::uint64_t key = 0;
  std::uint32_t count = 0;
  std::array<std::uint32_t, 3> first{};
  std::array<std::uint32_t, 6> second{};  // xx xy xz yy yz zz
  std::array<std::int16_t, 3> to_sensor{};
  Eigen::Vector3f sensor, seen;  // of the first
};

/// Which of the six faces of a cube looks most towards the sensor.
std::uint64_t side_of(const Eigen::Vector3d& to_sensor) {
  Eigen::Index axis = 0;
  to_sensor.cwiseAbs().maxCoeff(&axis);
  return static_cast<std::uint64_t>(2 * axis + (to_sensor[axis] < 0.0 ? 1 : 0));
}

/// 20 bits an axis, then the side.
std::uint64_t key_of(const Eigen::Array3d& cube, std::uint64_t side) {
  const Eigen::Array<std::uint64_t, 3, 1> positive = (cube + kFurthest).cast<std::uint64_t>();
  return ((positive.z() << 20 | positive.y()) << 20 | positive.x()) << 3 | side;
}

Eigen::Vector3d corner_of(std::uint64_t key, double width) {
  constexpr std::uint64_t kMask = (1 << 20) - 1;
  const Eigen::Array3d cube(static_cast<double>(key >> 3 & kMask), static_cast<double>(key >> 23 & kMask),
                            static_cast<double>(key >> 43 & kMask));
  return (cube - kFurthest) * width;
}

/// One to one, and as good as random; never 0 (the finaliser of MurmurHash3).
std::uint64_t shuffled(std::uint64_t key) {
  key |= std::uint64_t{1} << 63;
  key ^= key >> 33;
  key *= 0xff51afd7ed558ccdU;
  key ^= key >> 33;
  key *= 0xc4ceb9fe1a85ec53U;
  return key ^ (key >> 33);
}

std::vector<Sighting> sightings_of(const RayCloud& rays, const Eigen::Vector3d& origin, double width) {
  std::vector<Sighting> sightings;
  sightings.reserve(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays.bounded[i] == 0) continue;
    const Eigen::Array3d place = (rays.ends[i] - origin).array() / width;
    const Eigen::Array3d cube = place.floor();
    if (!(cube.abs() < kFurthest - 1.0).all()) continue;
    const Eigen::Vector3d to_sensor = rays.starts[i] - rays.ends[i];
    const double length = std::max(to_sensor.norm(), 1e-9);
    Sighting sighting{key_of(cube, side_of(to_sensor)), {}, {}, static_cast<std::uint32_t>(i)};
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<std::size_t>(axis);
      sighting.offset[at] = static_cast<std::uint16_t>((place[axis] - cube[axis]) * kOffsetSteps);
      sighting.to_sensor[at] =
          static_cast<std::int8_t>(std::lround(to_sensor[axis] / length * kDirectionSteps));
    }
    sightings.push_back(sighting);
  }
  return sightings;
}

void add(const Sighting& sighting, Sums& sums) {
  if (sums.count == kMostPoints) return;
  ++sums.count;
  std::size_t at = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t offset = sighting.offset[i];
    sums.first[i] += offset;
    sums.to_sensor[i] = static_cast<std::int16_t>(sums.to_sensor[i] + sighting.to_sensor[i]);
    for (std::size_t j = i; j < 3; ++j)
      sums.second[at++] += offset * sighting.offset[j];
  }
}

Gathered gathered_of(const Sums& sums, double width) {
  Gathered gathered;
  gathered.key = sums.key;
  gathered.count = sums.count;
  gathered.sensor = sums.sensor;
  gathered.seen = sums.seen;
  const double step = width / kOffsetSteps;
  Eigen::Vector3d mean;
  for (Eigen::Index i = 0; i < 3; ++i) {
    mean[i] = sums.first[static_cast<std::size_t>(i)] / gathered.count;
    gathered.to_sensor[i] = sums.to_sensor[static_cast<std::size_t>(i)];
  }
  Eigen::Index at = 0;
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = i; j < 3; ++j, ++at)
      gathered.scatter[at] =
          (sums.second[static_cast<std::size_t>(at)] - gathered.count * mean[i] * mean[j]) * step * step;
  // Offsets were rounded down: half a step, on average.
  gathered.mean = corner_of(sums.key, width) + (mean.array() + 0.5).matrix() * step;
  return gathered;
}

/// One in 2^level of the unbounded rays, by a hash of where they are, as PointSample does.
class SkySample {
 public:
  void add(const RayCloud& rays, const Eigen::Vector3d& origin) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (rays.bounded[i] != 0) continue;
      const Segment segment{(rays.starts[i] - origin).cast<float>(), (rays.ends[i] - origin).cast<float>()};
      if (!is_chosen(segment)) continue;
      segments_.push_back(segment);
      while (segments_.size() > kMost) {
        ++level_;
        std::erase_if(segments_, [this](const Segment& s) { return !is_chosen(s); });
      }
    }
  }
  [[nodiscard]] std::vector<Segment> take() { return std::move(segments_); }

 private:
  static constexpr std::size_t kMost = 20000;

  [[nodiscard]] bool is_chosen(const Segment& segment) const {
    std::uint64_t hash = 0;
    for (const float value : {segment.end.x(), segment.end.y(), segment.end.z(), segment.start.x()})
      hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x9e3779b97f4a7c15U, hash ^= hash >> 29;
    return level_ == 0 || hash >> (64 - level_) == 0;
  }

  int level_ = 0;
  std::vector<Segment> segments_;
};

}  // namespace

Surfaces gather_surfaces(const Context& context, RaySource& source, const Survey& survey, double width) {
  constexpr std::size_t kAhead = 16;  // enough cache misses in flight to hide one
  Surfaces surfaces{survey, width, {}, {}};
  std::deque<Sums> all;
  KeyTable<std::uint32_t> numbers;
  SkySample sky;
  stream(
      context, source, nullptr,
      [&](const RayCloud& rays) { return sightings_of(rays, survey.origin, width); },
      [&](const RayCloud& rays, const std::vector<Sighting>& sightings) {
        for (std::size_t i = 0; i < sightings.size(); ++i) {
          if (i + kAhead < sightings.size()) numbers.prefetch(shuffled(sightings[i + kAhead].key));
          const auto added = numbers.add(shuffled(sightings[i].key));
          if (added.is_new) {
            *added.value = static_cast<std::uint32_t>(all.size());
            all.emplace_back().key = sightings[i].key;
            all.back().sensor = (rays.starts[sightings[i].row] - survey.origin).cast<float>();
            all.back().seen = (rays.ends[sightings[i].row] - survey.origin).cast<float>();
          }
          add(sightings[i], all[*added.value]);
        }
        sky.add(rays, survey.origin);
      });
  source.rewind();
  surfaces.sky = sky.take();
  surfaces.gathered.resize(all.size());
  struct Place {
    std::uint64_t key;
    std::uint32_t from;
  };
  std::vector<Place> places(all.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i] = {all[i].key, static_cast<std::uint32_t>(i)};
  parallel_sort(context, places.begin(), places.end(),
                [](const Place& a, const Place& b) { return a.key < b.key; });
  parallel_for(context, places.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      surfaces.gathered[i] = gathered_of(all[places[i].from], width);
  });
  return surfaces;
}

}  // namespace ray::align
