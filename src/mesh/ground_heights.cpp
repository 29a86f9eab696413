#include "ground_heights.h"

#include "plane_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace ray {
namespace {

constexpr std::size_t kBins = 40;
constexpr double kBinHeight = 1.0 / 64.0;  // m
constexpr double kLowest = -0.25;          // m; of the first bin

using Frequencies = std::array<std::uint16_t, kBins>;

/// Height above the place of a site: at the middle of its cell, and its slope.
struct CellPlane {
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  double height = 0.0;  ///< at the middle
};

/// The slope that fits the sites around, whatever the height of each. A slope as steep as the gradient is
/// taken to be as unlikely as an error of kNoise, so that sites that are few or on a line make no wild ones.
CellPlane plane_through(const std::vector<GroundSite>& sites, const PlanRaster& raster, std::size_t cell,
                        double gradient) {
  constexpr double kNoise = 0.05;  // m
  constexpr int kEnough = 6;
  constexpr std::int64_t kFewRings = 3;
  PlaneFit fit;
  for (std::int64_t rings = 1; rings <= kFewRings && fit.count < kEnough; ++rings) {
    fit = {};
    raster.around(
        cell,
        [&](std::size_t near) {
          if (sites[near].is_there) fit.add(sites[near].place - sites[cell].place);
        },
        rings);
  }
  const double unlikely = kNoise / gradient;
  const PlaneFit::Plane plane = fit.plane_of_likely_slope(unlikely * unlikely);
  const Eigen::Vector3d& own = sites[cell].place;
  return {plane.slope, own.z() + plane.height + plane.slope.dot(raster.centre(cell) - own.head<2>())};
}

struct BinnedEnd {
  std::uint32_t site = 0;
  std::uint32_t bin = 0;
};

/// The mean height about the lowest peak, from the first bin in bins; below 0 for no ends.
double lowest_peak(const Frequencies& frequencies) {
  constexpr int kPeak = 2;  // bins on either side
  constexpr int kMean = 3;
  constexpr double kEnough = 0.3;  // of the highest
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
  while (smooth[peak] < kEnough * highest)
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
                                            const std::vector<GroundSite>& sites, const PlanRaster& raster,
                                            double gradient) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> numbers(sites.size(), kNone);
  std::vector<std::size_t> cells;
  for (std::size_t cell = 0; cell < sites.size(); ++cell) {
    if (!sites[cell].is_there) continue;
    numbers[cell] = static_cast<std::uint32_t>(cells.size());
    cells.push_back(cell);
  }
  const auto for_sites = [&](const auto& visit) {
    parallel_for(context, cells.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        visit(i);
    });
  };
  std::vector<CellPlane> planes(cells.size());
  for_sites([&](std::size_t i) { planes[i] = plane_through(sites, raster, cells[i], gradient); });
  std::vector<Frequencies> frequencies(cells.size(), Frequencies{});
  stream(
      context, source, nullptr,
      [&](RayCloud& rays) {
        std::vector<BinnedEnd> ends;
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (rays.bounded[i] == 0) continue;
          const Eigen::Vector3d& end = rays.ends[i];
          const auto cell = raster.find(end.x(), end.y());
          if (!cell || numbers[*cell] == kNone) continue;
          const CellPlane& plane = planes[numbers[*cell]];
          const double height =
              end.z() - plane.height - plane.slope.dot(end.head<2>() - raster.centre(*cell));
          const double bin = std::floor((height - kLowest) / kBinHeight);
          if (bin >= 0.0 && bin < static_cast<double>(kBins))
            ends.push_back({numbers[*cell], static_cast<std::uint32_t>(bin)});
        }
        return ends;
      },
      [&](RayCloud&, const std::vector<BinnedEnd>& ends) {
        for (const BinnedEnd& end : ends) {
          std::uint16_t& count = frequencies[end.site][end.bin];
          if (count < 0xFFFF) ++count;
        }
      });
  std::vector<double> peaks(cells.size());
  for_sites([&](std::size_t i) { peaks[i] = lowest_peak(frequencies[i]); });
  std::vector<Eigen::Vector3d> ground;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (peaks[i] < 0.0) continue;
    const Eigen::Vector2d centre = raster.centre(cells[i]);
    ground.emplace_back(centre.x(), centre.y(), planes[i].height + kLowest + peaks[i] * kBinHeight);
  }
  return ground;
}

}  // namespace ray
