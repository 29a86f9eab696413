#include "support/any_lanes.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/exec/random.h>
#include <raycloud/spatial/neighbour_search.h>
#include <raycloud/spatial/symmetric_eigen.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <tuple>

namespace ray {
namespace {

enum class Arrangement { uniform, clustered, collinear, coplanar, duplicate, identical, grid, with_outlier };
constexpr std::array kArrangements{Arrangement::uniform,  Arrangement::clustered,   Arrangement::collinear,
                                   Arrangement::coplanar, Arrangement::duplicate,   Arrangement::identical,
                                   Arrangement::grid,     Arrangement::with_outlier};

std::vector<SeenPoint> arranged(Arrangement arrangement, std::size_t count, std::uint64_t seed,
                                const Eigen::Vector3d& origin = Eigen::Vector3d::Zero()) {
  const RandomStream random(seed, "arranged points");
  std::vector<SeenPoint> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto uniform = [&](std::uint64_t draw) { return 2.0 * random.uniform(i, draw) - 1.0; };
    Eigen::Vector3d p(uniform(0), uniform(1), uniform(2));
    if (arrangement == Arrangement::clustered) p = p.array().cube() * p.array().square();
    if (arrangement == Arrangement::collinear) p = {p.x(), 2.0 * p.x(), -p.x()};
    if (arrangement == Arrangement::coplanar) p.z() = 0.5;
    if (arrangement == Arrangement::duplicate && i % 3 != 0) p = points[i / 3 * 3].end - origin;
    if (arrangement == Arrangement::identical) p = {1.0, 2.0, 3.0};
    if (arrangement == Arrangement::grid) p = (p * 10.0).array().round() / 10.0;
    if (arrangement == Arrangement::with_outlier && i == count / 2) p = {1e7, 0.0, 0.0};
    points[i].end = origin + p;
    points[i].to_sensor = pack_direction({uniform(3), uniform(4), uniform(5)});
  }
  return points;
}

using Found = std::vector<std::pair<double, std::uint32_t>>;  // squared distance, index

template <class Accept>
Found brute_force(const std::vector<SeenPoint>& points, std::size_t i, std::size_t count, double reach,
                  const Accept& accept) {
  Found all;
  for (std::size_t j = 0; j < points.size(); ++j) {
    const Eigen::Vector3d d = points[j].end - points[i].end;
    const double distance2 = d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
    if (j != i && distance2 <= reach * reach && accept(j))
      all.emplace_back(distance2, static_cast<std::uint32_t>(j));
  }
  const auto kept = static_cast<std::ptrdiff_t>(std::min(count, all.size()));
  std::partial_sort(all.begin(), all.begin() + kept, all.end());
  all.resize(static_cast<std::size_t>(kept));
  return all;
}

Found sorted(const PointTree& tree, std::span<const Neighbour> neighbours) {
  Found found;
  for (const Neighbour& neighbour : neighbours)
    found.emplace_back(neighbour.distance2, tree.index(neighbour.place));
  std::sort(found.begin(), found.end());
  return found;
}

/// Around points of the tree or anywhere, as wide as a leaf or as all, and flat.
RC_GTEST_PROP(PointTree, InsideABodyAreThoseOfBruteForce, (std::uint64_t seed)) {
  const AnyLanes lanes;
  const auto arrangement = kArrangements[*rc::gen::inRange<std::size_t>(0, kArrangements.size())];
  const auto count = *rc::gen::inRange<std::size_t>(1, 600);
  const Eigen::Vector3d origin =
      *rc::gen::element(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(5e5, 6.9e6, 100.0));
  const std::vector<SeenPoint> points = arranged(arrangement, count, seed, origin);
  const PointTree tree({}, points);
  NeighbourSearch search(tree);
  const RandomStream random(seed, "bodies");
  for (std::size_t place = 0; place < count; ++place) {
    const auto uniform = [&](std::uint64_t draw) { return 2.0 * random.uniform(place, draw) - 1.0; };
    if (place % 2 == 0) std::ignore = search.nearest(place, 16, 1e9);
    const double size = std::pow(10.0, -1.5 + uniform(0)), flat = place % 3 == 0 ? 0.01 : 0.7;
    const Eigen::Vector3d across = Eigen::Vector3d(uniform(1), uniform(2), uniform(3)).normalized();
    const Eigen::Matrix3d along = across * across.transpose();
    SearchedBody body;
    body.centre = tree.point(place) + 0.5 * size * Eigen::Vector3d(uniform(4), uniform(5), uniform(6));
    body.shape = (along / (flat * flat) + Eigen::Matrix3d::Identity() - along) / (size * size);
    body.shape = body.shape.cast<float>().cast<double>().eval();
    const auto is_inside = [&](std::uint32_t at) {
      const Eigen::Vector3d offset = tree.point(at) - body.centre;
      return offset.dot(body.shape * offset) <= 1.0;
    };
    const PlacesInside inside = search.inside(place, body);
    std::vector<std::uint32_t> found(inside.surely.begin(), inside.surely.end()), expected;
    RC_ASSERT(std::all_of(found.begin(), found.end(), is_inside));
    std::copy_if(inside.perhaps.begin(), inside.perhaps.end(), std::back_inserter(found), is_inside);
    std::sort(found.begin(), found.end());
    for (std::uint32_t other = 0; other < count; ++other)
      if (is_inside(other)) expected.push_back(other);
    RC_ASSERT(found == expected);
  }
}

RC_GTEST_PROP(PointTree, NeighboursAreThoseOfBruteForce, ()) {
  const AnyLanes lanes;
  const auto arrangement = kArrangements[*rc::gen::inRange<std::size_t>(0, kArrangements.size())];
  const auto count = *rc::gen::inRange<std::size_t>(1, 400);
  const auto wanted = *rc::gen::inRange<std::size_t>(0, 40);
  const double reach = *rc::gen::element(1e9, 0.3, 0.05);
  const Eigen::Vector3d origin =
      *rc::gen::element(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(5e5, 6.9e6, 100.0));
  const std::vector<SeenPoint> points =
      arranged(arrangement, count, *rc::gen::arbitrary<std::uint64_t>(), origin);
  const PointTree tree({}, points);
  RC_ASSERT(tree.size() == count);
  NeighbourSearch search(tree);
  const Eigen::Vector3d normal(0.3, -0.5, 0.8);
  std::vector<std::uint8_t> seen(count);
  for (std::size_t place = 0; place < count; ++place) {
    const std::uint32_t i = tree.index(place);
    seen[i] = 1;
    RC_ASSERT(tree.point(place) == points[i].end);
    RC_ASSERT(tree.to_sensor(place) == points[i].to_sensor);
    RC_ASSERT(sorted(tree, search.nearest(place, wanted, reach)) ==
              brute_force(points, i, wanted, reach, [](std::size_t) { return true; }));
    RC_ASSERT(sorted(tree, search.nearest_facing(place, wanted, reach, normal)) ==
              brute_force(points, i, wanted, reach, [&](std::size_t j) {
                const PackedDirection& d = points[j].to_sensor;
                return normal.x() * d[0] + normal.y() * d[1] + normal.z() * d[2] >= 0.0;
              }));
  }
  RC_ASSERT(std::count(seen.begin(), seen.end(), 1) == static_cast<std::ptrdiff_t>(count));
}

/// Whatever was asked for before, of the same place or of others.
RC_GTEST_PROP(PointTree, NeighboursAreThoseOfBruteForceInAnyOrderOfAsking, ()) {
  const AnyLanes lanes;
  const auto arrangement = kArrangements[*rc::gen::inRange<std::size_t>(0, kArrangements.size())];
  const std::vector<SeenPoint> points = arranged(arrangement, 300, *rc::gen::arbitrary<std::uint64_t>());
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "asking");
  const PointTree tree({}, points);
  NeighbourSearch search(tree);
  const auto most = static_cast<double>(*rc::gen::inRange(0, 10));
  const Eigen::Vector3d side(-0.2, 0.4, 0.9);
  for (std::size_t place = 0; place < tree.size(); ++place) {
    const auto expect = [&](std::size_t count, double reach) {
      const auto any = [](std::size_t) { return true; };
      RC_ASSERT(sorted(tree, search.nearest(place, count, reach)) ==
                brute_force(points, tree.index(place), count, reach, any));
    };
    expect(16, 0.3);
    if (random.uniform(place, 0) < 0.1) search.nearest_facing(place, 16, 0.3, side);
    // Mostly there is more to be asked, so that it will be expected.
    if (10.0 * random.uniform(place, 1) < most) expect(48, 0.3);
    if (random.uniform(place, 2) < 0.1) expect(20, 0.4);
    if (random.uniform(place, 3) < 0.1) expect(60, 0.3);
    if (random.uniform(place, 4) < 0.1) expect(3, 0.3);
  }
}

