#include "ray_pairs.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/parallel.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <sstream>
#include <unordered_map>

namespace ray {
namespace {

using Rows = std::vector<std::uint32_t>;

/// Rays of one time that are still without a partner.
struct Tie {
  Rows original;
  Rows edited;
  [[nodiscard]] bool is_open() const { return !original.empty() && !edited.empty(); }
};

std::uint64_t mix(std::uint64_t hash, const void* bytes, std::size_t size) {
  const auto* at = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < size; i++)
    hash = (hash ^ at[i]) * 0x100000001b3U;  // FNV-1a (Fowler, Noll and Vo 1991)
  return hash;
}
constexpr std::uint64_t kEmpty = 0xcbf29ce484222325U;

class Pairing {
 public:
  Pairing(const RayCloud& original, const RayCloud& edited)
      : a_(original), b_(edited), shared_(shared_extras(original, edited)) {}

  void by_time(const Context& context);
  /// In ties, by the hash of what must be the same.
  void by_place_and_values() { by_hash(&Pairing::hash_all); }
  void by_place() { by_hash(&Pairing::hash_place); }
  void by_motion(const Context& context, std::optional<Pose> motion);
  [[nodiscard]] std::optional<Pose> likely_motion(const Context& context) const;
  void by_order_or_distance();

  [[nodiscard]] std::vector<RowPair> take() { return std::move(pairs_); }

 private:
  using Hash = std::uint64_t (Pairing::*)(const RayCloud&, std::uint32_t, bool) const;

  [[nodiscard]] std::uint64_t hash_place(const RayCloud& cloud, std::uint32_t row, bool) const {
    return mix(mix(kEmpty, &cloud.starts[row], 24), &cloud.ends[row], 24);
  }
  [[nodiscard]] std::uint64_t hash_values(const RayCloud& cloud, std::uint32_t row, bool is_original) const {
    std::uint64_t hash = mix(mix(kEmpty, &cloud.colours[row], 4), &cloud.bounded[row], 1);
    for (const auto& [mine, theirs] : shared_) {
      const Column& column = cloud.extras[is_original ? mine : theirs];
      hash = mix(hash, column.data() + row * column.stride(), column.stride());
    }
    return hash;
  }
  [[nodiscard]] std::uint64_t hash_all(const RayCloud& cloud, std::uint32_t row, bool is_original) const {
    return hash_place(cloud, row, is_original) * 31 + hash_values(cloud, row, is_original);
  }
  void by_hash(Hash hash);
  void close(Tie& tie, const std::vector<RowPair>& pairs);
  [[nodiscard]] bool moved(const RowPair& pair) const {
    return a_.starts[pair.from] != b_.starts[pair.to] || a_.ends[pair.from] != b_.ends[pair.to];
  }
  [[nodiscard]] std::vector<RowPair> alike_in_length() const;
  [[nodiscard]] std::vector<RowPair> where(const Tie& tie, const Pose& pose) const;
  [[nodiscard]] std::vector<RowPair> nearest(const Tie& tie) const;

  const RayCloud& a_;
  const RayCloud& b_;
  std::vector<std::pair<std::size_t, std::size_t>> shared_;
  std::vector<RowPair> pairs_;
  std::vector<Tie> ties_;
};

/// Row numbers in order of time; rows of one time in their own order.
Rows in_order_of_time(const Context& context, const std::vector<double>& times) {
  Rows rows(times.size());
  std::iota(rows.begin(), rows.end(), 0U);
  if (!std::is_sorted(times.begin(), times.end())) {
    parallel_sort(context, rows.begin(), rows.end(),
                  [&](std::uint32_t i, std::uint32_t j) { return times[i] < times[j]; });
  }
  return rows;
}

void Pairing::by_time(const Context& context) {
  const Rows a = in_order_of_time(context, a_.times), b = in_order_of_time(context, b_.times);
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const double time = std::min(a_.times[a[i]], b_.times[b[j]]);
    std::size_t i_end = i, j_end = j;
    while (i_end < a.size() && a_.times[a[i_end]] == time)
      i_end++;
    while (j_end < b.size() && b_.times[b[j_end]] == time)
      j_end++;
    if (i_end - i == 1 && j_end - j == 1) {
      pairs_.push_back({a[i], b[j]});
    } else if (i < i_end && j < j_end) {
      const auto part = [](const Rows& rows, std::size_t begin, std::size_t end) {
        return Rows(rows.begin() + static_cast<std::ptrdiff_t>(begin),
                    rows.begin() + static_cast<std::ptrdiff_t>(end));
      };
      ties_.push_back({part(a, i, i_end), part(b, j, j_end)});
    }
    i = i_end;
    j = j_end;
  }
}

