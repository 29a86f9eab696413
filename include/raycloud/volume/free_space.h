#pragma once
/// What rays tell of an ellipsoid: how many ended in it, how many went through, and when (paper, section
/// VI-A).

#include <raycloud/core/ray_cloud.h>
#include <raycloud/exec/context.h>
#include <raycloud/volume/ellipsoid_tree.h>

#include <array>
#include <compare>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace ray {

/// When a ray that crosses an ellipsoid proves that nothing was there. With everything at 0, every ray does.
struct PassGuard {
  double beyond = 0.05;       ///< m, a bounded ray goes on at least so far after it has left the ellipsoid
  double depth = 0.05;        ///< m, and goes so far below the surface of a flat one
  double least_sine = 0.087;  ///< of the angle between the ray and the surface of a flat one
  double most_miss2 = 0.96;   ///< Chord::miss2: the chord is a fair share of the longest
};
/// The paper's rule: whatever crosses an ellipsoid has passed it.
inline constexpr PassGuard kEveryPass{0.0, 0.0, 0.0, 1.0};

/// Times in 65536 steps from the first to the last of a cloud.
class TimeScale {
 public:
  TimeScale(double first, double last)
      : first_(first), per_second_(last > first ? 65535.0 / (last - first) : 0.0) {}
  [[nodiscard]] std::uint16_t tick(double time) const {
    return static_cast<std::uint16_t>((time - first_) * per_second_);
  }
  [[nodiscard]] double ticks(double seconds) const { return seconds * per_second_; }

 private:
  double first_;
  double per_second_;
};

/// When an ellipsoid was hit: in at most four episodes, as the hits are parted at the three longest pauses
/// between them, where these are longer than a look. 18 bytes.
struct HitEpisodes {
  static constexpr std::size_t kEpisodes = 4;
  /// Before the first episode, between episodes, after the last.
  static constexpr std::size_t kRuns = kEpisodes + 1;

  /// Ticks of the first and last hit of each episode; those that there are not repeat the end of the last.
  std::array<std::uint16_t, kEpisodes> begins{};
  std::array<std::uint16_t, kEpisodes> ends{};
  std::uint16_t hits = 0;  ///< bounded rays that end in it, at most 60 000

  /// Which run a time is in; kRuns: in an episode.
  [[nodiscard]] std::size_t run_at(std::uint16_t tick) const {
    for (std::size_t i = 0; i < kEpisodes; ++i) {
      if (tick < begins[i]) return i;
      if (tick <= ends[i]) return kRuns;
    }
    return kEpisodes;
  }
  friend bool operator==(const HitEpisodes&, const HitEpisodes&) = default;
};
/// Of hits at these times, which it may sort. Pauses are longer than `look_ticks`.
[[nodiscard]] HitEpisodes episodes_of(std::vector<std::uint16_t>& ticks, double look_ticks);

/// Rays counted by where they stand to the times at which the ellipsoid was hit. Counts end at 60 000. 42
/// bytes.
struct Evidence : HitEpisodes {
  std::uint16_t crossings = 0;  ///< rays that begin before it and end behind it
  std::uint16_t within = 0;     ///< of these, those that prove it empty, in the time of an episode
  std::array<std::uint16_t, kRuns> passes{};  ///< and outside of them
  /// For each run a bit for each look, by its hash: passes of one time from about one direction.
  std::array<std::uint16_t, kRuns> looks{};

  friend bool operator==(const Evidence&, const Evidence&) = default;
};

struct CountRule {
  PassGuard guard;
  double look_time = 0.5;  ///< s
};

/// The times of all rays that end in ellipsoids, to find the episodes from. 36 bytes an ellipsoid, and 8 for
/// each hit above 16.
class HitTimes {
 public:
  explicit HitTimes(std::size_t ellipsoids) : counts_(ellipsoids), first_(ellipsoids) {}
  /// Any number of threads may add rays at once: every step is atomic, and their order does not matter. About
  /// 0.6 µs a ray.
  void add(const EllipsoidTree& tree, const RayCloud& rays, const TimeScale& scale);
  /// Called when all are there: sets `hits` and the episodes, by slot. Pauses are longer than `look_ticks`.
  void find_episodes(const Context& context, double look_ticks, std::span<Evidence> evidence);

 private:
  static constexpr std::size_t kFirst = 16;
  struct Further {
    std::uint32_t slot;
    std::uint16_t tick;
    friend auto operator<=>(const Further&, const Further&) = default;
  };
  std::vector<std::uint32_t> counts_;
  std::vector<std::array<std::uint16_t, kFirst>> first_;
  std::vector<Further> further_;
  std::mutex mutex_;
};

/// Adds the rays that cross ellipsoids to `crossings` and, by their time, to the others. Called when all
/// episodes are known. Threads as above. About 1 µs a ray.
void add_passes(const EllipsoidTree& tree, const RayCloud& rays, const CountRule& rule,
                const TimeScale& scale, std::span<Evidence> evidence);

}  // namespace ray
