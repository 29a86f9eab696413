#include "support/any_lanes.h"

#include <raycloud/exec/random.h>
#include <raycloud/spatial/surfel.h>
#include <raycloud/spatial/symmetric_eigen.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <vector>

namespace ray {
namespace {

using Indices = std::vector<std::uint32_t>;

/// Surfels as their header describes them, one by one, all neighbours by brute force.
class SurfelOracle {
 public:
  SurfelOracle(const std::vector<SeenPoint>& points, const SurfelRule& rule) : points_(points), rule_(rule) {}

  [[nodiscard]] Surfel surfel(std::uint32_t i) const {
    const Surfel result = rule_.by_side ? by_side(i) : of(i, nearest(i, rule_.neighbours));
    const Eigen::Vector3d ray = unpack_direction(points_[i].to_sensor);
    if (!rule_.past_rings || !is_ring(result, ray)) return result;
    const Surfel wide = of(i, nearest_of_side(i, wide_count(), ray));
    return is_flat(wide, 0.1) && !is_ring(wide, ray) ? wide : result;
  }

  [[nodiscard]] Indices nearest(std::uint32_t i, std::size_t count) const {
    return nearest_that(i, count, [](std::uint32_t) { return true; });
  }

 private:
  [[nodiscard]] Surfel by_side(std::uint32_t i) const {
    const Indices close = nearest(i, rule_.neighbours);
    const Surfel first = of(i, close);
    const bool behind = !are_seen_from(close, first.normal);
    const auto facing = [&](const Eigen::Vector3d& side) {
      return of(i, nearest_of_side(i, rule_.neighbours, side));
    };
    if (is_flat(first, 0.1)) return behind ? facing(facing(first.normal).normal) : first;
    const PackedDirection& own = points_[i].to_sensor;
    if (std::all_of(close.begin(), close.end(), [&](std::uint32_t j) {
          const PackedDirection& other = points_[j].to_sensor;
          return 1.0 * own[0] * other[0] + 1.0 * own[1] * other[1] + 1.0 * own[2] * other[2] >=
                 0.87 * 32767.0 * 32767.0;
        }))
      return first;
    const Surfel wide = of(i, nearest(i, wide_count()));
    const Eigen::Vector3d side = is_flat(wide, 0.4) ? wide.normal : unpack_direction(own);
    if (!behind && are_seen_from(close, side)) return first;
    const Surfel one = behind ? facing(first.normal) : first, other = facing(side);
    const bool clearly =
        one.is_surface() && (!other.is_surface() || one.variances[0] * other.variances[1] <
                                                        0.25 * other.variances[0] * one.variances[1]);
    return facing((clearly ? one : other).normal);
  }

  [[nodiscard]] std::size_t wide_count() const {
    return std::min(3 * rule_.neighbours, NeighbourSearch::kMost);
  }
  static bool is_flat(const Surfel& surfel, double part) {
    return surfel.variances[0] <= part * surfel.variances[1];
  }
  static bool is_ring(const Surfel& surfel, const Eigen::Vector3d& ray) {
    return surfel.variances[1] < 0.05 * surfel.variances[2] || surfel.normal.dot(ray) < 0.1 * ray.norm();
  }
  [[nodiscard]] bool are_seen_from(const Indices& all, const Eigen::Vector3d& side) const {
    return std::all_of(all.begin(), all.end(),
                       [&](std::uint32_t j) { return is_seen_from(side, points_[j].to_sensor); });
  }

  [[nodiscard]] double distance2(std::uint32_t i, std::uint32_t j) const {
    const Eigen::Vector3d d = points_[j].end - points_[i].end;
    return d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
  }
  template <class Accept>
  [[nodiscard]] Indices nearest_that(std::uint32_t i, std::size_t count, const Accept& accept) const {
    std::vector<std::pair<double, std::uint32_t>> all;
    for (std::uint32_t j = 0; j < points_.size(); ++j)
      if (j != i && accept(j) && distance2(i, j) <= rule_.reach * rule_.reach)
        all.emplace_back(distance2(i, j), j);
    std::sort(all.begin(), all.end());
    all.resize(std::min(all.size(), count));
    Indices result;
    std::transform(all.begin(), all.end(), std::back_inserter(result),
                   [](const auto& one) { return one.second; });
    return result;
  }
  [[nodiscard]] Indices nearest_of_side(std::uint32_t i, std::size_t count,
                                        const Eigen::Vector3d& side) const {
    return nearest_that(i, count, [&](std::uint32_t j) { return is_seen_from(side, points_[j].to_sensor); });
  }

