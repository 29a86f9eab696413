#include "mover_shapes.h"

#include <raycloud/exec/random.h>
#include <raycloud/synth/movers.h>
#include <raycloud/synth/scene_caster.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

namespace ray {
namespace {

constexpr double kStep = 0.1;  // s, between nodes
constexpr int kTries = 400;

enum class Habit { stop_and_go, appears_once, leaves_once };

struct Kind {
  SceneLabel label;
  double radius;                  ///< m, that must be free around it
  double from_scanner;            ///< m
  double speed;                   ///< m/s
  double least_aside;             ///< m, from the scanner's path
  double most_aside;              ///< m
  std::array<double, 3> heights;  ///< m, at which it must be free
};
constexpr Kind kPerson{SceneLabel::person, 0.35, 0.9, 1.2, 0.0, 2.5, {0.5, 1.0, 1.6}};
constexpr Kind kVehicle{SceneLabel::vehicle, 2.4, 4.0, 3.0, 3.0, 9.0, {0.8, 1.1, 1.4}};

/// The scanner's path by length walked, as a track for others.
class Track {
 public:
  explicit Track(const Trajectory& path) : path_(path), lengths_{0.0} {
    for (std::size_t i = 1; i < path.size(); ++i)
      lengths_.push_back(lengths_.back() + (path.positions[i] - path.positions[i - 1]).norm());
  }

  [[nodiscard]] double length() const { return lengths_.back(); }

  /// `aside` m to the left of the place after `walked` m.
  [[nodiscard]] Eigen::Vector3d place(double walked, double aside) const {
    constexpr double kAhead = 0.5;
    const Eigen::Vector3d along = on_path(walked + kAhead) - on_path(walked - kAhead);
    const Eigen::Vector3d left(-along.y(), along.x(), 0.0);
    const double norm = left.norm();
    return norm > 0.0 ? Eigen::Vector3d(on_path(walked) + aside / norm * left) : on_path(walked);
  }

  /// Length walked by the scanner itself.
  [[nodiscard]] double walked_at(double time) const {
    const TrajectorySpot spot = spot_at(path_, time);
    const std::size_t next = std::min(spot.node + 1, lengths_.size() - 1);
    return (1.0 - spot.fraction) * lengths_[spot.node] + spot.fraction * lengths_[next];
  }

 private:
  [[nodiscard]] Eigen::Vector3d on_path(double walked) const {
    const double within = std::clamp(walked, 0.0, length());
    const auto after = std::upper_bound(lengths_.begin(), lengths_.end(), within) - lengths_.begin();
    const std::size_t next = std::min(static_cast<std::size_t>(after), lengths_.size() - 1);
    if (next == 0) return path_.positions.front();
    const double span = lengths_[next] - lengths_[next - 1];
    const double fraction = span > 0.0 ? (within - lengths_[next - 1]) / span : 0.0;
    return (1.0 - fraction) * path_.positions[next - 1] + fraction * path_.positions[next];
  }

  const Trajectory& path_;
  std::vector<double> lengths_;
};

/// One try: where along the track, when, and how.
struct Plan {
  Habit habit = Habit::stop_and_go;
  std::pair<double, double> present;  ///< s
  double go_at = 0.0;                 ///< s; leaves_once: stands still before
  double start = 0.0;                 ///< m along the track, or ahead of the scanner
  double aside = 0.0;                 ///< m
  double go_for = 4.0;                ///< s
  double stand_for = 5.0;             ///< s
  bool with_scanner = false;          ///< keeps ahead of the scanner
};

Plan plan_of(Habit habit, const Kind& kind, const Track& track, std::pair<double, double> times,
             const RandomStream& random, std::uint64_t attempt) {
  std::uint64_t draw = 0;
  const auto between = [&](double low, double high) {
    return low + (high - low) * random.uniform(attempt, draw++);
  };
  // A way that cannot be had for long may be had for a shorter time.
  const double share = attempt < kTries / 2 ? 1.0 : 0.5;
  const double duration = times.second - times.first;
  Plan plan{.habit = habit, .present = times};
  plan.start = between(0.0, track.length());
  plan.aside = between(kind.least_aside, kind.most_aside) * (between(0.0, 1.0) < 0.5 ? -1.0 : 1.0);
  plan.go_for = between(3.0, 6.0);
  plan.stand_for = between(4.0, 7.0);
  if (habit == Habit::appears_once) {
    plan.present.first = times.first + duration * between(0.1, 0.6);
    plan.present.second = plan.present.first + duration * share * between(0.15, 0.35);
  } else if (habit == Habit::leaves_once) {
    plan.present.second = times.first + duration * share * between(0.4, 0.8);
    plan.go_at = std::max(times.first, plan.present.second - between(4.0, 10.0));
  } else if (share < 1.0) {
    plan.present.first = times.first + duration * between(0.0, 0.6);
    plan.present.second = plan.present.first + duration * between(0.2, 0.4);
  } else if (between(0.0, 1.0) < 0.7) {
    plan.with_scanner = true;
    plan.start = between(3.0, 10.0);
  }
  return plan;
}

class Placer {
 public:
  explicit Placer(const Scene& scene) : scene_(scene), caster_(scene), track_(scene.path) {}