/// Fewer than wanted or more, by what lies around a leaf or by walking; single precision tells them or not.
RC_GTEST_PROP(PointTree, PlacesFacingASideAreThoseOfBruteForce, ()) {
  const AnyLanes lanes;
  const auto arrangement = kArrangements[*rc::gen::inRange<std::size_t>(0, kArrangements.size())];
  const auto wanted = *rc::gen::element<std::size_t>(1, 5, 16, 63);
  const double reach = *rc::gen::element(1e9, 1.0, 0.3, 0.1, 0.05);
  const bool looks_around = *rc::gen::arbitrary<bool>();
  const std::vector<SeenPoint> points = arranged(arrangement, 400, *rc::gen::arbitrary<std::uint64_t>());
  const PointTree tree({}, points);
  NeighbourSearch search(tree);
  const Eigen::Vector3d side(0.3, -0.5, 0.8);
  for (std::size_t place = 0; place < tree.size(); ++place) {
    if (looks_around && place == search.leaf_of(place).begin) search.look_around(place, reach);
    std::vector<std::uint32_t> found, expected;
    for (const std::uint32_t other : search.places_facing(place, wanted, reach, side))
      found.push_back(tree.index(other));
    const Found nearest = brute_force(points, tree.index(place), wanted, reach, [&](std::size_t j) {
      const PackedDirection& d = points[j].to_sensor;
      return side.x() * d[0] + side.y() * d[1] + side.z() * d[2] >= 0.0;
    });
    for (const auto& [distance2, index] : nearest)
      expected.push_back(index);
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    RC_ASSERT(found == expected);
  }
}

