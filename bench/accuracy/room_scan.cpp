#include "room_scan.h"

#include <raycloud/synth/scanner.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace bench {

namespace {

using Eigen::Vector3d;

constexpr double kShare = 0.01;  // of each kind

const Vector3d kLow(-3.0, -2.5, 0.0);
const Vector3d kHigh(3.0, 2.5, 2.6);

struct Box {
  Vector3d low, high;
};
struct Rod {  ///< a cylinder without ends, seen from outside
  Vector3d from, to;
  double radius;
  RoomPart part;
};

const std::array kBoxes{Box{{0.9, 0.6, 0.0}, {1.7, 1.2, 0.7}}, Box{{-2.2, -1.9, 0.70}, {-0.8, -1.1, 0.73}}};
constexpr int kRails = 20;
const std::array kRods{Rod{{1.6, -1.2, 0.0}, {1.6, -1.2, 2.6}, 0.04, kSolid},
                       Rod{{-1.5, 1.4, 0.0}, {-1.5, 1.4, 2.6}, 0.04, kSolid},
                       Rod{{0.2, 1.9, 0.0}, {0.2, 1.9, 2.6}, 0.04, kSolid},
                       Rod{{-3.0, 1.0, 2.2}, {3.0, 1.2, 2.2}, 0.003, kWire},
                       Rod{{-3.0, -1.5, 1.6}, {3.0, -1.4, 1.9}, 0.003, kWire},
                       Rod{{2.2, -2.5, 1.2}, {2.0, 2.5, 1.3}, 0.003, kWire},
                       Rod{{-2.0, 0.3, 0.0}, {-2.0, 0.3, 2.6}, 0.003, kWire}};

struct Hit {
  double range = std::numeric_limits<double>::infinity();
  Vector3d normal = Vector3d::Zero();
  RoomPart part = kNothing;
};

/// The ranges between which a ray is inside a box, and the axes of the faces.
struct Passage {
  double in = -std::numeric_limits<double>::infinity();
  double out = std::numeric_limits<double>::infinity();
  int in_axis = 0, out_axis = 0;
};
Passage passage(const Box& box, const Vector3d& origin, const Vector3d& direction) {
  Passage p;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.low[axis] - origin[axis]) / direction[axis];
    const double b = (box.high[axis] - origin[axis]) / direction[axis];
    if (std::min(a, b) > p.in) p.in = std::min(a, b), p.in_axis = axis;
    if (std::max(a, b) < p.out) p.out = std::max(a, b), p.out_axis = axis;
  }
  return p;
}

Vector3d against(int axis, const Vector3d& direction) {
  return direction[axis] > 0.0 ? Vector3d(-Vector3d::Unit(axis)) : Vector3d(Vector3d::Unit(axis));
}

void meet_rod(const Rod& rod, const Vector3d& origin, const Vector3d& direction, Hit& hit) {
  const Vector3d along = (rod.to - rod.from).normalized();
  const auto across = [&](const Vector3d& v) -> Vector3d { return v - v.dot(along) * along; };
  const Vector3d o = across(origin - rod.from);
  const Vector3d d = across(direction);
  const double half = o.dot(d);
  const double under = half * half - d.squaredNorm() * (o.squaredNorm() - rod.radius * rod.radius);
  if (under <= 0.0) return;
  const double range = (-half - std::sqrt(under)) / d.squaredNorm();
  const double place = (origin + range * direction - rod.from).dot(along);
  if (range > 0.0 && range < hit.range && place > 0.0 && place < (rod.to - rod.from).norm())
    hit = {range, (o + range * d).normalized(), rod.part};
}

Hit cast(const Vector3d& origin, const Vector3d& direction) {
  Hit hit;
  const Passage room = passage({kLow, kHigh}, origin, direction);
  const bool sky = room.out_axis == 2 && direction.z() > 0.0;
  hit = {room.out, against(room.out_axis, direction), sky ? kNothing : kSolid};
  for (const Box& box : kBoxes) {
    const Passage p = passage(box, origin, direction);
    if (p.in < p.out && p.in > 0.0 && p.in < hit.range) hit = {p.in, against(p.in_axis, direction), kSolid};
  }
  for (const Rod& rod : kRods)
    meet_rod(rod, origin, direction, hit);
  for (int i = 0; i < kRails; ++i) {
    const Vector3d foot(2.3, 0.2 * i - 1.9, 0.0);
    meet_rod({foot, foot + 1.2 * Vector3d::UnitZ(), 0.025, kSolid}, origin, direction, hit);
  }
  return hit;
}

/// Takes the ray to a noisy end, if it is not one already.
class NoiseMaker {
 public:
  NoiseMaker(Sampled& scan, const std::vector<Hit>& hits, std::uint64_t seed)
      : scan_(scan), hits_(hits), random_(seed, "kinds of noise"), count_(hits.size()) {}

