#include "coarse.h"

#include <raycloud/exec/parallel.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace ray::align {
namespace {

constexpr std::size_t kSide = 256;
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr std::size_t kPeaks = 40;  // of one turn

/// Takes out what is wide, which says nothing of where things are, and makes the energy 1.
void filter(Image& spectrum, std::size_t side) {
  constexpr float kWide = 1.0F / 12.0F;  // per cell
  double energy = 0.0;
  for (std::size_t row = 0; row < side; ++row)
    for (std::size_t column = 0; column < side; ++column) {
      const auto frequency = [side](std::size_t i) {
        return static_cast<float>(std::min(i, side - i)) / static_cast<float>(side);
      };
      const float u = frequency(row), v = frequency(column), squared = u * u + v * v;
      std::complex<float>& value = spectrum[row * side + column];
      value *= squared / (squared + kWide * kWide);
      energy += static_cast<double>(std::norm(value));
    }
  const float scale = energy > 0.0 ? static_cast<float>(1.0 / std::sqrt(energy)) : 0.0F;
  for (std::complex<float>& value : spectrum)
    value *= scale;
}

struct Peak {
  int x, y;
  float score;
};

/// The highest values of an image that are the highest within two cells.
std::vector<Peak> peaks_of(const Image& image, std::size_t side) {
  constexpr int kApart = 2;
  const auto mask = static_cast<int>(side) - 1;
  const auto at = [&](int x, int y) {
    return image[static_cast<std::size_t>(y & mask) * side + static_cast<std::size_t>(x & mask)].real();
  };
  std::vector<Peak> peaks;
  for (int y = 0; y <= mask; ++y)
    for (int x = 0; x <= mask; ++x) {
      const float value = at(x, y);
      bool is_highest = value > 0.0F && value > at(x - 1, y) && value >= at(x + 1, y);
      for (int j = -kApart; j <= kApart && is_highest; ++j)
        for (int i = -kApart; i <= kApart && is_highest; ++i)
          is_highest = at(x + i, y + j) <= value;
      if (is_highest) peaks.push_back({x, y, value});
    }
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const Peak& a, const Peak& b) { return a.score > b.score; });
  if (peaks.size() > kPeaks) peaks.resize(kPeaks);
  return peaks;
}

/// The reference, transformed once.
struct Target {
  Image facing, height;
};

class Search {
 public:
  Search(const Footprint& cloud, const Footprint& reference)
      : fourier_(kSide),
        cloud_(cloud),
        reference_(reference),
        // Neither wraps round onto the other.
        cell_(2.0 * (cloud.radius + reference.radius) / kSide) {
    Rasters rasters;
    Image scratch;
    draw(reference, 0.0, cell_, kSide, rasters);
    transform(rasters, scratch);
    target_ = {std::move(rasters.facing), std::move(rasters.height)};
  }

  /// So fine that the outermost feature moves by less than a cell and a half from one to the next.
  [[nodiscard]] std::size_t turns() const {
    const double step = 1.5 * cell_ / cloud_.radius;
    return static_cast<std::size_t>(std::clamp(std::ceil(kTurn / step), 72.0, 360.0));
  }
  [[nodiscard]] double cell() const { return cell_; }

  [[nodiscard]] std::vector<Candidate> at(double yaw) const {
    Rasters rasters;
    Image scratch;
    draw(cloud_, yaw, cell_, kSide, rasters);
    transform(rasters, scratch);
    Image& product = rasters.facing;
    for (std::size_t i = 0; i < product.size(); ++i)
      product[i] =
          target_.facing[i] * std::conj(product[i]) + target_.height[i] * std::conj(rasters.height[i]);
    fourier_.backward(product, scratch);
    std::vector<Candidate> candidates;
    for (const Peak& peak : peaks_of(product, kSide)) {
      const auto cells = [](int i) {
        return static_cast<double>(i < static_cast<int>(kSide) / 2 ? i : i - static_cast<int>(kSide));
      };
      const double c = std::cos(yaw), s = std::sin(yaw);
      const Eigen::Vector2d turned(c * cloud_.centre.x() - s * cloud_.centre.y(),
                                   s * cloud_.centre.x() + c * cloud_.centre.y());
      const Eigen::Vector2d shift = Eigen::Vector2d(cells(peak.x), cells(peak.y)) * cell_;
      candidates.push_back({yaw, reference_.centre + shift - turned, 0.5 * static_cast<double>(peak.score)});
    }
    return candidates;
  }

 private:
  void transform(Rasters& rasters, Image& scratch) const {
    for (Image* image : {&rasters.facing, &rasters.height}) {
      fourier_.forward(*image, scratch);
      filter(*image, kSide);
    }
  }

  Fourier fourier_;
  const Footprint& cloud_;
  const Footprint& reference_;
  double cell_;
  Target target_;
};

}  // namespace

std::vector<Candidate> find_candidates(const Context& context, const Footprint& cloud,
                                       const Footprint& reference, std::size_t most) {
  if (cloud.features.empty() || reference.features.empty()) return {};
  const Search search(cloud, reference);
  const std::size_t turns = search.turns();
  const double step = kTurn / static_cast<double>(turns);
  std::vector<std::vector<Candidate>> of_turn(turns);
  parallel_for(context, turns, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      of_turn[i] = search.at(static_cast<double>(i) * step);
  });
  std::vector<Candidate> all;
  for (const std::vector<Candidate>& some : of_turn)
    all.insert(all.end(), some.begin(), some.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  // Where the middle of the cloud comes to lie tells candidates apart, whatever the turn.
  std::vector<Candidate> candidates;
  std::vector<Eigen::Vector2d> places;
  const double near = 2.0 * search.cell();
  for (const Candidate& one : all) {
    if (candidates.size() == most) break;
    const Eigen::Vector2d place = Eigen::Rotation2Dd(one.yaw) * cloud.centre + one.shift;
    bool is_new = true;
    for (std::size_t i = 0; i < candidates.size() && is_new; ++i)
      is_new = (place - places[i]).squaredNorm() >= near * near ||
               std::abs(std::remainder(one.yaw - candidates[i].yaw, kTurn)) >= 1.5 * step;
    if (!is_new) continue;
    candidates.push_back(one);
    places.push_back(place);
  }
  return candidates;
}

}  // namespace ray::align
