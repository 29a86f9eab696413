#include "far_from_others.h"
#include "outside_neighbours.h"
#include "range_edges.h"
#include "require.h"
#include "without_noise.h"

#include <raycloud/exec/blocks.h>
#include <raycloud/filter/denoise.h>

#include <array>
#include <cmath>
#include <numeric>
#include <optional>

namespace ray {
namespace {

/// Writes all rays but the bounded ones that are noise.
StreamCounts write_rest(const Context& context, RaySource& source, RaySink& sink,
                        const std::vector<std::uint8_t>& noise) {
  source.rewind();
  std::size_t seen = 0;  // bounded rays
  return stream(
      context, source, &sink, [](const RayCloud&) { return Nothing{}; },
      [&](const RayCloud& rays, Nothing&) {
        std::vector<std::uint8_t> mask(rays.size(), 1);
        for (std::size_t i = 0; i < rays.size(); ++i)
          if (rays.bounded[i] != 0) mask[i] = noise[seen++] == 0 ? 1 : 0;
        return mask;
      });
}

/// Calls `add(rays, i)` for each bounded ray, in order.
template <class Add>
void each_bounded(const Context& context, RaySource& source, const Add& add) {
  static_cast<void>(stream(
      context, source, nullptr, [](const RayCloud&) { return Nothing{}; },
      [&](const RayCloud& rays, Nothing&) {
        for (std::size_t i = 0; i < rays.size(); ++i)
          if (rays.bounded[i] != 0) add(rays, i);
      }));
}

Denoised far_ends(const Context& context, RaySource& source, RaySink& sink, const FarFromOthers& rule) {
  const BlockNeeds needs{.bytes_per_record = 38,
                         .reach = [&](const EndSample&) { return rule.distance.value; }};
  const auto extract = [](const RayCloud& rays, std::size_t i) { return rays.ends[i]; };
  const auto compute = [&](const Context& with, Block<Eigen::Vector3d>&& block, double) {
    return far_from_others(with, block.records, rule.distance.value, rule.min_neighbours);
  };
  return {.counts = run_blocks<Eigen::Vector3d, std::uint8_t>(context, source, sink, needs, extract, compute,
                                                              without_noise)};
}

/// The extra column that tells the lasers of the sensor apart, if there is one.
std::optional<std::size_t> ring_column(const CloudInfo& info) {
  for (const char* name : {"ring", "laser", "laser_id", "channel"})
    for (std::size_t c = 0; c < info.extras.size(); ++c)
      if (info.extras[c].name == name && info.extras[c].type != ScalarType::float32 &&
          info.extras[c].type != ScalarType::float64)
        return c;
  return {};
}

/// The values in the given order.
template <class T>
void reorder(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  std::vector<T> ordered(values.size());
  for (std::size_t i = 0; i < order.size() && !values.empty(); ++i)
    ordered[i] = values[order[i]];
  values = std::move(ordered);
}

Denoised range_edge_ends(const Context& context, RaySource& source, RaySink& sink, const OnRangeEdges& rule) {
  const std::optional<std::size_t> ring = ring_column(source.info());
  Beams beams;
  std::vector<double> times;
  each_bounded(context, source, [&](const RayCloud& rays, std::size_t i) {
    beams.starts.push_back(rays.starts[i]);
    beams.ends.push_back(rays.ends[i]);
    times.push_back(rays.times[i]);
    if (ring) beams.rings.push_back(static_cast<std::uint32_t>(rays.extras[*ring].as_double(i)));
  });
  if (beams.size() >= ScanLines::kNone)
    throw Error(ErrorCode::out_of_range, "more than 4 294 967 294 points");
  // Whatever the order in the file, time is the order in which the sensor turned.
  std::vector<std::uint32_t> order;
  if (!std::is_sorted(times.begin(), times.end())) {
    order.resize(times.size());
    std::iota(order.begin(), order.end(), 0);
    parallel_sort(context, order.begin(), order.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return times[a] < times[b]; });
    reorder(beams.starts, order);
    reorder(beams.ends, order);
    reorder(beams.rings, order);
  }
  times = std::vector<double>();
  RangeEdges edges = range_edges(context, beams, rule.distance.value);
  beams = {};
  std::vector<std::uint8_t> noise(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    noise[order[i]] = edges.mixed[i];
  return {write_rest(context, source, sink, order.empty() ? edges.mixed : noise), edges.in_scan_order};
}

}  // namespace

Denoised remove_noise(const Context& context, RaySource& source, RaySink& sink, const Noise& noise) {
  const auto above_zero = [](double value) { return value > 0.0 && std::isfinite(value); };
  if (const auto* far = std::get_if<FarFromOthers>(&noise)) {
    require(above_zero(far->distance.value), "the distance must be above 0");
    return far_ends(context, source, sink, *far);
  }
  if (const auto* edges = std::get_if<OnRangeEdges>(&noise)) {
    require(above_zero(edges->distance.value), "the distance must be above 0");
    return range_edge_ends(context, source, sink, *edges);
  }
  const double sigmas = std::get<OutsideNeighbours>(noise).sigmas;
  require(above_zero(sigmas), "the number of standard deviations must be above 0");
  return outside_neighbours(context, source, sink, sigmas);
}

}  // namespace ray