  /// `draw(row, u)` is the range of noise at a row, none where there cannot be any. Until there is enough.
  template <class Draw>
  void put(RoomPart kind, const Draw& draw) {
    const auto wanted = static_cast<std::uint64_t>(kShare * static_cast<double>(count_));
    std::uint64_t made = 0;
    for (std::uint64_t i = 0; made < wanted && i < 30 * count_; ++i) {
      const std::uint64_t at = i * 8 + static_cast<std::uint64_t>(kind);
      const auto row = static_cast<std::size_t>(random_.below(count_, at, 0));
      if (scan_.truth[row].part > kWire && scan_.truth[row].part != kNothing) continue;
      if (hits_[row].part == kWire) continue;
      const std::optional<double> range = draw(row, random_.uniform(at, 1), random_.uniform(at, 2));
      if (!range) continue;
      const Vector3d& start = scan_.rays.starts[row];
      scan_.rays.ends[row] = start + *range * (scan_.truth[row].end - start).normalized();
      scan_.rays.bounded[row] = 1;
      scan_.truth[row].part = kind;
      ++made;
    }
  }

 private:
  Sampled& scan_;
  const std::vector<Hit>& hits_;
  ray::RandomStream random_;
  std::uint64_t count_;
};

void add_noise(Sampled& scan, const std::vector<Hit>& hits, const NoiseKinds& kinds, std::size_t beams,
               std::uint64_t seed) {
  NoiseMaker maker(scan, hits, seed);
  // Rays are even in all directions: taken by the cube of their way through the room, they fill it evenly.
  if (kinds.uniform) {
    maker.put(kUniform, [&](std::size_t row, double u, double v) -> std::optional<double> {
      const Vector3d& start = scan.rays.starts[row];
      const double way = passage({kLow, kHigh}, start, (scan.truth[row].end - start).normalized()).out;
      const double longest = (kHigh - kLow).norm();
      if (u > std::pow(way / longest, 3)) return std::nullopt;
      return way * std::cbrt(v);
    });
  }
  if (kinds.mixed) {
    maker.put(kMixed, [&](std::size_t row, double u, double v) -> std::optional<double> {
      if (row / beams % 2 == 1) return std::nullopt;  // every edge keeps real neighbours
      const std::size_t other = u < 0.5 ? row - beams : row + beams;
      if (other >= hits.size() || hits[other].part == kNothing || hits[row].part == kNothing)
        return std::nullopt;
      if (std::abs(hits[other].range - hits[row].range) < 0.3) return std::nullopt;
      return hits[row].range + v * (hits[other].range - hits[row].range);
    });
  }
  if (kinds.dust) {
    maker.put(kDust, [&](std::size_t row, double u, double) -> std::optional<double> {
      const double furthest = std::min(3.0, hits[row].range);
      if (furthest < 0.3) return std::nullopt;
      return 0.3 + u * (furthest - 0.3);
    });
  }
}

}  // namespace

Sampled room_scan(std::uint64_t seed, const NoiseKinds& kinds, const RoomScanner& scanner) {
  const std::uint64_t rays = scanner.rays;
  const double offset = 0.1 * static_cast<double>(seed);
  const double duration = static_cast<double>(rays) / 314'000.0;
  const ray::Trajectory path{.times = {0.0, duration},
                             .positions = {{-0.4 - offset, scanner.aside - 0.2, 1.3},
                                           {0.4 - offset, scanner.aside + 0.2 * offset, 1.35}}};
  const ray::ScanPlan plan(ray::SpinningScanner{.beams = scanner.beams}, path, rays);
  const ray::RandomStream noise(seed, "noise of range");
  Sampled scan;
  scan.rays.resize(rays);
  std::vector<Hit> hits;
  for (std::uint64_t i = 0; i < rays; ++i) {
    const ray::Shot shot = plan.shot(i);
    const Hit hit = cast(shot.origin, shot.direction);
    const bool bounded = hit.part != kNothing;
    const auto row = static_cast<std::size_t>(i);
    scan.rays.starts[row] = shot.origin;
    scan.rays.times[row] = shot.time;
    scan.rays.bounded[row] = bounded ? 1 : 0;
    const double wrong = bounded ? scanner.noise * normal_number(noise, i) : 0.0;
    scan.rays.ends[row] = shot.origin + (hit.range + wrong) * shot.direction;
    scan.truth.push_back({shot.origin + hit.range * shot.direction, hit.normal, hit.part});
    hits.push_back(hit);
  }
  add_noise(scan, hits, kinds, static_cast<std::size_t>(scanner.beams), seed);
  return scan;
}

}  // namespace bench