/// Takes the pairs, and their rows out of the tie.
void Pairing::close(Tie& tie, const std::vector<RowPair>& pairs) {
  Rows from, to;
  for (const RowPair& pair : pairs) {
    from.push_back(pair.from);
    to.push_back(pair.to);
  }
  pairs_.insert(pairs_.end(), pairs.begin(), pairs.end());
  const auto take_out = [](Rows& rows, Rows& taken) {
    std::sort(taken.begin(), taken.end());
    const auto gone = [&](std::uint32_t row) { return std::binary_search(taken.begin(), taken.end(), row); };
    rows.erase(std::remove_if(rows.begin(), rows.end(), gone), rows.end());
  };
  take_out(tie.original, from);
  take_out(tie.edited, to);
}

void Pairing::by_hash(Hash hash) {
  using Hashed = std::vector<std::pair<std::uint64_t, std::uint32_t>>;
  const auto sorted = [&](const RayCloud& cloud, const Rows& rows, bool is_original) {
    Hashed hashed;
    for (const std::uint32_t row : rows)
      hashed.emplace_back((this->*hash)(cloud, row, is_original), row);
    std::sort(hashed.begin(), hashed.end());
    return hashed;
  };
  for (Tie& tie : ties_) {
    if (!tie.is_open()) continue;
    const Hashed a = sorted(a_, tie.original, true), b = sorted(b_, tie.edited, false);
    std::vector<RowPair> pairs;
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
      if (a[i].first == b[j].first) {
        if (!moved({a[i].second, b[j].second})) pairs.push_back({a[i].second, b[j].second});
        i++, j++;
      } else {
        a[i].first < b[j].first ? i++ : j++;
      }
    }
    close(tie, pairs);
    if (tie.original.size() == 1 && tie.edited.size() == 1 && hash == &Pairing::hash_place) {
      close(tie, {{tie.original[0], tie.edited[0]}});
    }
  }
}

/// Rays of open ties that have the same values, and a length that no other has: a motion keeps both.
std::vector<RowPair> Pairing::alike_in_length() const {
  constexpr double kSame = 5e-4;  // m; single precision included
  struct Ray {
    std::uint64_t values;
    double length;
    std::uint32_t row;
    bool is_original;
  };
  std::vector<RowPair> pairs;
  for (const Tie& tie : ties_) {
    if (!tie.is_open()) continue;
    std::vector<Ray> rays;
    for (const std::uint32_t row : tie.original)
      rays.push_back({hash_values(a_, row, true), (a_.ends[row] - a_.starts[row]).norm(), row, true});
    for (const std::uint32_t row : tie.edited)
      rays.push_back({hash_values(b_, row, false), (b_.ends[row] - b_.starts[row]).norm(), row, false});
    std::stable_sort(rays.begin(), rays.end(), [](const Ray& x, const Ray& y) {
      return x.values != y.values ? x.values < y.values : x.length < y.length;
    });
    const auto alike = [&](std::size_t i, std::size_t j) {
      return j < rays.size() && rays[i].values == rays[j].values && rays[j].length - rays[i].length <= kSame;
    };
    for (std::size_t i = 0; i + 1 < rays.size(); i++) {
      const bool alone = alike(i, i + 1) && !alike(i + 1, i + 2) && (i == 0 || !alike(i - 1, i));
      if (!alone || rays[i].is_original == rays[i + 1].is_original) continue;
      const std::size_t original = rays[i].is_original ? i : i + 1;
      pairs.push_back({rays[original].row, rays[i + i + 1 - original].row});
    }
  }
  return pairs;
}

constexpr double kTolerance = 0.01;  // m

