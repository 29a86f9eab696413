#include "plan_opening.h"

#include <raycloud/exec/parallel.h>

#include <limits>

namespace ray {
namespace {

constexpr float kEmptyCell = std::numeric_limits<float>::infinity();
constexpr std::size_t kLanes = 16;  // columns side by side

/// For lines of `length` values, `lanes` of them interleaved: each value becomes the least within `radius` of
/// it in its line. By minima over 2, 4, 8… values (van Herk's is no quicker for lines side by side).
class RunningMinimum {
 public:
  RunningMinimum(std::size_t length, std::size_t lanes, std::size_t radius)
      : lanes_(lanes), radius_(radius), count_(length * lanes), least_((length + 2 * radius) * lanes) {}

  /// Where the lines are put before and found after run().
  [[nodiscard]] float* lines() { return least_.data() + radius_ * lanes_; }
  [[nodiscard]] const float* minima() const { return least_.data(); }

  void run() {
    std::fill_n(least_.begin(), radius_ * lanes_, kEmptyCell);
    std::fill_n(least_.end() - static_cast<std::ptrdiff_t>(radius_ * lanes_), radius_ * lanes_, kEmptyCell);
    const std::size_t window = 2 * radius_ + 1;
    std::size_t width = 1;
    std::size_t valid = least_.size();
    const auto join = [&](std::size_t apart, std::size_t count) {
      float* least = least_.data();
      for (std::size_t i = 0; i < count; ++i)
        least[i] = least[i + apart] < least[i] ? least[i + apart] : least[i];
    };
    for (; 2 * width <= window; width *= 2) {
      valid -= width * lanes_;
      join(width * lanes_, valid);
    }
    join((window - width) * lanes_, count_);
  }

 private:
  std::size_t lanes_, radius_, count_;
  std::vector<float> least_;
};

void erode_rows(const Context& context, std::vector<float>& heights, const PlanRaster& raster,
                std::size_t radius) {
  const auto columns = static_cast<std::size_t>(raster.columns);
  parallel_for(context, static_cast<std::size_t>(raster.rows), 64, [&](std::size_t begin, std::size_t end) {
    RunningMinimum minimum(columns, 1, radius);
    for (std::size_t row = begin; row < end; ++row) {
      float* line = heights.data() + row * columns;
      std::copy_n(line, columns, minimum.lines());
      minimum.run();
      std::copy_n(minimum.minima(), columns, line);
    }
  });
}

void erode_columns(const Context& context, std::vector<float>& heights, const PlanRaster& raster,
                   std::size_t radius) {
  const auto columns = static_cast<std::size_t>(raster.columns);
  const auto rows = static_cast<std::size_t>(raster.rows);
  parallel_for(context, columns, kLanes, [&](std::size_t begin, std::size_t end) {
    const std::size_t lanes = end - begin;
    RunningMinimum minimum(rows, lanes, radius);
    for (std::size_t row = 0; row < rows; ++row)
      std::copy_n(heights.data() + row * columns + begin, lanes, minimum.lines() + row * lanes);
    minimum.run();
    for (std::size_t row = 0; row < rows; ++row)
      std::copy_n(minimum.minima() + row * lanes, lanes, heights.data() + row * columns + begin);
  });
}

void erode(const Context& context, std::vector<float>& heights, const PlanRaster& raster,
           std::size_t radius) {
  erode_rows(context, heights, raster, radius);
  erode_columns(context, heights, raster, radius);
}

/// So that the highest become the lowest; where there is nothing there stays nothing.
void turn_over(std::vector<float>& heights) {
  for (float& height : heights)
    height = height == kEmptyCell ? kEmptyCell : -height;
}

}  // namespace

std::vector<float> plan_opening(const Context& context, std::vector<float> heights, const PlanRaster& raster,
                                std::int64_t radius) {
  erode(context, heights, raster, static_cast<std::size_t>(radius));
  turn_over(heights);
  erode(context, heights, raster, static_cast<std::size_t>(radius));
  turn_over(heights);
  return heights;
}

}  // namespace ray
