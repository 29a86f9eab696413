#include "support/random_cloud.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/filter/denoise.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ray {
namespace {

using test::same_bits;

struct Truth {
  RayCloud cloud;
  std::vector<std::uint8_t> mixed;
};

/// A room with walls 8 m to the sides and 2 m below and above, and in it a box and a thin pole.
double cast(const Eigen::Vector3d& from, const Eigen::Vector3d& way) {
  double range = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    const double wall = axis == 2 ? 2.0 : 8.0;
    const double t = ((way[axis] > 0.0 ? wall : -wall) - from[axis]) / way[axis];
    if (t > 0.0) range = std::min(range, t);
  }
  const Eigen::Vector3d low(3.0, -1.0, -1.5), high(4.0, 1.5, 1.0);
  const Eigen::Vector3d a = (low - from).cwiseQuotient(way), b = (high - from).cwiseQuotient(way);
  const double enter = a.cwiseMin(b).maxCoeff(), leave = a.cwiseMax(b).minCoeff();
  if (enter > 0.0 && enter <= leave) range = std::min(range, enter);
  // The pole: 6 cm thick, 3 m to the left.
  const double along = 3.0 / way.y() * (way.y() > 0.0 ? 1.0 : -1.0);
  if (way.y() > 0.0 && std::abs(from.x() + along * way.x()) < 0.03) range = std::min(range, along);
  return range;
}

struct Scan {
  std::size_t beams = 80000;
  std::size_t rings = 1;
  double step = 0.2037;   // degrees
  double tilt = 0.0;      // of the axis, degrees
  double speed = 0.0;     // m/s
  bool vertical = false;  // the single beam turns about a horizontal axis
};

/// Beams are 0.1 degrees wide; those that meet two surfaces end at a random mix of both ranges.
Truth scanned(const Scan& scan, std::uint64_t seed) {
  const RandomStream random(seed, "scan");
  Truth truth;
  const double degree = std::numbers::pi / 180.0;
  const std::size_t columns = scan.beams / scan.rings;
  truth.cloud.set_schema({{"ring", ScalarType::uint16}});
  truth.cloud.resize(columns * scan.rings);
  truth.mixed.resize(columns * scan.rings);
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(scan.tilt * degree, Eigen::Vector3d::UnitY()).matrix();
  for (std::size_t i = 0; i < truth.mixed.size(); ++i) {
    const std::size_t ring = i % scan.rings;
    const double azimuth = static_cast<double>(i / scan.rings) * scan.step * degree;
    const double elevation = scan.rings == 1 ? 0.01 : (-15.0 + 2.0 * static_cast<double>(ring)) * degree;
    const auto way = [&](double turn, double up) -> Eigen::Vector3d {
      const double a = azimuth + turn, e = elevation + up;
      const Eigen::Vector3d flat(std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e));
      return tilt * (scan.vertical ? Eigen::Vector3d(flat.x(), flat.z(), flat.y()) : flat);
    };
    const double time = static_cast<double>(i) * 1e-5;
    const Eigen::Vector3d start(scan.speed * time, 0.1, 0.2);
    double range = cast(start, way(0, 0));
    const double half = 0.05 * degree;
    for (const auto& [turn, up] : {std::pair(half, 0.0), {-half, 0.0}, {0.0, half}, {0.0, -half}}) {
      const double other = cast(start, way(turn, up));
      if (std::abs(other - range) < 0.3 || truth.mixed[i] != 0) continue;
      range += random.uniform(i, 5) * (other - range);
      truth.mixed[i] = 1;
    }
    const double uniform = std::max(random.uniform(i, 0), 1e-12);
    range +=
        0.01 * std::sqrt(-2.0 * std::log(uniform)) * std::cos(2.0 * std::numbers::pi * random.uniform(i, 1));
    truth.cloud.starts[i] = start;
    truth.cloud.ends[i] = start + range * way(0, 0);
    truth.cloud.times[i] = time;
    truth.cloud.bounded[i] = 1;
    truth.cloud.colours[i].intensity = truth.mixed[i] != 0 ? 100 : 200;
    truth.cloud.extras[0].values<std::uint16_t>()[i] = static_cast<std::uint16_t>(ring);
  }
  return truth;
}

struct Score {
  double recall = 0.0;  ///< part of the mixed ends that went
  double lost = 0.0;    ///< part of the good ends that went
  bool in_scan_order = false;
  RayCloud rest;
};

