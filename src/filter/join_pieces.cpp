#include "ray_pieces.h"

#include <raycloud/core/error.h>
#include <raycloud/filter/combine.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace ray {
namespace {

constexpr double kTolerance = 2e-3;  // m; LAS files round cuts to their step
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

struct Piece {
  Eigen::Vector3d start;
  Eigen::Vector3d end;
  double time = 0.0;
  std::uint8_t flags = 0;
};

std::vector<Piece> read_pieces(const Context& context, RaySource& source) {
  std::vector<Piece> pieces;
  stream(
      context, source, nullptr,
      [](const RayCloud& rays) {
        std::vector<Piece> found;
        const auto flags = rays.extra("clipped")->values<std::uint8_t>();
        for (std::size_t i = 0; i < flags.size(); ++i) {
          if (flags[i] != 0) found.push_back({rays.starts[i], rays.ends[i], rays.times[i], flags[i]});
        }
        return found;
      },
      [&](const RayCloud&, const std::vector<Piece>& found) {
        pieces.insert(pieces.end(), found.begin(), found.end());
      });
  return pieces;
}

/// Where and when a ray was cut, to some millimetres.
class CutPlace {
 public:
  CutPlace(const Eigen::Vector3d& point, double time) : point_(point), time_(time) {}
  [[nodiscard]] std::uint64_t hash() const { return hash_of(cell(point_)); }
  /// The hashes of all places within the tolerance.
  [[nodiscard]] std::vector<std::uint64_t> near() const {
    std::vector<std::uint64_t> hashes;
    for (unsigned corner = 0; corner < 8; ++corner) {
      Eigen::Vector3d point = point_;
      for (int axis = 0; axis < 3; ++axis)
        point[axis] += (corner >> axis & 1) != 0 ? kTolerance : -kTolerance;
      hashes.push_back(hash_of(cell(point)));
    }
    std::sort(hashes.begin(), hashes.end());
    hashes.erase(std::unique(hashes.begin(), hashes.end()), hashes.end());
    return hashes;
  }

 private:
  /// Wider than twice the tolerance, so that the corners are in all cells that are near.
  static Eigen::Vector3d cell(const Eigen::Vector3d& point) {
    return (point / (8.0 * kTolerance)).array().floor();
  }
  [[nodiscard]] std::uint64_t hash_of(const Eigen::Vector3d& cell) const {
    std::uint64_t hash = 0;
    // + 0.0 makes one zero of the two.
    for (const double value : {time_ + 0.0, cell.x() + 0.0, cell.y() + 0.0, cell.z() + 0.0}) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    return hash;
  }

  Eigen::Vector3d point_;
  double time_;
};

/// How far the two are from being one straight ray; infinite if they are not.
double misfit(const Piece& first, const Piece& second) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (first.time != second.time) return kInfinity;
  const double gap = (second.start - first.end).norm();
  const Eigen::Vector3d whole = second.end - first.start;
  const double squared = whole.squaredNorm();
  const double t = squared > 0.0 ? (first.end - first.start).dot(whole) / squared : 0.0;
  const double bend = (first.start + std::clamp(t, 0.0, 1.0) * whole - first.end).norm();
  return gap <= kTolerance && bend <= kTolerance ? gap + bend : kInfinity;
}

struct Pair {
  double misfit = 0.0;
  std::size_t first = 0;
  std::size_t second = 0;
  auto operator<=>(const Pair&) const = default;
};

/// A hash of the place where a piece ends, and the number of the piece.
using HashedEnd = std::pair<std::uint64_t, std::size_t>;

/// Adds the pairs in which `second` is the second.
void add_pairs(const std::vector<Piece>& pieces, const std::vector<HashedEnd>& ends, std::size_t second,
               std::vector<Pair>& pairs) {
  if ((pieces[second].flags & kStartCut) == 0) return;
  for (const std::uint64_t hash : CutPlace(pieces[second].start, pieces[second].time).near()) {
    auto at = std::lower_bound(ends.begin(), ends.end(), HashedEnd(hash, 0));
    for (; at != ends.end() && at->first == hash; ++at) {
      const double fit = misfit(pieces[at->second], pieces[second]);
      if (at->second != second && std::isfinite(fit)) pairs.push_back({fit, at->second, second});
    }
  }
}