/// Large enough for several buckets; queries in any order.
TEST(PointTree, NeighboursOfManyPointsAreThoseOfBruteForce) {
  for (const Arrangement arrangement : kArrangements) {
    const std::vector<SeenPoint> points = arranged(arrangement, 40000, 7);
    const PointTree tree({.threads = 3}, points);
    NeighbourSearch search(tree);
    for (std::size_t i = 0; i < 30; ++i) {
      const std::size_t place = i * 7919 % tree.size();
      EXPECT_EQ(sorted(tree, search.nearest(place, 16, 1e9)),
                brute_force(points, tree.index(place), 16, 1e9, [](std::size_t) { return true; }));
    }
  }
}

/// Ties by index must not make each of many equal points look at all others.
TEST(PointTree, ManyIdenticalPointsTakeNoMoreTimeThanOthers) {
  const std::vector<SeenPoint> points = arranged(Arrangement::identical, 60000, 1);
  const PointTree tree({}, points);
  NeighbourSearch search(tree);
  for (std::size_t place = 0; place < tree.size(); ++place)
    ASSERT_EQ(search.nearest(place, 16, 1.0).size(), 16U);
}

TEST(PointTree, NoPoints) {
  EXPECT_EQ(PointTree({}, {}).size(), 0U);
}

RC_GTEST_PROP(SymmetricEigen, AgreesWithIteration, ()) {
  const auto element = [] {
    return static_cast<double>(*rc::gen::inRange(-1000, 1000)) * *rc::gen::element(1.0, 1e-3, 1e-7, 0.0);
  };
  Eigen::Matrix3d m;
  for (Eigen::Index i = 0; i < 9; ++i)
    m(i) = element();
  m = (m * m.transpose() * *rc::gen::element(1.0, 1e-9, 1e12)).eval();
  const SymmetricEigen got = symmetric_eigen(m);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> expected(m);
  const double largest = expected.eigenvalues().cwiseAbs().maxCoeff();
  RC_ASSERT((got.values - expected.eigenvalues()).cwiseAbs().maxCoeff() <= 1e-7 * largest);
  RC_ASSERT((got.vectors.transpose() * got.vectors - Eigen::Matrix3d::Identity()).norm() < 1e-9);
  RC_ASSERT((got.vectors * got.values.asDiagonal() * got.vectors.transpose() - m).norm() <= 1e-7 * largest);
}

}  // namespace
}  // namespace ray