  /// Offsets to a 2^-22nd of the furthest, in whole numbers.
  [[nodiscard]] Surfel of(std::uint32_t i, const Indices& others) const {
    Surfel surfel;
    surfel.count = static_cast<std::uint32_t>(others.size()) + 1;
    surfel.centroid = points_[i].end;
    for (const std::uint32_t j : others)
      surfel.reach2 = std::max(surfel.reach2, distance2(i, j));
    if (surfel.reach2 > 0.0) {
      const double scale = std::ldexp(1.0, 21 - std::ilogb(std::sqrt(surfel.reach2)));
      Eigen::Matrix<std::int64_t, 3, 1> sum = Eigen::Matrix<std::int64_t, 3, 1>::Zero();
      Eigen::Matrix<std::int64_t, 3, 3> products = Eigen::Matrix<std::int64_t, 3, 3>::Zero();
      for (const std::uint32_t j : others) {
        const Eigen::Vector3d offset = (points_[j].end - points_[i].end) * scale;
        const Eigen::Matrix<std::int64_t, 3, 1> whole(std::llrint(offset.x()), std::llrint(offset.y()),
                                                      std::llrint(offset.z()));
        sum += whole;
        products += whole * whole.transpose();
      }
      const double count = surfel.count;
      const Eigen::Vector3d s = sum.cast<double>();
      const double per_count = 1.0 / count, per_mean = per_count / scale;
      surfel.centroid += s * per_mean;
      const Eigen::Matrix3d outer = s * s.transpose();
      const SymmetricEigen eigen =
          symmetric_eigen((products.cast<double>() - outer * per_count) * (per_mean / scale));
      surfel.variances = eigen.values.cwiseMax(0.0);
      surfel.normal = eigen.vectors.col(0);
      surfel.axis = eigen.vectors.col(2);
    }
    const Eigen::Vector3d to_sensor = unpack_direction(points_[i].to_sensor);
    if (!surfel.is_surface() && to_sensor.squaredNorm() > 0.0) surfel.normal = to_sensor.normalized();
    if (surfel.normal.dot(to_sensor) < 0.0) surfel.normal = -surfel.normal;
    return surfel;
  }