Score judged(const RayCloud& cloud, unsigned threads = 2, std::size_t chunk = 1000) {
  MemorySource source(cloud, chunk);
  MemorySink sink(source.info().extras);
  const Denoised done = remove_noise(Context{.threads = threads}, source, sink, OnRangeEdges{{0.04}});
  Score score{.in_scan_order = done.in_scan_order, .rest = sink.cloud()};
  const auto count = [](const RayCloud& rays, std::uint8_t intensity) {
    double number = 0.0;
    for (const Colour& colour : rays.colours)
      if (colour.intensity == intensity) ++number;
    return number;
  };
  score.recall = 1.0 - count(score.rest, 100) / count(cloud, 100);
  score.lost = 1.0 - count(score.rest, 200) / count(cloud, 200);
  return score;
}

RayCloud without_rings(RayCloud cloud) {
  cloud.set_schema({});
  return cloud;
}

RayCloud shuffled(const RayCloud& cloud) {
  std::vector<std::uint32_t> rows(cloud.size());
  for (std::uint32_t i = 0; i < rows.size(); ++i)
    rows[i] = i;
  for (std::size_t i = rows.size(); i > 1; --i)
    std::swap(rows[i - 1], rows[RandomStream(1, "shuffle").below(i, i)]);
  RayCloud other;
  other.set_schema(schema_of(cloud));
  other.assign_rows(cloud, rows);
  return other;
}

TEST(OnRangeEdges, FindsMixedPixelsOfEverySensor) {
  for (const Scan& scan : {Scan{}, Scan{.tilt = 20.0}, Scan{.step = 0.1019, .speed = 1.0},
                           Scan{.vertical = true}, Scan{.rings = 16}, Scan{.rings = 16, .tilt = 30.0},
                           Scan{.rings = 16, .step = 0.4019, .speed = 2.0}}) {
    const Truth truth = scanned(scan, 1);
    for (const RayCloud& cloud : {truth.cloud, without_rings(truth.cloud), shuffled(truth.cloud)}) {
      const Score score = judged(cloud);
      EXPECT_TRUE(score.in_scan_order);
      EXPECT_GE(score.recall, 0.8) << scan.rings << " rings, tilt " << scan.tilt;
      EXPECT_LE(score.lost, 0.006) << scan.rings << " rings, tilt " << scan.tilt;
    }
  }
}

TEST(OnRangeEdges, WhereRaysThatHitNothingAreMissing) {
  const Truth truth = scanned({.rings = 16}, 2);
  std::vector<std::uint8_t> mask(truth.cloud.size());
  for (std::size_t i = 0; i < mask.size(); ++i)
    mask[i] = RandomStream(1, "missing").below(10, i) != 0 ? 1 : 0;
  RayCloud cloud = without_rings(truth.cloud);
  cloud.select(mask);
  const Score score = judged(cloud);
  EXPECT_GE(score.recall, 0.7);
  EXPECT_LE(score.lost, 0.006);
}

TEST(OnRangeEdges, WithoutOrderNeighboursInSpaceDo) {
  RayCloud cloud = shuffled(scanned({.rings = 16}, 3).cloud);
  std::fill(cloud.times.begin(), cloud.times.end(), 0.0);
  const Score score = judged(cloud);
  EXPECT_FALSE(score.in_scan_order);
  EXPECT_LE(score.lost, 0.006);
}

TEST(OnRangeEdges, WithoutOrderFromAMovingSensorToo) {
  RayCloud cloud = shuffled(scanned({.rings = 16, .step = 0.4019, .speed = 2.0}, 6).cloud);
  std::fill(cloud.times.begin(), cloud.times.end(), 0.0);
  const Score score = judged(cloud);
  EXPECT_FALSE(score.in_scan_order);
  EXPECT_LE(score.lost, 0.006);
}

TEST(OnRangeEdges, ThePoleStays) {
  const Truth truth = scanned({.rings = 16, .step = 0.3019}, 4);
  const RayCloud rest = judged(truth.cloud).rest;
  const auto on_pole = [](const RayCloud& rays) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (rays.colours[i].intensity == 200 && std::abs(rays.ends[i].x()) < 0.1 && rays.ends[i].y() > 2.9 &&
          rays.ends[i].y() < 3.3)
        ++count;
    return count;
  };
  EXPECT_GT(on_pole(truth.cloud), 40U);
  EXPECT_EQ(on_pole(rest), on_pole(truth.cloud));
}

TEST(OnRangeEdges, SameWhateverTheThreadsAndChunks) {
  const RayCloud cloud = scanned({.beams = 8000, .rings = 16, .step = 1.019}, 5).cloud;
  const RayCloud expected = judged(cloud, 1, 1000000).rest;
  for (const unsigned threads : {1U, 2U, 3U, 8U})
    for (const std::size_t chunk : {7UL, 1000UL})
      EXPECT_TRUE(same_bits(judged(cloud, threads, chunk).rest, expected));
}

}  // namespace
}  // namespace ray