  [[nodiscard]] std::pair<double, double> times() const {
    return {scene_.path.times.front(), scene_.path.times.back()};
  }
  [[nodiscard]] const Track& track() const { return track_; }

  /// The motion of the plan, if nothing is in its way.
  [[nodiscard]] std::optional<Trajectory> motion(const Plan& plan, const Kind& kind) const {
    Trajectory motion;
    double walked = plan.start;
    Eigen::Vector3d checked = Eigen::Vector3d::Constant(1e9);
    const double last = std::min(plan.present.second, times().second);
    const auto steps = static_cast<std::size_t>(std::ceil((last - plan.present.first) / kStep));
    for (std::size_t i = 0; i <= steps; ++i) {
      const double time = plan.present.first + static_cast<double>(i) * kStep;
      if (i > 0) walked = next(plan, kind, walked, time);
      const auto feet = floor_below(track_.place(walked, plan.aside), time);
      if (!feet || !is_far_from_others(*feet, time, kind)) return std::nullopt;
      if ((*feet - checked).norm() > 0.4 * kind.radius) {
        if (!is_free(*feet, time, kind)) return std::nullopt;
        checked = *feet;
      }
      motion.times.push_back(time);
      motion.positions.push_back(*feet);
    }
    constexpr double kSteepest = 0.5;  // m from one node to the next: a fall off a wall, not a walk
    for (std::size_t i = 1; i < motion.size(); ++i) {
      if (std::abs(motion.positions[i].z() - motion.positions[i - 1].z()) > kSteepest) return std::nullopt;
    }
    if ((motion.positions.back() - motion.positions.front()).norm() < 1.0) return std::nullopt;
    face_forward(motion);
    return motion;
  }

  void add(const Trajectory& motion, std::pair<double, double> present, const Kind& kind) {
    placed_.push_back({motion, present, kind.radius});
  }

 private:
  struct Placed {
    Trajectory motion;
    std::pair<double, double> present;
    double radius;
  };

  /// How far along it is one node later.
  [[nodiscard]] double next(const Plan& plan, const Kind& kind, double walked, double time) const {
    const double since = time - plan.present.first;
    bool goes = true;
    if (plan.habit == Habit::stop_and_go) {
      const double cycle = plan.go_for + plan.stand_for;
      goes = since - cycle * std::floor(since / cycle) < plan.go_for;
    } else if (plan.habit == Habit::leaves_once) {
      goes = time >= plan.go_at;
    }
    if (!goes) return walked;
    const double step = kind.speed * kStep;
    if (!plan.with_scanner) return std::min(walked + step, track_.length());
    // Half as fast again as it must be to regain its lead, which it never lets grow.
    const double lead = track_.walked_at(time) + plan.start;
    return std::min({std::max(walked, std::min(walked + 2.0 * step, lead)), track_.length()});
  }

  [[nodiscard]] std::optional<Eigen::Vector3d> floor_below(Eigen::Vector3d from, double time) const {
    constexpr int kLayers = 6;
    constexpr double kDeepest = 4.0;  // m
    for (int layer = 0; layer < kLayers; ++layer) {
      const auto hit = caster_.cast(from, -Eigen::Vector3d::UnitZ(), kDeepest, time);
      if (!hit) return std::nullopt;
      from.z() -= hit->range;
      const SceneLabel label = scene_.objects[hit->object].label;
      if (label == SceneLabel::ground || label == SceneLabel::floor || label == SceneLabel::stairs)
        return from;
      from.z() -= 1e-4;
    }
    return std::nullopt;
  }

  [[nodiscard]] bool is_far_from_others(const Eigen::Vector3d& feet, double time, const Kind& kind) const {
    const Eigen::Vector3d middle = feet + Eigen::Vector3d(0.0, 0.0, kind.heights[1]);
    const Eigen::Vector3d scanner = position_at(scene_.path, spot_at(scene_.path, time));
    if ((middle - scanner).norm() < kind.from_scanner + kind.radius) return false;
    const auto near = [&](const Eigen::Vector3d& station) {
      return (middle - station).norm() < kind.from_scanner + kind.radius;
    };
    if (std::any_of(scene_.stations.begin(), scene_.stations.end(), near)) return false;
    return std::none_of(placed_.begin(), placed_.end(), [&](const Placed& other) {
      if (time < other.present.first || time >= other.present.second) return false;
      const Eigen::Vector3d place = position_at(other.motion, spot_at(other.motion, time));
      return (place - feet).norm() < kind.radius + other.radius;
    });
  }