/// All that might follow each other, the best first.
std::vector<Pair> possible_pairs(const Context& context, const std::vector<Piece>& pieces) {
  std::vector<HashedEnd> ends;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if ((pieces[i].flags & kEndCut) != 0)
      ends.emplace_back(CutPlace(pieces[i].end, pieces[i].time).hash(), i);
  }
  parallel_sort(context, ends.begin(), ends.end());
  const auto pairs_with = [&](std::size_t begin, std::size_t end) {
    std::vector<Pair> found;
    for (std::size_t second = begin; second < end; ++second)
      add_pairs(pieces, ends, second, found);
    return found;
  };
  auto pairs = parallel_reduce(context, pieces.size(), 1 << 14, std::vector<Pair>{}, pairs_with,
                               [](std::vector<Pair> all, std::vector<Pair> more) {
                                 all.insert(all.end(), more.begin(), more.end());
                                 return all;
                               });
  parallel_sort(context, pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

/// What becomes of each piece, in the order of the source.
class JoinPlan {
 public:
  enum class Fate : std::uint8_t { kept, dropped, joined };
  struct Entry {
    Fate fate = Fate::kept;
    std::uint8_t flags = 0;
    Eigen::Vector3d start = Eigen::Vector3d::Zero();  ///< of a joined ray
  };

  JoinPlan(const std::vector<Piece>& pieces, const std::vector<Pair>& pairs) : entries(pieces.size()) {
    std::vector<std::size_t> next(pieces.size(), kNone), previous(pieces.size(), kNone);
    for (const Pair& pair : pairs) {
      if (next[pair.first] != kNone || previous[pair.second] != kNone) continue;
      next[pair.first] = pair.second;
      previous[pair.second] = pair.first;
    }
    for (std::size_t i = 0; i < pieces.size(); ++i)
      entries[i].flags = pieces[i].flags;
    for (std::size_t first = 0; first < pieces.size(); ++first) {
      if (previous[first] != kNone || next[first] == kNone) continue;
      std::size_t last = first;
      for (; next[last] != kNone; last = next[last])
        entries[last].fate = Fate::dropped;
      const auto flags =
          static_cast<std::uint8_t>((pieces[first].flags & kStartCut) | (pieces[last].flags & kEndCut));
      entries[last] = {Fate::joined, flags, pieces[first].start};
      ++joined;
    }
    left = static_cast<std::uint64_t>(std::count_if(entries.begin(), entries.end(), [](const Entry& entry) {
      return entry.fate != Fate::dropped && entry.flags != 0;
    }));
  }

  std::vector<Entry> entries;
  std::uint64_t joined = 0;
  std::uint64_t left = 0;
};

std::shared_ptr<const JoinPlan> plan_join(const Context& context, RaySource& source) {
  const std::vector<ColumnInfo>& extras = source.info().extras;
  const bool marked =
      std::find(extras.begin(), extras.end(), ColumnInfo{"clipped", ScalarType::uint8}) != extras.end();
  if (!marked) {
    throw Error(ErrorCode::no_data,
                "there is nothing to join: no cloud has the column clipped (uint8), which raysplit writes");
  }
  const std::vector<Piece> pieces = read_pieces(context, source);
  return std::make_shared<const JoinPlan>(pieces, possible_pairs(context, pieces));
}

std::vector<ColumnInfo> join_columns(const JoinPlan& plan, std::vector<ColumnInfo> source) {
  if (plan.left == 0) {
    std::erase_if(source, [](const ColumnInfo& column) { return column.name == "clipped"; });
  }
  return source;
}

JoinCounts join_pieces(const Context& context, RaySource& source, RaySink& sink, const JoinPlan& plan) {
  JoinCounts counts{.joined = plan.joined, .left = plan.left};
  std::size_t next = 0;
  const auto rejoin = [&](RayCloud& rays) {
    const auto flags = rays.extra("clipped")->values<std::uint8_t>();
    std::vector<std::uint8_t> kept(rays.size(), 1);
    for (std::size_t i = 0; i < flags.size(); ++i) {
      if (flags[i] == 0) continue;
      const JoinPlan::Entry& entry = plan.entries[next++];
      flags[i] = entry.flags;
      kept[i] = entry.fate == JoinPlan::Fate::dropped ? 0 : 1;
      if (entry.fate == JoinPlan::Fate::joined) rays.starts[i] = entry.start;
    }
    rays.select(kept);
    if (plan.left == 0) {
      std::erase_if(rays.extras, [](const Column& column) { return column.name() == "clipped"; });
    }
  };
  counts.stream = stream(
      context, source, &sink, [](const RayCloud&) { return Nothing{}; },
      [&](RayCloud& rays, Nothing) { rejoin(rays); });
  return counts;
}

}  // namespace ray