  const std::vector<SeenPoint>& points_;
  SurfelRule rule_;
};

bool same_bits(const Surfel& a, const Surfel& b) {
  return a.centroid == b.centroid && a.normal == b.normal && a.axis == b.axis && a.variances == b.variances &&
         a.count == b.count && a.reach2 == b.reach2;
}

/// A noisy wall seen from both sides, a pole before it, points in one place, on a line and anywhere.
std::vector<SeenPoint> many_kinds(std::uint64_t seed, std::size_t count) {
  const RandomStream random(seed, "many kinds");
  const double thickness = 0.2 * random.uniform(0), noise = 0.1 * random.uniform(1);
  std::vector<SeenPoint> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto uniform = [&](std::uint64_t draw) { return 2.0 * random.uniform(i + 2, draw) - 1.0; };
    const double side = uniform(0) < 0.0 ? -1.0 : 1.0, off = noise * (uniform(1) + uniform(2));
    Eigen::Vector3d p(uniform(3), uniform(4), side * thickness / 2.0 + off), to_sensor(0.5, 0.2, side);
    switch (i % 8) {
      case 0:
        p = Eigen::Vector3d(0.05 * std::sin(9.0 * uniform(3)), uniform(4),
                            0.5 + 0.05 * std::cos(9.0 * uniform(3)));
        to_sensor = Eigen::Vector3d(uniform(5), 0.1, 1.0);
        break;
      case 1:
        p = Eigen::Vector3d(uniform(3), uniform(4), uniform(5));
        break;
      case 2:
        if (i > 8) p = points[i - 8].end;
        break;
      case 3:
        p = Eigen::Vector3d(1.0, 1.0, 1.0) * uniform(3);
        break;
      default:
        break;
    }
    if (i % 11 == 0) to_sensor = Eigen::Vector3d(uniform(5), uniform(6), uniform(7));
    points[i] = {p, pack_direction(i % 37 == 0 ? Eigen::Vector3d::Zero() : to_sensor)};
  }
  return points;
}

Indices nearest_of(const PointTree& tree, const Neighbourhood& around, std::size_t most) {
  std::vector<Neighbour> nearest;
  for (Neighbourhood::Some some = around.nearest(around.all(), most); some != 0; some &= some - 1)
    nearest.push_back(around.neighbour(static_cast<std::size_t>(std::countr_zero(some))));
  std::sort(nearest.begin(), nearest.end(), nearer_first(tree));
  Indices result;
  for (const Neighbour& neighbour : nearest)
    result.push_back(tree.index(neighbour.place));
  return result;
}

RC_GTEST_PROP(Surfel, SameBitsAsByBruteForce, (std::uint64_t seed)) {
  const AnyLanes lanes;
  const auto count = *rc::gen::inRange<std::size_t>(1, 400);
  const std::vector<SeenPoint> points = many_kinds(seed, count);
  SurfelRule rule;
  rule.neighbours = *rc::gen::element<std::size_t>(16, 20, 3, 48, 1);
  rule.reach = *rc::gen::element(1e9, 0.4, 0.1);
  rule.by_side = *rc::gen::inRange(0, 4) > 0;
  rule.past_rings = *rc::gen::arbitrary<bool>();
  const SurfelOracle oracle(points, rule);
  const PointTree tree({}, points);
  NeighbourSearch search(tree);
  SurfelFinder finder(search, rule);
  const auto skipped = *rc::gen::inRange<std::size_t>(2, 9);
  std::size_t next = 0;
  finder.for_each(
      0, count, [&](std::size_t place) { return place % skipped != 1; },
      [&](const SurfelOf& found) {
        next += next % skipped == 1 ? 1 : 0;
        RC_ASSERT(found.place == next++);
        RC_ASSERT(same_bits(found.surfel, oracle.surfel(tree.index(found.place))));
        RC_ASSERT(nearest_of(tree, *found.around, rule.neighbours) ==
                  oracle.nearest(tree.index(found.place), rule.neighbours));
      });
  const std::size_t one = seed % count;
  RC_ASSERT(same_bits(surfel_at(search, one, rule), oracle.surfel(tree.index(one))));
}

/// The nearest of some, ties by index, against sorting; sides against is_seen_from.
RC_GTEST_PROP(Neighbourhood, ChoosesAsSortingDoes, (std::uint64_t seed)) {
  const AnyLanes lanes;
  std::vector<SeenPoint> points = many_kinds(seed, 500);
  const double step = *rc::gen::element(0.0, 0.05, 0.5);  // many are as far as others
  for (SeenPoint& point : points)
    if (step > 0.0) point.end = (point.end / step).array().round() * step;
  const PointTree tree({}, points);
  const RandomStream random(seed, "some of the points");
  std::vector<Neighbour> neighbours(*rc::gen::inRange<std::size_t>(0, NeighbourSearch::kMost + 1));
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    const auto place = static_cast<std::uint32_t>(random.uniform(i) * 500.0);
    neighbours[i] = {(tree.point(place) - tree.point(0)).squaredNorm(), place};
  }
  Neighbourhood around;
  around.fill(tree, 0, neighbours);
  const auto some = *rc::gen::arbitrary<Neighbourhood::Some>() & around.all();
  const auto most = *rc::gen::inRange<std::size_t>(0, 70);
  std::vector<Neighbour> expected, found;
  for (std::size_t i = 0; i < neighbours.size(); ++i)
    if ((some >> i & 1U) != 0) expected.push_back(neighbours[i]);
  std::sort(expected.begin(), expected.end(), nearer_first(tree));
  expected.resize(std::min(expected.size(), most));
  const Neighbourhood::Some nearest = around.nearest(some, most);
  RC_ASSERT((nearest & ~some) == 0U);
  for (std::size_t i = 0; i < neighbours.size(); ++i)
    if ((nearest >> i & 1U) != 0) found.push_back(around.neighbour(i));
  std::sort(found.begin(), found.end(), nearer_first(tree));
  RC_ASSERT(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    RC_ASSERT(tree.index(found[i].place) == tree.index(expected[i].place));
  const Eigen::Vector3d side(random.uniform(100) - 0.5, random.uniform(101) - 0.5, random.uniform(102) - 0.5);
  const Neighbourhood::Some facing = around.seen_from(side);
  for (std::size_t i = 0; i < 64; ++i)
    RC_ASSERT((facing >> i & 1U) ==
              (i < neighbours.size() && is_seen_from(side, tree.to_sensor(neighbours[i].place)) ? 1U : 0U));
}

/// By places alone: what the tree says of them.
RC_GTEST_PROP(Neighbourhood, LooksUpPlaces, (std::uint64_t seed)) {
  const AnyLanes lanes;
  const std::vector<SeenPoint> points = many_kinds(seed, 500);
  const PointTree tree({}, points);
  const RandomStream random(seed, "places");
  std::vector<std::uint32_t> places(*rc::gen::inRange<std::size_t>(0, NeighbourSearch::kMost + 1));
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i] = static_cast<std::uint32_t>(random.uniform(i) * 500.0);
  const auto place = *rc::gen::inRange<std::size_t>(0, 500);
  Neighbourhood around, from_neighbours;
  around.fill(tree, place, places);
  std::vector<Neighbour> neighbours;
  double furthest2 = 0.0;
  for (const std::uint32_t other : places) {
    const Eigen::Vector3d offset = tree.point(other) - tree.point(place);
    neighbours.push_back(
        {offset.x() * offset.x() + offset.y() * offset.y() + offset.z() * offset.z(), other});
    furthest2 = std::max(furthest2, neighbours.back().distance2);
  }
  from_neighbours.fill(tree, place, neighbours);
  RC_ASSERT(around.size() == places.size() && around.place() == place);
  RC_ASSERT(around.furthest2() == furthest2 && from_neighbours.furthest2() == furthest2);
  for (std::size_t i = 0; i < places.size(); ++i) {
    RC_ASSERT(around.neighbour(i).place == places[i]);
    RC_ASSERT(around.neighbour(i).distance2 == neighbours[i].distance2);
  }
  const Eigen::Vector3d side(random.uniform(100) - 0.5, random.uniform(101) - 0.5, random.uniform(102) - 0.5);
  Neighbourhood::Some facing = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    facing |= Neighbourhood::Some{is_seen_from(side, tree.to_sensor(places[i]))} << i;
  RC_ASSERT(around.seen_from(side) == facing);
  const Neighbourhood::Moments moments = around.moments(around.all());
  RC_ASSERT(moments.sum == from_neighbours.moments(around.all()).sum);
  std::array<double, 3> sum{};
  for (const std::uint32_t other : places)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<Eigen::Index>(axis);
      sum[axis] += std::nearbyint((tree.point(other)[a] - tree.point(place)[a]) * moments.scale);
    }
  RC_ASSERT(moments.sum == sum);
}

