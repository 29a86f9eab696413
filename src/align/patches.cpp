#include "patches.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/spatial/symmetric_eigen.h>

#include <algorithm>

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

VoxelIndex cube_of(std::uint64_t key) {
  const auto axis = [&](int at) {
    return static_cast<std::int64_t>(key >> at & kAxisMask) - (std::int64_t{1} << 19);
  };
  return {axis(3), axis(23), axis(43)};
}

/// Chan and others 1979.
void merge(const Gathered& from, Gathered& into) {
  const double count = into.count + from.count;
  const Eigen::Vector3d apart = from.mean - into.mean;
  into.scatter += from.scatter + apart * apart.transpose() * (into.count * from.count / count);
  into.mean += apart * (from.count / count);
  into.to_sensor += from.to_sensor;
  into.count = count;
}

Patch patch_of(const Gathered& gathered) {
  Patch patch;
  const SymmetricEigen eigen = symmetric_eigen(gathered.scatter / gathered.count);
  patch.mean = gathered.mean;
  patch.normal = eigen.vectors.col(0);
  if (patch.normal.dot(gathered.to_sensor) < 0.0) patch.normal = -patch.normal;
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
  std::vector<Gathered> wide;
  for (const Place& place : places) {
    if (wide.empty() || wide.back().key != place.key) {
      wide.push_back(gathered[place.from]);
      wide.back().key = place.key;
    } else {
      merge(gathered[place.from], wide.back());
    }
  }
  return wide;
}

/// Which face of its cube the surface of a patch lies at, along the axis that its normal is nearest to; 0, or
/// the step of the key to the cube behind that face.
std::int64_t step_at_face(const Gathered& gathered, double width) {
  constexpr double kAtFace = 0.15;
  Eigen::Index axis = 0;
  symmetric_eigen(gathered.scatter).vectors.col(0).cwiseAbs().maxCoeff(&axis);
  const double place = gathered.mean[axis] / width;
  const double within = place - std::floor(place);
  const std::int64_t step = std::int64_t{1} << (axis == 0 ? 3 : axis == 1 ? 23 : 43);
  return within < kAtFace ? -step : within > 1.0 - kAtFace ? step : 0;
}

/// Where a surface lies at the face of two cubes its noise leaves a slice of it in each, with means to either
/// side of it. Joins the smaller to the larger.
void join_slices(const Context& context, std::vector<Gathered>& all, double width) {
  std::vector<std::int64_t> steps(all.size());
  parallel_for(context, all.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      steps[i] = step_at_face(all[i], width);
  });
  const std::vector<Gathered> slices = all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (steps[i] == 0) continue;
    const std::uint64_t key = slices[i].key + static_cast<std::uint64_t>(steps[i]);
    const auto found = std::lower_bound(slices.begin(), slices.end(), key,
                                        [](const Gathered& one, std::uint64_t k) { return one.key < k; });
    if (found == slices.end() || found->key != key) continue;
    const auto j = static_cast<std::size_t>(found - slices.begin());
    if (steps[j] != -steps[i] || slices[j].count < slices[i].count ||
        (slices[j].count == slices[i].count && j > i))
      continue;
    merge(slices[i], all[j]);
    all[i].count = 0.0;
  }
  std::erase_if(all, [](const Gathered& one) { return one.count == 0.0; });
}

}  // namespace

PatchLevel::PatchLevel(const Context& context, const Surfaces& surfaces, int factor, double least_points)
    : width_(surfaces.width * factor) {
  std::vector<Gathered> wide =
      factor > 1 ? in_wider_cubes(context, surfaces.gathered, factor) : surfaces.gathered;
  join_slices(context, wide, width_);
  std::vector<const Gathered*> chosen;
  for (const Gathered& gathered : wide)
    if (gathered.count >= least_points) chosen.push_back(&gathered);
  patches_.resize(chosen.size());
  parallel_for(context, chosen.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      patches_[i] = patch_of(*chosen[i]);
  });
  noise_ = noise_of(patches_);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    Range& range = *index_.add(voxel_place(cube_of(chosen[i]->key)).key).value;
    if (range.count == 0) range.first = static_cast<std::uint32_t>(i);
    ++range.count;
  }
}

}  // namespace ray::align
