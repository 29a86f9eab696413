#include "ground_heights.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace ray {
namespace {

constexpr std::size_t kBins = 64;
constexpr double kBinHeight = 1.0 / 64.0;  // m
constexpr double kLowest = -0.25;          // m; of the first bin

using Frequencies = std::array<std::uint16_t, kBins>;

/// Height above the place of a site: at the middle of its cell, and its slope.
struct CellPlane {
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  double height = 0.0;  ///< at the middle
};

/// The slope that fits the sites around, whatever the height of each; level where they are too few.
CellPlane plane_through(const std::vector<GroundSite>& sites, const PlanRaster& raster, std::size_t cell) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  int count = 0;
  raster.around(cell, [&](std::size_t near) {
    if (!sites[near].is_there) return;
    mean += sites[near].place;
    ++count;
  });
  mean /= count;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  Eigen::Vector2d rise = Eigen::Vector2d::Zero();
  raster.around(cell, [&](std::size_t near) {
    if (!sites[near].is_there) return;
    const Eigen::Vector3d away = sites[near].place - mean;
    spread += away.head<2>() * away.head<2>().transpose();
    rise += away.head<2>() * away.z();
  });
  CellPlane plane;
  const double least = 0.05 * raster.width * raster.width;
  if (count >= 3 && spread.determinant() > least * least) plane.slope = spread.inverse() * rise;
  plane.height = mean.z() + plane.slope.dot(raster.centre(cell) - mean.head<2>());
  return plane;
}

struct BinnedEnd {
  std::uint32_t cell = 0;
  std::uint32_t bin = 0;
};

/// The mean height about the lowest peak, from the first bin in bins; below 0 for no ends.
double lowest_peak(const Frequencies& frequencies) {
  constexpr int kPeak = 2;  // bins on either side
  constexpr int kMean = 3;
  const auto sum = [&](int from, int to, auto value) {
    double total = 0.0;
    for (int bin = std::max(from, 0); bin <= std::min(to, static_cast<int>(kBins) - 1); ++bin)
      total += value(bin) * frequencies[static_cast<std::size_t>(bin)];
    return total;
  };
  std::array<double, kBins> smooth{};
  for (int bin = 0; bin < static_cast<int>(kBins); ++bin)
    smooth[static_cast<std::size_t>(bin)] = sum(bin - kPeak, bin + kPeak, [](int) { return 1.0; });
  const double highest = *std::max_element(smooth.begin(), smooth.end());
  if (highest == 0.0) return -1.0;
  std::size_t peak = 0;
  while (smooth[peak] < 0.5 * highest)
    ++peak;
  while (peak + 1 < kBins && smooth[peak + 1] > smooth[peak])
    ++peak;
  // The top may be flat.
  std::size_t last = peak;
  while (last + 1 < kBins && smooth[last + 1] == smooth[peak])
    ++last;
  const int middle = static_cast<int>((peak + last) / 2);
  const double weight = sum(middle - kMean, middle + kMean, [](int) { return 1.0; });
  if (weight == 0.0) return static_cast<double>(middle) + 0.5;
  return sum(middle - kMean, middle + kMean, [](int bin) { return bin + 0.5; }) / weight;
}

}  // namespace

std::vector<Eigen::Vector3d> ground_heights(const Context& context, RaySource& source,
                                            const std::vector<GroundSite>& sites, const PlanRaster& raster) {
  std::vector<CellPlane> planes(sites.size());
  parallel_for(context, sites.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell)
      if (sites[cell].is_there) planes[cell] = plane_through(sites, raster, cell);
  });
  std::vector<Frequencies> frequencies(sites.size(), Frequencies{});
  stream(
      context, source, nullptr,
      [&](RayCloud& rays) {
        std::vector<BinnedEnd> ends;
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (rays.bounded[i] == 0) continue;
          const Eigen::Vector3d& end = rays.ends[i];
          const auto cell = raster.find(end.x(), end.y());
          if (!cell || !sites[*cell].is_there) continue;
          const CellPlane& plane = planes[*cell];
          const double height =
              end.z() - plane.height - plane.slope.dot(end.head<2>() - raster.centre(*cell));
          const double bin = std::floor((height - kLowest) / kBinHeight);
          if (bin >= 0.0 && bin < static_cast<double>(kBins))
            ends.push_back({static_cast<std::uint32_t>(*cell), static_cast<std::uint32_t>(bin)});
        }
        return ends;
      },
      [&](RayCloud&, const std::vector<BinnedEnd>& ends) {
        for (const BinnedEnd& end : ends) {
          std::uint16_t& count = frequencies[end.cell][end.bin];
          if (count < 0xFFFF) ++count;
        }
      });
  std::vector<double> peaks(sites.size(), -1.0);
  parallel_for(context, sites.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell)
      if (sites[cell].is_there) peaks[cell] = lowest_peak(frequencies[cell]);
  });
  std::vector<Eigen::Vector3d> ground;
  for (std::size_t cell = 0; cell < sites.size(); ++cell) {
    const double bins = peaks[cell];
    if (bins < 0.0) continue;
    const Eigen::Vector2d centre = raster.centre(cell);
    ground.emplace_back(centre.x(), centre.y(), planes[cell].height + kLowest + bins * kBinHeight);
  }
  return ground;
}

}  // namespace ray