  [[nodiscard]] bool is_free(const Eigen::Vector3d& feet, double time, const Kind& kind) const {
    static constexpr std::array<std::array<double, 2>, 8> kAround{
        {{1, 0}, {0.8, 0.6}, {0, 1}, {-0.6, 0.8}, {-1, 0}, {-0.8, -0.6}, {0, -1}, {0.6, -0.8}}};
    for (const double height : kind.heights) {
      const Eigen::Vector3d middle = feet + Eigen::Vector3d(0.0, 0.0, height);
      for (const auto& [x, y] : kAround) {
        if (caster_.cast(middle, {x, y, 0.0}, kind.radius, time)) return false;
      }
    }
    const Eigen::Vector3d knee = feet + Eigen::Vector3d(0.0, 0.0, kind.heights[0]);
    return !caster_.cast(knee, Eigen::Vector3d::UnitZ(), kind.heights[2] - kind.heights[0] + 0.2, time);
  }

  /// Turned to where it is half a second later from where it was half a second before; as it stood while it
  /// stands.
  static void face_forward(Trajectory& motion) {
    constexpr std::size_t kNodes = 5;
    constexpr double kLeast = 0.05;  // m
    Eigen::Vector2d heading(1.0, 0.0);
    for (std::size_t i = 0; i < motion.size(); ++i) {
      const std::size_t before = i < kNodes ? 0 : i - kNodes;
      const std::size_t after = std::min(i + kNodes, motion.size() - 1);
      const Eigen::Vector2d way = (motion.positions[after] - motion.positions[before]).head<2>();
      if (way.norm() > kLeast) heading = way / way.norm();
      const double cosine = std::sqrt(std::max(0.0, 0.5 * (1.0 + heading.x())));
      const double sine = std::sqrt(std::max(0.0, 0.5 * (1.0 - heading.x())));
      motion.orientations.emplace_back(cosine, 0.0, 0.0, heading.y() < 0.0 ? -sine : sine);
      motion.orientations.back().normalize();
    }
  }

  const Scene& scene_;
  SceneCaster caster_;
  Track track_;
  std::vector<Placed> placed_;
};

std::string name_of(const Kind& kind, Habit habit, int number) {
  static constexpr std::array kHabits{"stop and go", "appears once", "leaves once"};
  return label_name(kind.label) + " " + std::to_string(number) + ", " +
         kHabits[static_cast<std::size_t>(habit)];
}

/// One mover, if there is a way for it. Its id is not set.
std::optional<SceneObject> place(Placer& placer, Habit habit, const Kind& kind, int number,
                                 std::uint64_t seed) {
  const RandomStream random(seed, label_name(kind.label) + std::to_string(number));
  for (std::uint64_t attempt = 0; attempt < kTries; ++attempt) {
    const Plan plan = plan_of(habit, kind, placer.track(), placer.times(), random, attempt);
    auto motion = placer.motion(plan, kind);
    if (!motion) continue;
    SceneObject object;
    object.label = kind.label;
    object.name = name_of(kind, habit, number);
    object.mesh = kind.label == SceneLabel::person ? person_mesh() : vehicle_mesh();
    // What is there from the beginning, or to the end, is so whenever a ray is cast.
    const auto [begin, end] = placer.times();
    if (plan.present.first > begin) object.present.first = plan.present.first;
    if (plan.present.second < end) object.present.second = plan.present.second;
    placer.add(*motion, object.present, kind);
    object.motion = *std::move(motion);
    return object;
  }
  return std::nullopt;
}

}  // namespace

Scene with_movers(Scene scene, int count, std::uint64_t seed) {
  std::vector<SceneObject> movers;
  {
    Placer placer(scene);
    for (int number = 1; number <= count; ++number) {
      const auto habit = static_cast<Habit>((number - 1) % 3);
      std::optional<SceneObject> mover;
      if (number % 4 == 2) mover = place(placer, habit, kVehicle, number, seed);
      if (!mover) mover = place(placer, habit, kPerson, number, seed);
      if (mover) movers.push_back(*std::move(mover));
    }
  }
  for (SceneObject& mover : movers) {
    mover.id = static_cast<std::int32_t>(scene.objects.size());
    scene.objects.push_back(std::move(mover));
  }
  return scene;
}

}  // namespace ray
