#include "line_raster.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace ray {
namespace {

constexpr int kFraction = 31;  // bits of a position behind the point
constexpr std::int64_t kOne = std::int64_t{1} << kFraction;

std::int64_t fixed(double pixels) {
  return static_cast<std::int64_t>(std::floor(pixels * static_cast<double>(kOne) + 0.5));
}

std::size_t band_length_for(std::size_t length) {
  constexpr std::size_t kMostBands = 64;
  constexpr std::size_t kShortest = 16;
  return std::max((length + kMostBands - 1) / kMostBands, kShortest);
}

}  // namespace

/// A line as it is walked: pixel by pixel along its major axis, in which it is longer.
struct LineRaster::Segment {
  bool lengthwise;          // the major axis is the longer side of the raster
  std::int64_t begin;       // on the major axis
  std::int64_t end;         // not less
  std::int64_t minor;       // position on the other axis where the pixel of `begin` begins
  std::int64_t slope;       // change of that for a pixel of the major axis, at most 1 either way
  std::int64_t chord;       // units of length for a pixel of the major axis
  double units_per_step;    // units of length for a step of the minor axis
  bool inside;              // all of it on the minor axis, without rounding to the pixels at the edge
  std::int64_t first_band;  // that it may touch
  std::int64_t last_band;
};

/// The cells of one band.
class LineRaster::Band {
 public:
  Band(std::uint64_t* cells, std::size_t breadth, std::size_t length, std::size_t first, std::size_t past)
      : cells_(cells),
        breadth_(static_cast<std::int64_t>(breadth)),
        length_(static_cast<std::int64_t>(length)),
        first_(static_cast<std::int64_t>(first)),
        past_(static_cast<std::int64_t>(past)) {}

  void draw(const Segment& segment) const {
    if (segment.lengthwise) {
      walk(segment, length_, first_, past_ - 1, breadth_,
           [&](std::int64_t along, std::int64_t across, std::int64_t units) {
             cells_[along * breadth_ + across] += static_cast<std::uint64_t>(units);
           });
    } else if (segment.first_band == segment.last_band) {
      walk(segment, breadth_, 0, breadth_ - 1, length_,
           [&](std::int64_t across, std::int64_t along, std::int64_t units) {
             cells_[along * breadth_ + across] += static_cast<std::uint64_t>(units);
           });
    } else {
      const auto [from, to] = pixels_within(segment);
      walk(segment, breadth_, from, to, length_,
           [&](std::int64_t across, std::int64_t along, std::int64_t units) {
             if (along < first_ || along >= past_) return;
             cells_[along * breadth_ + across] += static_cast<std::uint64_t>(units);
           });
    }
  }

 private:
  /// The pixels on the major axis, one or two too many, where the minor axis is within the band. Beyond the
  /// first and last band is rounding, which counts for them.
  [[nodiscard]] std::pair<std::int64_t, std::int64_t> pixels_within(const Segment& segment) const {
    const std::int64_t low = (first_ == 0 ? -1 : first_) * kOne;
    const std::int64_t high = (past_ == length_ ? past_ + 1 : past_) * kOne;
    const std::int64_t a = (low - segment.minor) / segment.slope;
    const std::int64_t b = (high - segment.minor) / segment.slope;
    const std::int64_t start = segment.begin >> kFraction;
    return {start + std::min(a, b) - 1, start + std::max(a, b) + 1};
  }

  /// Calls `add(major, minor, units)` for every pixel of the segment with `from` ≤ major ≤ `to`, where the
  /// axes have `major_pixels` and `minor_pixels`. What it adds to a pixel depends on nothing but the segment.
  template <class Add>
  static void walk(const Segment& segment, std::int64_t major_pixels, std::int64_t from, std::int64_t to,
                   std::int64_t minor_pixels, const Add& add) {
    if (segment.inside) {
      const auto within = [](std::int64_t minor) { return minor >> kFraction; };
      walk_by(segment, major_pixels, from, to, within, add);
    } else {
      const auto at_edge = [&](std::int64_t minor) {
        return std::clamp<std::int64_t>(minor >> kFraction, 0, minor_pixels - 1);
      };
      walk_by(segment, major_pixels, from, to, at_edge, add);
    }
  }

  /// As walk, with `pixel_of(minor)` for the pixel at a position of the minor axis.
  template <class PixelOf, class Add>
  static void walk_by(const Segment& segment, std::int64_t major_pixels, std::int64_t from, std::int64_t to,
                      const PixelOf& pixel_of, const Add& add) {
    const auto piece = [&](std::int64_t major, std::int64_t in, std::int64_t out, std::int64_t units) {
      const std::int64_t before = pixel_of(in), after = pixel_of(out);
      if (before == after) return add(major, before, units);
      const std::int64_t edge = std::max(before, after) * kOne;  // as the slope is at most 1, the only one
      const double until_edge = static_cast<double>(std::abs(edge - in)) * segment.units_per_step;
      const std::int64_t part = std::min(static_cast<std::int64_t>(until_edge + 0.5), units);
      add(major, before, part);
      add(major, after, units - part);
    };
    const std::int64_t first = segment.begin >> kFraction;
    const std::int64_t last = std::min(segment.end >> kFraction, major_pixels - 1);
    const auto part_of_pixel = [&](std::int64_t major) {
      const std::int64_t minor = segment.minor + (major - first) * segment.slope;
      const std::int64_t in = std::max<std::int64_t>(segment.begin - major * kOne, 0);
      const std::int64_t out = std::min(segment.end - major * kOne, kOne);
      piece(major, minor + (segment.slope * in >> kFraction), minor + (segment.slope * out >> kFraction),
            (segment.chord * (out - in) + kOne / 2) >> kFraction);
    };
    if (from <= first && first <= to) part_of_pixel(first);
    if (from <= last && last <= to && last != first) part_of_pixel(last);
    from = std::max(from, first + 1);
    to = std::min(to, last - 1);
    std::int64_t minor = segment.minor + (from - first) * segment.slope;
    for (std::int64_t major = from; major <= to; major++, minor += segment.slope)
      piece(major, minor, minor + segment.slope, segment.chord);
  }