/// A power of two above the furthest, by the library.
RC_GTEST_PROP(Neighbourhood, ScalesByPowersOfTwo, ()) {
  const AnyLanes lanes;
  const auto exponent = *rc::gen::inRange(-535, 511);
  const double away =
      std::ldexp(*rc::gen::element(1.0, 1.5, std::sqrt(2.0), std::nextafter(1.0, 0.0),
                                   std::nextafter(std::sqrt(2.0), 1.0), std::nextafter(1.0, 2.0)),
                 exponent);
  const PointTree tree({}, std::vector<SeenPoint>{{}, {{away, 0.0, 0.0}, {}}});
  Neighbourhood around;
  const std::uint32_t other = 1;
  around.fill(tree, 0, {&other, 1});
  int expected = 0;
  static_cast<void>(std::frexp(std::sqrt(away * away), &expected));
  RC_ASSERT(around.moments(around.all()).scale == std::ldexp(1.0, 22 - expected));
}

/// Both sides of a wall, `thickness` apart, each seen from its own side.
std::vector<SeenPoint> wall(double thickness, double noise, std::size_t count) {
  const RandomStream random(3, "wall");
  std::vector<SeenPoint> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const double off =
        noise * (random.uniform(i, 2) + random.uniform(i, 3) + random.uniform(i, 4) - 1.5) * 2.0;
    points[i].end = {random.uniform(i, 0) * 3.0, random.uniform(i, 1) * 3.0, side * 0.5 * thickness + off};
    points[i].to_sensor = pack_direction(Eigen::Vector3d(1.0, 1.0, side * 3.0));
  }
  return points;
}

