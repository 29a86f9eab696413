#include "ellipsoid_blocks.h"

#include "cloud_ellipsoids.h"

#include <raycloud/exec/parallel.h>

#include <Eigen/LU>
#include <algorithm>
#include <mutex>

namespace ray {
namespace {

constexpr std::size_t kMostParts = 1024;
constexpr std::size_t kPointsAtOnce = 4096;

/// Ellipsoids in one cell that follow each other: in the order of a tree of points these are several.
struct CellRun {
  RegionCells::Key key{};
  float semi_axis = 0.0F;
  std::vector<std::uint32_t> ellipsoids;
};

void add_to_runs(std::vector<CellRun>& runs, const Ellipsoid& ellipsoid, std::uint32_t number) {
  const float semi_axis = RegionCells::semi_axis_within(ellipsoid);
  const RegionCells::Key key = RegionCells::key_of(ellipsoid.centre, semi_axis);
  if (runs.empty() || runs.back().key != key) runs.push_back({key, 0.0F, {}});
  runs.back().semi_axis = std::max(runs.back().semi_axis, semi_axis);
  runs.back().ellipsoids.push_back(number);
}

std::size_t parts_for(const Context& context, const ReadEnds& ends, std::size_t bytes_per_point) {
  // What lies around a block takes room too.
  return std::min(2 * (ends.sample.bounded * bytes_per_point / memory_budget(context) + 1), kMostParts);
}

}  // namespace

Eigen::AlignedBox3d box_of(const Ellipsoid& ellipsoid) {
  constexpr double kRounded = 1e-9, kLeast = 1e-6;  // of the distance to the origin; m
  const Eigen::Array3d reach =
      ellipsoid.shape.inverse().diagonal().cwiseMax(0.0).cwiseSqrt().array() * (1.0 + kLeast) + kLeast +
      kRounded * ellipsoid.centre.array().abs();
  return {Eigen::Vector3d(ellipsoid.centre.array() - reach),
          Eigen::Vector3d(ellipsoid.centre.array() + reach)};
}

EllipsoidBlocks::EllipsoidBlocks(const Context& context, RaySource& source, const ReadEnds& ends,
                                 std::size_t bytes_per_point)
    : cuts_(ends.sample.ends, parts_for(context, ends, bytes_per_point)),
      ellipsoids_(cuts_.parts(), memory_budget(context) / 64),
      cell_numbers_(cuts_.parts(), memory_budget(context) / 64),
      boxes_(cuts_.parts()) {
  blocks::SpilledRecords<SeenPoint> near(cuts_, ends.reach, memory_budget(context));
  stream(
      context, source, nullptr,
      [&](const RayCloud& rays) { return near.sort(rays, blocks::extract_all<SeenPoint>(rays, seen_end)); },
      [&](const RayCloud&, const blocks::Copies<SeenPoint>& copies) { near.add(copies); });
  source.rewind();
  RangeNoise noise(ends.sample.bounded, ends.reach);
  near.visit(context, [&](Block<SeenPoint>&& block, std::size_t) { noise.add(context, block); });
  range_noise_ = noise.value();
  near.visit_and_drop(context, [&](Block<SeenPoint>&& block, std::size_t part) {
    make(context, std::move(block), part, ends.reach);
  });
  cells_.close(context);
}

void EllipsoidBlocks::make(const Context& context, Block<SeenPoint>&& block, std::size_t part, double reach) {
  const PointTree points(context, block.records);
  block.records = std::vector<SeenPoint>();
  std::vector<std::uint32_t> place_of_own(block.own.size());
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < block.own.size(); ++i) {
    place_of_own[i] = count;
    count += block.own[i];
  }
  std::vector<PackedEllipsoid> ellipsoids(count);
  std::vector<std::vector<CellRun>> runs((points.size() + kPointsAtOnce - 1) / kPointsAtOnce);
  std::mutex mutex;
  parallel_for(context, points.size(), kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
    NeighbourSearch search(points);
    Eigen::AlignedBox3d box;
    std::vector<CellRun>& of_range = runs[begin / kPointsAtOnce];
    const auto is_own = [&](std::size_t place) { return block.own[points.index(place)] != 0; };
    for_each_ellipsoid(search, begin, end, reach, range_noise_, is_own,
                       [&](std::size_t place, const Ellipsoid& ellipsoid) {
                         const std::uint32_t own = place_of_own[points.index(place)];
                         ellipsoids[own] = packed(ellipsoid);
                         box.extend(box_of(ellipsoid));
                         add_to_runs(of_range, ellipsoid, own);
                       });
    const std::lock_guard lock(mutex);
    boxes_[part].extend(box);
  });
  std::vector<std::uint32_t> cells(count);
  for (const std::vector<CellRun>& of_range : runs)
    for (const CellRun& run : of_range) {
      const std::uint32_t cell =
          cells_.add(run.key, run.semi_axis, static_cast<std::uint32_t>(run.ellipsoids.size()));
      for (const std::uint32_t ellipsoid : run.ellipsoids)
        cells[ellipsoid] = cell;
    }
  ellipsoids_.append(part, ellipsoids);
  cell_numbers_.append(part, cells);
}

std::unique_ptr<EllipsoidTree> EllipsoidBlocks::tree(const Context& context, std::size_t part) {
  const std::vector<PackedEllipsoid> ellipsoids = load(part);
  return tree_of(context, ellipsoids.size(),
                 [&](std::size_t i) -> const PackedEllipsoid& { return ellipsoids[i]; });
}

std::unique_ptr<EllipsoidTree> tree_of(const Context& context, std::size_t count,
                                       const std::function<const PackedEllipsoid&(std::size_t)>& ellipsoid) {
  auto tree =
      std::make_unique<EllipsoidTree>(context, count, [&](std::size_t i) { return centre_of(ellipsoid(i)); });
  parallel_for(context, count, 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      tree->set(i, unpacked(ellipsoid(i)));
  });
  tree->close(context);
  return tree;
}

}  // namespace ray