  std::uint64_t* cells_;  // of the whole raster
  std::int64_t breadth_;
  std::int64_t length_;
  std::int64_t first_;  // the pixels of the longer side
  std::int64_t past_;
};

/// The segments by the bands they may touch.
class LineRaster::Bins {
 public:
  Bins(std::span<const Segment> segments, std::size_t bands) : begins_(bands + 1), segments_(segments) {
    each([&](std::size_t band, std::size_t) { begins_[band + 1]++; });
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
    numbers_.resize(begins_.back());
    std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
    each([&](std::size_t band, std::size_t i) { numbers_[next[band]++] = static_cast<std::uint32_t>(i); });
  }
  [[nodiscard]] bool empty(std::size_t band) const { return begins_[band] == begins_[band + 1]; }
  void draw(std::size_t number, const Band& band) const {
    for (std::size_t i = begins_[number]; i < begins_[number + 1]; i++)
      band.draw(segments_[numbers_[i]]);
  }

 private:
  template <class Call>
  void each(const Call& call) const {
    for (std::size_t i = 0; i < segments_.size(); i++) {
      for (std::int64_t band = segments_[i].first_band; band <= segments_[i].last_band; band++)
        call(static_cast<std::size_t>(band), i);
    }
  }

  std::vector<std::uint32_t> begins_;
  std::vector<std::uint32_t> numbers_;
  std::span<const Segment> segments_;
};

LineRaster::LineRaster(std::size_t columns, std::size_t rows)
    : wide_(columns > rows),
      breadth_(std::min(columns, rows)),
      length_(std::max(columns, rows)),
      band_length_(band_length_for(length_)),
      cells_(columns * rows),
      locks_((length_ + band_length_ - 1) / band_length_) {}

LineRaster::Segment LineRaster::segment_of(const Line& line) const {
  const double along = wide_ ? line.x1 - line.x0 : line.y1 - line.y0;
  const double across = wide_ ? line.y1 - line.y0 : line.x1 - line.x0;
  Segment segment{};
  segment.lengthwise = std::abs(along) >= std::abs(across);
  const bool by_x = segment.lengthwise == wide_;
  double major0 = by_x ? line.x0 : line.y0, major1 = by_x ? line.x1 : line.y1;
  double minor0 = by_x ? line.y0 : line.x0, minor1 = by_x ? line.y1 : line.x1;
  if (major0 > major1) {
    std::swap(major0, major1);
    std::swap(minor0, minor1);
  }
  segment.begin = fixed(major0);
  segment.end = fixed(major1);
  const double slope = major1 > major0 ? (minor1 - minor0) / (major1 - major0) : 0.0;
  const std::int64_t first = segment.begin >> kFraction;
  segment.slope = fixed(slope);
  segment.minor = fixed(minor0 - slope * (major0 - static_cast<double>(first)));
  segment.chord = std::llround(kUnits * std::sqrt(1.0 + slope * slope));
  segment.units_per_step = static_cast<double>(segment.chord) / std::abs(static_cast<double>(segment.slope));
  const std::int64_t last = segment.end >> kFraction;
  const std::int64_t minor_end = segment.minor + segment.slope * (last - first + 1);
  const auto minor_pixels = static_cast<std::int64_t>(segment.lengthwise ? breadth_ : length_);
  segment.inside =
      std::min(segment.minor, minor_end) >= 0 && std::max(segment.minor, minor_end) < minor_pixels * kOne;
  const auto band_of = [&](std::int64_t pixel) {
    const auto most = static_cast<std::int64_t>(length_) - 1;
    return std::clamp<std::int64_t>(pixel, 0, most) / static_cast<std::int64_t>(band_length_);
  };
  segment.first_band = band_of(segment.lengthwise ? first : std::min(segment.minor, minor_end) >> kFraction);
  segment.last_band = band_of(segment.lengthwise ? last : std::max(segment.minor, minor_end) >> kFraction);
  return segment;
}

LineRaster::Band LineRaster::band(std::size_t number) {
  return {cells_.data(), breadth_, length_, number * band_length_,
          std::min((number + 1) * band_length_, length_)};
}

void LineRaster::draw(std::span<const Line> lines) {
  std::vector<Segment> segments;
  segments.reserve(lines.size());
  for (const Line& line : lines) {
    const Segment segment = segment_of(line);
    if (segment.end > segment.begin) segments.push_back(segment);
  }
  const Bins bins(segments, locks_.size());
  std::vector<std::size_t> waiting;
  for (std::size_t number = 0; number < locks_.size(); number++) {
    if (!bins.empty(number)) waiting.push_back(number);
  }
  while (!waiting.empty()) {
    const std::size_t before = waiting.size();
    std::erase_if(waiting, [&](std::size_t number) {
      const std::unique_lock lock(locks_[number], std::try_to_lock);
      if (lock) bins.draw(number, band(number));
      return lock.owns_lock();
    });
    if (waiting.size() < before) continue;
    const std::lock_guard lock(locks_[waiting.back()]);  // others draw to all of them: wait for one
    bins.draw(waiting.back(), band(waiting.back()));
    waiting.pop_back();
  }
}

}  // namespace ray