/// The pairs of the tie that fit the motion.
std::vector<RowPair> Pairing::where(const Tie& tie, const Pose& pose) const {
  const auto cell = [](const Eigen::Vector3d& p, int x, int y, int z) {
    const double q[] = {std::floor(p.x() / kTolerance) + x, std::floor(p.y() / kTolerance) + y,
                        std::floor(p.z() / kTolerance) + z};
    return mix(kEmpty, q, sizeof q);
  };
  std::unordered_multimap<std::uint64_t, std::uint32_t> at;
  for (const std::uint32_t row : tie.edited)
    at.emplace(cell(b_.ends[row], 0, 0, 0), row);
  std::vector<RowPair> pairs;
  for (const std::uint32_t row : tie.original) {
    const Eigen::Vector3d start = pose * a_.starts[row], end = pose * a_.ends[row];
    const std::uint64_t values = hash_values(a_, row, true);
    auto best = at.end();
    double least = 2.0 * kTolerance;
    for (int n = 0; n < 27; n++) {
      const auto [first, last] = at.equal_range(cell(end, n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
      for (auto it = first; it != last; ++it) {
        const std::uint32_t other = it->second;
        const double miss = std::max((b_.ends[other] - end).norm(), (b_.starts[other] - start).norm());
        if (miss > kTolerance) continue;
        // Of rays in one place, one with the same values; of those, the first.
        const double cost = miss + (hash_values(b_, other, false) == values ? 0.0 : 1e-4);
        if (cost < least || (cost == least && best != at.end() && other < best->second)) {
          best = it;
          least = cost;
        }
      }
    }
    if (best == at.end()) continue;
    pairs.push_back({row, best->second});
    at.erase(best);
  }
  return pairs;
}

/// That of the rays which are certain, or have no other like them.
std::optional<Pose> Pairing::likely_motion(const Context& context) const {
  std::vector<RowPair> certain = alike_in_length();
  for (const RowPair& pair : pairs_) {
    if (moved(pair)) certain.push_back(pair);
  }
  const auto fit_certain = [&] { return fit_rigid(context, lines_of(a_), lines_of(b_), certain); };
  RigidFit fit = fit_certain();
  // Rays that were removed and added can look alike: leave out what does not fit the rest.
  for (int round = 0; round < 20 && fit.worst > kTolerance && certain.size() > 2; round++) {
    const double limit = std::max(1.5 * fit.rms, 0.5 * kTolerance);
    const auto misses = [&](const RowPair& pair) {
      return (b_.starts[pair.to] - fit.pose * a_.starts[pair.from]).norm() > limit ||
             (b_.ends[pair.to] - fit.pose * a_.ends[pair.from]).norm() > limit;
    };
    certain.erase(std::remove_if(certain.begin(), certain.end(), misses), certain.end());
    fit = fit_certain();
  }
  if (certain.empty() || fit.worst > kTolerance) return {};
  return fit.pose;
}

void Pairing::by_motion(const Context& context, std::optional<Pose> motion) {
  if (std::none_of(ties_.begin(), ties_.end(), [](const Tie& tie) { return tie.is_open(); })) return;
  if (!motion) motion = likely_motion(context);
  if (!motion) return;
  for (Tie& tie : ties_) {
    if (tie.is_open()) close(tie, where(tie, *motion));
  }
}

/// Pairs of a small tie, the closest first.
std::vector<RowPair> Pairing::nearest(const Tie& tie) const {
  struct Candidate {
    double distance;
    RowPair pair;
  };
  std::vector<Candidate> candidates;
  for (const std::uint32_t from : tie.original) {
    for (const std::uint32_t to : tie.edited) {
      candidates.push_back(
          {(a_.ends[from] - b_.ends[to]).norm() + (a_.starts[from] - b_.starts[to]).norm(), {from, to}});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& x, const Candidate& y) { return x.distance < y.distance; });
  std::vector<RowPair> pairs;
  for (const Candidate& candidate : candidates) {
    const auto taken = [&](const RowPair& pair) {
      return pair.from == candidate.pair.from || pair.to == candidate.pair.to;
    };
    if (std::none_of(pairs.begin(), pairs.end(), taken)) pairs.push_back(candidate.pair);
  }
  return pairs;
}

void Pairing::by_order_or_distance() {
  constexpr std::size_t kSmall = 64;
  for (Tie& tie : ties_) {
    if (!tie.is_open()) continue;
    if (tie.original.size() == tie.edited.size()) {
      std::vector<RowPair> pairs;
      for (std::size_t i = 0; i < tie.original.size(); i++)
        pairs.push_back({tie.original[i], tie.edited[i]});
      close(tie, pairs);
    } else if (std::max(tie.original.size(), tie.edited.size()) <= kSmall) {
      close(tie, nearest(tie));
    } else {
      std::ostringstream text;
      text.precision(16);
      text << tie.original.size() << " rays of the time " << a_.times[tie.original[0]] << " became "
           << tie.edited.size() << " and were moved: nothing tells which is which";
      throw Error(ErrorCode::wrong_content, text.str());
    }
  }
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> shared_extras(const RayCloud& original,
                                                               const RayCloud& edited) {
  std::vector<std::pair<std::size_t, std::size_t>> shared;
  for (std::size_t i = 0; i < original.extras.size(); i++) {
    const Column& mine = original.extras[i];
    const Column* theirs = edited.extra(mine.name());
    if (theirs == nullptr) continue;
    if (theirs->type() != mine.type()) {
      throw Error(ErrorCode::wrong_content,
                  "column " + mine.name() + " is " + std::string(name_of(mine.type())) +
                      " in the full cloud and " + std::string(name_of(theirs->type())) +
                      " in the decimated one");
    }
    shared.emplace_back(i, static_cast<std::size_t>(theirs - edited.extras.data()));
  }
  return shared;
}

std::vector<RowPair> pair_rays(const Context& context, const RayCloud& original, const RayCloud& edited,
                               const std::optional<Pose>& motion) {
  Pairing pairing(original, edited);
  pairing.by_time(context);
  pairing.by_place_and_values();
  pairing.by_place();
  pairing.by_motion(context, motion);
  pairing.by_order_or_distance();
  return pairing.take();
}

}  // namespace ray
