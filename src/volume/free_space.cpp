#include <raycloud/volume/free_space.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace ray {
namespace {

constexpr std::uint16_t kMostCounted = 60000;

void count(std::uint16_t& counter) {
  const std::atomic_ref<std::uint16_t> atomic(counter);
  std::uint16_t known = atomic.load(std::memory_order_relaxed);
  while (known < kMostCounted && !atomic.compare_exchange_weak(known, static_cast<std::uint16_t>(known + 1),
                                                               std::memory_order_relaxed)) {
  }
}

template <class Better>
void improve(double& value, double by, const Better& better) {
  const std::atomic_ref<double> atomic(value);
  double known = atomic.load(std::memory_order_relaxed);
  while (better(by, known) && !atomic.compare_exchange_weak(known, by, std::memory_order_relaxed)) {
  }
}

void add_look(std::uint64_t& looks, std::uint64_t look) {
  const std::atomic_ref<std::uint64_t> atomic(looks);
  if ((atomic.load(std::memory_order_relaxed) & look) == 0) atomic.fetch_or(look, std::memory_order_relaxed);
}

/// The bit of a look: a piece of time, and one of 26 directions.
std::uint64_t look_of(double time, const Eigen::Vector3d& way, double look_time) {
  const double most = way.cwiseAbs().maxCoeff();
  const Eigen::Vector3d side = most > 0.0 ? Eigen::Vector3d(way / most) : way;
  const auto third = [](double v) { return std::uint64_t{v > 0.5 ? 2U : v < -0.5 ? 0U : 1U}; };
  const auto when = static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(time / look_time)));
  std::uint64_t hash = when * 27 + third(side.x()) + 3 * third(side.y()) + 9 * third(side.z());
  hash = (hash ^ hash >> 30) * 0xbf58476d1ce4e5b9ULL;
  hash = (hash ^ hash >> 27) * 0x94d049bb133111ebULL;
  return std::uint64_t{1} << (hash >> 58);
}

void hit(Evidence& evidence, double time) {
  count(evidence.hits);
  improve(evidence.first_hit, time, std::less<>());
  improve(evidence.last_hit, time, std::greater<>());
}

struct Passing {
  Eigen::Vector3d start;
  Eigen::Vector3d end;
  double length;
  double time;
  bool bounded;
};

bool proves_empty(const Ellipsoid& ellipsoid, const Chord& chord, const Passing& ray,
                  const PassGuard& guard) {
  if (chord.miss2 > guard.most_miss2) return false;
  const double beyond = (1.0 - chord.leaves) * ray.length;
  if (ray.bounded && beyond < guard.beyond) return false;
  if (!ellipsoid.is_flat()) return true;
  const double sine = std::abs(ellipsoid.normal.dot(ray.end - ray.start)) / ray.length;
  return sine >= guard.least_sine && (!ray.bounded || beyond * sine >= guard.depth);
}

}  // namespace

void add_hits(const EllipsoidTree& tree, const RayCloud& rays, std::span<Evidence> evidence) {
  std::vector<std::uint32_t> slots;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays.bounded[i] == 0) continue;
    tree.near_point(rays.ends[i], slots);
    for (const std::uint32_t slot : slots)
      if (is_inside(tree.at_slot(slot), rays.ends[i])) hit(evidence[slot], rays.times[i]);
  }
}

void add_passes(const EllipsoidTree& tree, const RayCloud& rays, const CountRule& rule,
                std::span<Evidence> evidence) {
  std::vector<std::uint32_t> slots;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    tree.near_line(rays.starts[i], rays.ends[i], slots);
    if (slots.empty()) continue;
    const Passing ray{rays.starts[i], rays.ends[i], (rays.ends[i] - rays.starts[i]).norm(), rays.times[i],
                      rays.bounded[i] != 0};
    const std::uint64_t look = look_of(ray.time, ray.end - ray.start, rule.look_time);
    for (const std::uint32_t slot : slots) {
      const Ellipsoid ellipsoid = tree.at_slot(slot);
      const Chord chord = chord_of(ellipsoid, ray.start, ray.end);
      if (chord.miss2 > 1.0 || !(chord.enters > 0.0 && chord.leaves < 1.0)) continue;
      Evidence& seen = evidence[slot];
      count(seen.crossings);
      if (!proves_empty(ellipsoid, chord, ray, rule.guard)) continue;
      if (ray.time < seen.first_hit) {
        count(seen.before);
        add_look(seen.looks_before, look);
      } else if (ray.time > seen.last_hit) {
        count(seen.after);
        add_look(seen.looks_after, look);
      } else {
        count(seen.within);
      }
    }
  }
}

}  // namespace ray
