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
  std::vector<std::size_t> ends;  ///< by block
};

/// The rays of one block.
class RaysOfBlock final : public RaySource {
 public:
  RaysOfBlock(SpilledRows<SpilledRay>& rays, std::size_t part) : rays_(rays), part_(part) {
    info_.ray_count = rays.size(part);
    info_.precision = Precision::double_;
    info_.extras = {kNumberColumn};
    rays_.rewind(part_);
  }
  [[nodiscard]] const CloudInfo& info() const override { return info_; }

  [[nodiscard]] bool fetch(RawChunk& raw) override {
    constexpr std::size_t kRays = 32768;
    raw.first_row = next_;
    raw.rows = std::min(kRays, rays_.size(part_) - next_);
    next_ += raw.rows;
    if (raw.rows == 0) return false;
    buffer_.resize(raw.rows);
    rays_.read(part_, buffer_);
    raw.bytes.resize(raw.rows * sizeof(SpilledRay));
    std::memcpy(raw.bytes.data(), static_cast<const void*>(buffer_.data()), raw.bytes.size());
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
    rays_.rewind(part_);
    next_ = 0;
  }

 private:
  SpilledRows<SpilledRay>& rays_;
  std::size_t part_;
  std::size_t next_ = 0;
  std::vector<SpilledRay> buffer_;
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
    : boxes_(boxes), rays_(boxes.size(), memory) {}

void CrossingRays::add(const Context& context, RaySource& source, const NumberRays& numbers) {
  stream(
      context, source, nullptr,
      [&](RayCloud& rays, const RawChunk& raw) {
        struct Met {
          std::uint32_t part, row;
        };
        const std::vector<std::uint32_t> number = numbers(rays, raw);
        SortedRays sorted;
        sorted.ends.resize(boxes_.size() + 1);
        std::vector<Met> all;
        std::vector<std::uint32_t> found;
        for (std::uint32_t row = 0; row < rays.size(); ++row) {
          boxes_.near_line(rays.starts[row], rays.ends[row], found);
          for (const std::uint32_t part : found) {
            all.push_back({part, row});
            ++sorted.ends[part + 1];
          }
        }
        for (std::size_t part = 0; part < boxes_.size(); ++part)
          sorted.ends[part + 1] += sorted.ends[part];
        sorted.rays.resize(all.size());
        for (const Met& met : all) {
          const std::uint32_t i = met.row;
          sorted.rays[sorted.ends[met.part]++] = {rays.starts[i], rays.ends[i], rays.times[i], number[i],
                                                  rays.bounded[i]};
        }
        return sorted;
      },
      [&](const RayCloud&, const SortedRays& sorted) {
        // Each end has moved on to where the next block begins.
        std::size_t begin = 0;
        for (std::size_t part = 0; part < boxes_.size(); ++part) {
          const std::size_t end = sorted.ends[part];
          if (end > begin) rays_.append(part, std::span(sorted.rays).subspan(begin, end - begin));
          begin = end;
        }
      });
  source.rewind();
}

std::unique_ptr<RaySource> CrossingRays::source(std::size_t part) {
  return std::make_unique<RaysOfBlock>(rays_, part);
}

std::span<const std::uint32_t> numbers_of(const RayCloud& rays) {
  return rays.extra(kNumberColumn.name)->values<std::uint32_t>();
}

}  // namespace ray