TEST(Surfel, EachSideOfAThinWallIsASurfaceOfItsOwn) {
  const std::vector<SeenPoint> points = wall(0.05, 0.002, 10000);
  const PointTree tree({}, points);
  NeighbourSearch search(tree);
  for (std::size_t place = 0; place < tree.size(); ++place) {
    const double side = tree.index(place) % 2 == 0 ? 1.0 : -1.0;
    const Surfel surfel = surfel_at(search, place, {});
    EXPECT_EQ(surfel.count, 17U);
    EXPECT_GT(surfel.normal.z() * side, 0.9);
    EXPECT_NEAR(surfel.centroid.z(), side * 0.025, 0.005);
    EXPECT_LT(std::sqrt(surfel.variances[0]), 0.006);
  }
}

/// What the outcome of a block may depend on: its points, not how many others there are out of reach, nor
/// threads.
TEST(Surfel, SameBitsWhateverTheTree) {
  const std::vector<SeenPoint> points = wall(0.05, 0.02, 30000);
  std::vector<SeenPoint> more = points;
  for (const SeenPoint& point : points)
    more.push_back({point.end + Eigen::Vector3d(50.0, 0.0, 0.0), point.to_sensor});
  const auto surfels = [](const std::vector<SeenPoint>& all, unsigned threads) {
    const PointTree tree({.threads = threads}, all);
    NeighbourSearch search(tree);
    std::vector<Surfel> result(all.size());
    SurfelFinder(search, {.reach = 10.0}).for_each(0, tree.size(), [&](const SurfelOf& found) {
      result[tree.index(found.place)] = found.surfel;
    });
    return result;
  };
  const std::vector<Surfel> expected = surfels(points, 1);
  for (const std::vector<Surfel>& other : {surfels(points, 3), surfels(more, 2)}) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(other[i].normal, expected[i].normal);
      ASSERT_EQ(other[i].centroid, expected[i].centroid);
      ASSERT_EQ(other[i].variances, expected[i].variances);
    }
  }
}

/// The rings that the beams of a spinning lidar draw on the ground, 40 cm apart, are sheets along the rays by
/// the noise of their ranges.
TEST(Surfel, LooksPastTheRingsOfASpinningLidar) {
  const Eigen::Vector3d sensor(0.0, 0.0, 2.0);
  const RandomStream random(5, "rings");
  std::vector<SeenPoint> points;
  for (int ring = 0; ring < 12; ++ring)
    for (int step = 0; step < 1500; ++step) {
      const double angle = (step + 0.01 * ring) * 2.0 * std::numbers::pi / 1500.0, radius = 8.0 + 0.4 * ring;
      const Eigen::Vector3d ground(radius * std::cos(angle), radius * std::sin(angle), 0.0);
      const Eigen::Vector3d ray = (ground - sensor).normalized();
      // Even, ±5 cm.
      const Eigen::Vector3d end = ground + 0.1 * (random.uniform(points.size()) - 0.5) * ray;
      points.push_back({end, pack_direction(sensor - end)});
    }
  const PointTree tree({}, points);
  NeighbourSearch search(tree);
  const auto upright = [&](bool past_rings) {
    std::size_t count = 0;
    SurfelFinder(search, {.past_rings = past_rings}).for_each(0, tree.size(), [&](const SurfelOf& found) {
      count += found.surfel.normal.z() > 0.99 ? 1 : 0;
    });
    return static_cast<double>(count) / static_cast<double>(tree.size());
  };
  EXPECT_LT(upright(false), 0.5);
  EXPECT_GT(upright(true), 0.95);
}

TEST(Surfel, ShapesOfALineAPlaneAndABall) {
  EXPECT_NEAR(shape_of({.variances = {0.0, 0.0, 1.0}}).cylindricality, 1.0, 1e-12);
  EXPECT_NEAR(shape_of({.variances = {0.0, 1.0, 1.0}}).planarity, 1.0, 1e-12);
  EXPECT_NEAR(shape_of({.variances = {1.0, 1.0, 1.0}}).sphericity, 1.0, 1e-12);
}

}  // namespace
}  // namespace ray
