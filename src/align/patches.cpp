#include "patches.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/spatial/symmetric_eigen.h>

#include <algorithm>
#include <span>

namespace ray::align {
namespace {

constexpr std::uint64_t kAxisMask = (1 << 20) - 1;

/// A low quantile, since corners and what is rough are thicker than noise makes a surface.
double noise_of(const std::vector<Patch>& patches) {
  constexpr double kQuantile = 0.3;
  std::vector<double> variances;
  for (const Patch& patch : patches)
    if (patch.is_flat() && patch.count >= 10.0) variances.push_back(patch.variances[0]);
  if (variances.empty()) return 0.0;
  const auto at =
      variances.begin() + static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(variances.size() - 1));
  std::nth_element(variances.begin(), at, variances.end());
  return *at;
}

/// The key of the wider cube in which a cube lies: coordinates count from -2^19, so that cubes of all widths
/// have a corner at the origin.
std::uint64_t wider(std::uint64_t key, int shift) {
  const auto axis = [&](int at) {
    const auto half = std::int64_t{1} << 19;
    const auto number = static_cast<std::int64_t>(key >> at & kAxisMask) - half;
    return static_cast<std::uint64_t>((number >> shift) + half);
  };
  return ((axis(43) << 20 | axis(23)) << 20 | axis(3)) << 3 | (key & 7);
}

/// The number of the cube along an axis, whose bits begin `at` there.
std::int64_t cube_of(std::uint64_t key, int at) {
  return static_cast<std::int64_t>(key >> at & kAxisMask) - (std::int64_t{1} << 19);
}

/// Chan and others 1979.
void merge(const Gathered& from, Gathered& into) {
  const double count = into.count + from.count;
  const Eigen::Vector3d apart = from.mean - into.mean;
  const double weight = into.count * from.count / count;
  into.scatter += from.scatter;
  for (Eigen::Index i = 0, at = 0; i < 3; ++i)
    for (Eigen::Index j = i; j < 3; ++j)
      into.scatter[at++] += apart[i] * apart[j] * weight;
  into.mean += apart * (from.count / count);
  into.to_sensor += from.to_sensor;
  into.count = count;
}

Patch patch_of(const Gathered& gathered) {
  Patch patch;
  const SymmetricEigen eigen = symmetric_eigen(gathered.scatter_matrix() / gathered.count);
  patch.mean = gathered.mean;
  patch.normal = eigen.vectors.col(0);
  if (patch.normal.dot(gathered.to_sensor.cast<double>()) < 0.0) patch.normal = -patch.normal;
  patch.along = eigen.vectors.col(2);
  patch.variances = eigen.values.cwiseMax(0.0);
  patch.count = gathered.count;
  return patch;
}

std::vector<Gathered> in_wider_cubes(const Context& context, const std::vector<Gathered>& gathered,
                                     int factor) {
  int shift = 0;
  while (1 << shift < factor)
    ++shift;
  struct Place {
    std::uint64_t key;
    std::uint32_t from;
  };
  std::vector<Place> places(gathered.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i] = {wider(gathered[i].key, shift), static_cast<std::uint32_t>(i)};
  parallel_sort(context, places.begin(), places.end(),
                [](const Place& a, const Place& b) { return a.key < b.key; });
  std::vector<std::uint32_t> begins;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (i == 0 || places[i].key != places[i - 1].key) begins.push_back(static_cast<std::uint32_t>(i));
  std::vector<Gathered> wide(begins.size());
  parallel_for(context, begins.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t first = begins[k], last = k + 1 < begins.size() ? begins[k + 1] : places.size();
      wide[k] = gathered[places[first].from];
      wide[k].key = places[first].key;
      for (std::size_t i = first + 1; i < last; ++i)
        merge(gathered[places[i].from], wide[k]);
    }
  });
  return wide;
}

constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// The cube behind the face that the surface of a patch lies at, along the axis that its normal is nearest
/// to, as the step of its key; 0 if it lies at none.
std::int64_t step_at_face(const Gathered& gathered, double width) {
  constexpr double kAtFace = 0.15;
  Eigen::Index axis = 0;
  symmetric_eigen(gathered.scatter_matrix()).vectors.col(0).cwiseAbs().maxCoeff(&axis);
  const double place = gathered.mean[axis] / width;
  const double within = place - std::floor(place);
  const std::int64_t step = std::int64_t{1} << (axis == 0 ? 3 : axis == 1 ? 23 : 43);
  return within < kAtFace ? -step : within > 1.0 - kAtFace ? step : 0;
}

/// Where a surface lies at the face of two cubes its noise leaves a slice of it in each, with means to either
/// side of it. For each patch the one behind that face of which that is so, or none.
std::vector<std::uint32_t> other_slices(const Context& context, std::span<const Gathered> all, double width) {
  constexpr std::size_t kGrain = 1024;
  std::vector<std::int64_t> steps(all.size());
  parallel_for(context, all.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      steps[i] = step_at_face(all[i], width);
  });
  std::vector<std::uint32_t> others(all.size(), kNone);
  parallel_for(context, all.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (steps[i] == 0) continue;
      const std::uint64_t key = all[i].key + static_cast<std::uint64_t>(steps[i]);
      const auto found = std::lower_bound(all.begin(), all.end(), key,
                                          [](const Gathered& one, std::uint64_t k) { return one.key < k; });
      const auto j = static_cast<std::size_t>(found - all.begin());
      if (found != all.end() && found->key == key && steps[j] == -steps[i])
        others[i] = static_cast<std::uint32_t>(j);
    }
  });
  return others;
}

/// A patch and, joined to it, the smaller slice of it in another cube.
struct Whole {
  std::uint32_t slice, other;
};

std::vector<Whole> wholes_of(const Context& context, std::span<const Gathered> all, double width,
                             double least_points) {
  const std::vector<std::uint32_t> others = other_slices(context, all, width);
  std::vector<Whole> wholes;
  for (std::uint32_t i = 0; i < others.size(); ++i) {
    const std::uint32_t j = others[i];
    const double count = all[i].count, more = j == kNone ? 0.0 : all[j].count;
    if (more > count || (more == count && j < i)) continue;
    if (count + more >= least_points) wholes.push_back({i, j});
  }
  return wholes;
}

}  // namespace

PatchLevel::PatchLevel(const Context& context, const Surfaces& surfaces, int factor, double least_points)
    : width_(surfaces.width * factor) {
  const std::vector<Gathered> wider =
      factor > 1 ? in_wider_cubes(context, surfaces.gathered, factor) : std::vector<Gathered>();
  const std::span<const Gathered> all = factor > 1 ? wider : surfaces.gathered;
  const std::vector<Whole> wholes = wholes_of(context, all, width_, least_points);
  patches_.resize(wholes.size());
  parallel_for(context, wholes.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Gathered whole = all[wholes[i].slice];
      if (wholes[i].other != kNone) merge(all[wholes[i].other], whole);
      patches_[i] = patch_of(whole);
    }
  });
  noise_ = noise_of(patches_);
  for (std::size_t i = 0; i < wholes.size(); ++i) {
    const std::uint64_t key = all[wholes[i].slice].key;
    Range& range = *index_.add(key_of(cube_of(key, 3), cube_of(key, 23), cube_of(key, 43))).value;
    if (range.count == 0) range.first = static_cast<std::uint32_t>(i);
    ++range.count;
  }
}

}  // namespace ray::align
