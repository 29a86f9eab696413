#include "crossing_rays.h"

#include <raycloud/exec/stream.h>

#include <algorithm>
#include <cassert>
#include <cstring>

namespace ray {
namespace {

const ColumnInfo kNumberColumn{"number", ScalarType::uint32};

bool meets(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
           double slack) {
  double from = 0.0, to = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min()[axis] - slack, high = box.max()[axis] + slack;
    const double at = start[axis], way = end[axis] - at;
    if (way == 0.0) {
      if (at < low || at > high) return false;
      continue;
    }
    const double one = (low - at) / way, other = (high - at) / way;
    from = std::max(from, std::min(one, other));
    to = std::min(to, std::max(one, other));
    if (from > to) return false;
  }
  return true;
}

/// The rays of a chunk on their way, those of one block beside each other.
struct SortedRays {
  std::vector<SpilledRay> rays;
  std::vector<std::size_t> ends;  ///< by stream
};

/// The rays of one stream, and of the next ones.
class SpilledRaySource final : public RaySource {
 public:
  SpilledRaySource(SpilledRows<SpilledRay>& rays, std::size_t first, std::size_t streams)
      : rays_(rays), first_(first), last_(first + streams) {
    info_.ray_count = 0;
    for (std::size_t stream = first_; stream < last_; ++stream)
      *info_.ray_count += rays.size(stream);
    info_.precision = Precision::double_;
    info_.extras = {kNumberColumn};
    SpilledRaySource::rewind();
  }
  [[nodiscard]] const CloudInfo& info() const override { return info_; }

  [[nodiscard]] bool fetch(RawChunk& raw) override {
    constexpr std::size_t kRays = 32768;
    while (stream_ < last_ && next_ == rays_.size(stream_)) {
      ++stream_;
      next_ = 0;
    }
    if (stream_ == last_) return false;
    raw.first_row = row_;
    raw.rows = std::min(kRays, rays_.size(stream_) - next_);
    next_ += raw.rows;
    row_ += raw.rows;
    raw.bytes.resize(raw.rows * sizeof(SpilledRay));
    rays_.read_bytes(stream_, raw.bytes);
    return true;
  }

  std::size_t decode(const RawChunk& raw, RayCloud& rays) const override {
    rays.set_schema(info_.extras);
    rays.resize(raw.rows);
    const auto numbers = rays.extras.front().values<std::uint32_t>();
    for (std::size_t i = 0; i < raw.rows; ++i) {
      SpilledRay ray;
      std::memcpy(static_cast<void*>(&ray), &raw.bytes[i * sizeof(SpilledRay)], sizeof(SpilledRay));
      rays.starts[i] = ray.start;
      rays.ends[i] = ray.end;
      rays.times[i] = ray.time;
      rays.bounded[i] = ray.bounded;
      numbers[i] = ray.number;
    }
    return 0;
  }

  void rewind() override {
    for (std::size_t stream = first_; stream < last_; ++stream)
      rays_.rewind(stream);
    stream_ = first_;
    next_ = row_ = 0;
  }

 private:
  SpilledRows<SpilledRay>& rays_;
  std::size_t first_, last_;
  std::size_t stream_ = 0, next_ = 0;
  std::uint64_t row_ = 0;
  CloudInfo info_;
};

}  // namespace

BoxTree::BoxTree(std::span<const Eigen::AlignedBox3d> boxes) : nodes_(2 * boxes.size()) {
  assert((boxes.size() & (boxes.size() - 1)) == 0);
  std::copy(boxes.begin(), boxes.end(), nodes_.begin() + static_cast<std::ptrdiff_t>(boxes.size()));
  for (std::size_t node = boxes.size(); node-- > 1;)
    nodes_[node] = nodes_[2 * node].merged(nodes_[2 * node + 1]);
}

void BoxTree::near_line(const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                        std::vector<std::uint32_t>& found) const {
  constexpr double kRounded = 1e-12;
  found.clear();
  find(1, start, end, kRounded * std::max(start.cwiseAbs().maxCoeff(), end.cwiseAbs().maxCoeff()), found);
}

void BoxTree::find(std::size_t node, const Eigen::Vector3d& start, const Eigen::Vector3d& end, double slack,
                   std::vector<std::uint32_t>& found) const {
  if (nodes_[node].isEmpty() || !meets(nodes_[node], start, end, slack)) return;
  if (node >= size()) {
    found.push_back(static_cast<std::uint32_t>(node - size()));
    return;
  }
  find(2 * node, start, end, slack, found);
  find(2 * node + 1, start, end, slack, found);
}

CrossingRays::CrossingRays(std::vector<Eigen::AlignedBox3d> boxes, std::size_t memory)
    : boxes_(boxes), rays_(2 * boxes.size(), memory) {}

void CrossingRays::add(const Context& context, RaySource& source, const NumberRays& numbers) {
  stream(
      context, source, nullptr,
      [&](RayCloud& rays, const RawChunk& raw) {
        struct Met {
          std::uint32_t stream, row;
        };
        const std::vector<std::uint32_t> number = numbers(rays, raw);
        SortedRays sorted;
        sorted.ends.resize(rays_.streams() + 1);
        std::vector<Met> all;
        std::vector<std::uint32_t> found;
        for (std::uint32_t row = 0; row < rays.size(); ++row) {
          boxes_.near_line(rays.starts[row], rays.ends[row], found);
          for (const std::uint32_t part : found) {
            const bool ends_here = rays.bounded[row] != 0 && boxes_.box(part).contains(rays.ends[row]);
            const std::uint32_t stream = 2 * part + (ends_here ? 0 : 1);
            all.push_back({stream, row});
            ++sorted.ends[stream + 1];
          }
        }
        for (std::size_t i = 1; i < sorted.ends.size(); ++i)
          sorted.ends[i] += sorted.ends[i - 1];
        sorted.rays.resize(all.size());
        for (const Met& met : all) {
          const std::uint32_t i = met.row;
          sorted.rays[sorted.ends[met.stream]++] = {rays.starts[i], rays.ends[i], rays.times[i], number[i],
                                                    rays.bounded[i]};
        }
        return sorted;
      },
      [&](const RayCloud&, const SortedRays& sorted) {
        // Each end has moved on to where the next stream begins.
        std::size_t begin = 0;
        for (std::size_t i = 0; i < rays_.streams(); ++i) {
          const std::size_t end = sorted.ends[i];
          if (end > begin) rays_.append(i, std::span(sorted.rays).subspan(begin, end - begin));
          begin = end;
        }
      });
  source.rewind();
}

std::unique_ptr<RaySource> CrossingRays::crossing(std::size_t part) {
  return std::make_unique<SpilledRaySource>(rays_, 2 * part, 2);
}

std::unique_ptr<RaySource> CrossingRays::ending(std::size_t part) {
  return std::make_unique<SpilledRaySource>(rays_, 2 * part, 1);
}

std::span<const std::uint32_t> numbers_of(const RayCloud& rays) {
  return rays.extra(kNumberColumn.name)->values<std::uint32_t>();
}

}  // namespace ray
