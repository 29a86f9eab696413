#include "displacements.h"
#include "ray_groups.h"
#include "ray_pairs.h"
#include "ray_pieces.h"
#include "row_bits.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/filter/restore.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <sstream>

namespace ray {
namespace {

constexpr std::uint32_t kNone = RayGroups::kNone;
constexpr double kRigid = 0.01;     // m; moves that differ more are no rigid motion
constexpr double kRounding = 2e-4;  // m; the diagonal of what single precision may cost

/// What was done to the ray of a group; bits.
enum Change : std::uint8_t { kMoved = 1, kRecoloured = 2, kNewIntensity = 4, kRebounded = 8, kRevalued = 16 };

std::string length(double metres) {
  std::ostringstream text;
  text.precision(3);
  if (metres < 0.01)
    text << metres * 1000.0 << " mm";
  else if (metres < 1.0)
    text << metres * 100.0 << " cm";
  else
    text << metres << " m";
  return text.str();
}

[[noreturn]] void refuse_moves(const RigidFit& fit, std::size_t moved) {
  throw Error(ErrorCode::wrong_content,
              "the " + std::to_string(moved) + " moved rays went up to " + length(fit.moved_most) +
                  " but no rigid motion takes them there, the best one misses by up to " + length(fit.worst) +
                  " (rays that were smoothed, bent or cut): --nonrigid moves what is around them along");
}

/// Rows of `cloud`, with the columns of `schema`; zeros in those it lacks.
RayCloud rows_of(const RayCloud& cloud, std::span<const std::uint8_t> mask,
                 const std::vector<ColumnInfo>& schema) {
  RayCloud rows = cloud;
  rows.select(mask);
  RayCloud result;
  result.set_schema(schema);
  std::vector<Column> extras = std::exchange(rows.extras, {});
  for (Column& column : result.extras) {
    column.resize(rows.size());
    for (const Column& mine : extras) {
      if (mine.name() == column.name()) column = mine;
    }
  }
  rows.extras = std::move(result.extras);
  return rows;
}

}  // namespace

/// The kept rays of the full cloud that are elsewhere in the edited one.
struct Moved {
  std::vector<Eigen::Vector3d> starts;  // of the full cloud
  std::vector<Eigen::Vector3d> ends;
  std::vector<std::uint32_t> group;

  [[nodiscard]] Lines lines() const { return {starts, ends}; }
};

struct Restoration::Parts {
  explicit Parts(const Decimation& decimation) : groups(decimation) {}

  // What remains for `apply`.
  RayGroups groups;
  RayCloud edited;
  std::vector<std::uint32_t> partner;                       // of each group, a row of `edited`
  std::vector<std::uint8_t> change;                         // of each group
  std::vector<std::pair<std::size_t, std::size_t>> shared;  // columns
  std::vector<RowBits> revalued;                            // for each of them, by group
  std::vector<std::size_t> new_columns;                     // of `edited`
  std::vector<ColumnInfo> extras;
  RayCloud added;
  EditSummary summary;
  std::optional<Displacements> displacements;

  void edit(RayCloud& rays, std::uint64_t row) const;
  void edit_columns(RayCloud& rays, const std::vector<std::uint32_t>& group) const;
  [[nodiscard]] bool nothing_changed() const {
    return summary.removed + summary.moved + summary.recoloured + summary.rebounded + summary.revalued == 0 &&
           new_columns.empty();
  }

  // What is needed until then.
  Moved moved;
  std::vector<std::uint8_t> is_paired;  // of each row of `edited`
  RayCloud pending;                     // kept rays of the latest time
  std::size_t next = 0;                 // row of `edited` that has not been looked at
  bool in_order = true;                 // of time, both clouds so far: then all rays of a time are together
  double latest = -std::numeric_limits<double>::infinity();
  RayCloud open;  // kept rays without a partner so far
  std::vector<std::uint32_t> open_group;

  void find_columns(const RayCloud& original);
  void see(const RayCloud& kept);
  void settle(const RayCloud& kept, std::size_t begin, std::size_t end);
  void leave_open(const RayCloud& kept, std::size_t row);
  void pair(const RayCloud& kept, std::size_t row, std::uint32_t group, std::uint32_t to);
  void pair_open(const Context& context);
  void find_motion(const Context& context, bool nonrigid);
  void count();
};

namespace {

bool same_place(const RayCloud& a, std::size_t i, const RayCloud& b, std::size_t j) {
  return a.ends[i] == b.ends[j] && a.starts[i] == b.starts[j];
}

}  // namespace

void Restoration::Parts::find_columns(const RayCloud& original) {
  shared = shared_extras(original, edited);
  revalued.resize(shared.size());
  extras = schema_of(original);
  open.set_schema(extras);
  pending.set_schema(extras);
  for (std::size_t c = 0; c < edited.extras.size(); c++) {
    if (original.extra(edited.extras[c].name()) != nullptr) continue;
    new_columns.push_back(c);
    extras.push_back(edited.extras[c].info());
  }
}

/// Both clouds are nearly always in one order, so that most rays find their partners on the way: kept rays
/// of one time against rows of that time. Where times go back, only rays that stayed where they were.
void Restoration::Parts::see(const RayCloud& kept) {
  std::size_t begin = 0;
  const auto end_of_run = [&](double time) {
    std::size_t end = begin;
    while (end < kept.size() && kept.times[end] == time)
      end++;
    return end;
  };
  if (!pending.empty()) {
    const std::size_t end = end_of_run(pending.times[0]);
    append_rows(pending, kept, 0, end);
    if (end == kept.size()) return;
    settle(pending, 0, pending.size());
    pending.resize(0);
    begin = end;
  }
  while (begin < kept.size()) {
    const std::size_t end = end_of_run(kept.times[begin]);
    if (end == kept.size()) return append_rows(pending, kept, begin, end);
    settle(kept, begin, end);
    begin = end;
  }
}

/// Kept rays [begin, end) are of one time. Those that find no partner here can find one later.
void Restoration::Parts::settle(const RayCloud& kept, std::size_t begin, std::size_t end) {
  const double time = kept.times[begin];
  in_order = in_order && time >= latest;
  latest = time;
  while (in_order && next < edited.size() && edited.times[next] < time)
    next++;
  std::size_t last = next;
  while (last < edited.size() && edited.times[last] == time)
    last++;
  constexpr double kSame = 5e-4;  // m
  const auto likely = [&](std::size_t i, std::size_t j) {
    return same_place(kept, i, edited, j) || std::abs((kept.ends[i] - kept.starts[i]).norm() -
                                                      (edited.ends[j] - edited.starts[j]).norm()) < kSame;
  };
  bool all_likely = in_order && last - next == end - begin;
  for (std::size_t i = begin; all_likely && end - begin > 1 && i < end; i++)
    all_likely = likely(i, next + (i - begin));
  for (std::size_t i = begin; i < end; i++) {
    const bool found = next < last && (all_likely || same_place(kept, i, edited, next));
    const auto group = static_cast<std::uint32_t>(partner.size());
    partner.push_back(kNone);
    change.push_back(0);
    if (found) {
      pair(kept, i, group, static_cast<std::uint32_t>(next++));
    } else {
      leave_open(kept, i);
    }
  }
  next = last;
}

void Restoration::Parts::leave_open(const RayCloud& kept, std::size_t row) {
  open_group.push_back(static_cast<std::uint32_t>(partner.size() - 1));
  open.starts.push_back(kept.starts[row]);
  open.ends.push_back(kept.ends[row]);
  open.times.push_back(kept.times[row]);
  open.colours.push_back(kept.colours[row]);
  open.bounded.push_back(kept.bounded[row]);
  for (std::size_t c = 0; c < open.extras.size(); c++) {
    Column& column = open.extras[c];
    column.resize(open.size());
    std::memcpy(column.data() + (open.size() - 1) * column.stride(),
                kept.extras[c].data() + row * column.stride(), column.stride());
  }
}

void Restoration::Parts::pair(const RayCloud& kept, std::size_t row, std::uint32_t group, std::uint32_t to) {
  partner[group] = to;
  is_paired[to] = 1;
  if (!same_place(kept, row, edited, to)) {
    moved.starts.push_back(kept.starts[row]);
    moved.ends.push_back(kept.ends[row]);
    moved.group.push_back(group);
  }
  const Colour &was = kept.colours[row], &now = edited.colours[to];
  std::uint8_t& what = change[group];
  if (was.red != now.red || was.green != now.green || was.blue != now.blue) what |= kRecoloured;
  if (was.intensity != now.intensity) what |= kNewIntensity;
  if (kept.bounded[row] != edited.bounded[to]) what |= kRebounded;
  for (std::size_t k = 0; k < shared.size(); k++) {
    const Column &mine = kept.extras[shared[k].first], &theirs = edited.extras[shared[k].second];
    const std::size_t stride = mine.stride();
    if (std::memcmp(mine.data() + row * stride, theirs.data() + to * stride, stride) == 0) continue;
    constexpr std::uint8_t kYes[] = {1};
    revalued[k].set(group, kYes);
    what |= kRevalued;
  }
}

/// Pairs what was not in order.
void Restoration::Parts::pair_open(const Context& context) {
  if (!pending.empty()) settle(pending, 0, pending.size());
  std::vector<std::uint8_t> mask(edited.size());
  std::vector<std::uint32_t> rows;
  for (std::size_t row = 0; row < edited.size(); row++) {
    mask[row] = is_paired[row] == 0 ? 1 : 0;
    if (mask[row] != 0) rows.push_back(static_cast<std::uint32_t>(row));
  }
  if (rows.empty()) return;
  if (!open.empty()) {
    RayCloud unpaired = edited;
    unpaired.select(mask);
    std::vector<RowPair> certain;
    for (std::size_t m = 0; m < moved.group.size(); m++)
      certain.push_back({static_cast<std::uint32_t>(m), partner[moved.group[m]]});
    const RigidFit fit = fit_rigid(context, moved.lines(), lines_of(edited), certain);
    const bool is_known = certain.size() > 2 && fit.explains(kRigid);
    for (const RowPair& found :
         pair_rays(context, open, unpaired, is_known ? std::optional<Pose>(fit.pose) : std::nullopt)) {
      pair(open, found.from, open_group[found.from], rows[found.to]);
      mask[rows[found.to]] = 0;
    }
  }
  added = rows_of(edited, mask, extras);
}

void Restoration::Parts::find_motion(const Context& context, bool nonrigid) {
  if (moved.group.empty()) return;
  std::vector<RowPair> pairs;
  for (std::size_t m = 0; m < moved.group.size(); m++)
    pairs.push_back({static_cast<std::uint32_t>(m), partner[moved.group[m]]});
  RigidFit fit = fit_rigid(context, moved.lines(), lines_of(edited), pairs);
  summary.worst = {fit.worst};
  const bool is_rigid = fit.explains(kRigid);
  if (!is_rigid && fit.moved_most <= kRounding) return;  // saved with fewer digits
  if (!is_rigid && !nonrigid) refuse_moves(fit, pairs.size());
  if (fit.rms <= 0.5 * fit.moved_rms) summary.pose = fit.pose;
  for (const std::uint32_t group : moved.group)
    change[group] |= kMoved;
  if (is_rigid) {
    // Rays on the axis of a rotation went nowhere; those around them did.
    const double tolerance = std::max(2.0 * fit.worst, 1e-6);
    std::vector<std::uint32_t> unmoved;
    for (std::uint32_t group = 0; group < partner.size(); group++) {
      if (partner[group] == kNone || (change[group] & kMoved) != 0) continue;
      const Eigen::Vector3d &start = edited.starts[partner[group]], &end = edited.ends[partner[group]];
      if ((fit.pose * start - start).norm() > tolerance || (fit.pose * end - end).norm() > tolerance) return;
      unmoved.push_back(group);
    }
    for (const std::uint32_t group : unmoved)
      change[group] |= kMoved;
    return;
  }
  summary.nonrigid = true;
  displacements.emplace(partner.size(), summary.pose);
  for (std::uint32_t group = 0; group < partner.size(); group++) {
    if (partner[group] != kNone) {
      displacements->set(group, lines_of(edited), partner[group], lines_of(edited), partner[group]);
    }
  }
  for (const RowPair& pair : pairs)
    displacements->set(moved.group[pair.from], moved.lines(), pair.from, lines_of(edited), pair.to);
}

void Restoration::Parts::count() {
  for (std::size_t group = 0; group < partner.size(); group++) {
    const auto did = [&](int what) { return (change[group] & what) != 0 ? 1U : 0U; };
    partner[group] == kNone ? summary.removed++ : summary.kept++;
    summary.moved += did(kMoved);
    summary.recoloured += did(kRecoloured | kNewIntensity);
    summary.rebounded += did(kRebounded);
    summary.revalued += did(kRevalued);
  }
  summary.added = added.size();
}

void Restoration::Parts::edit_columns(RayCloud& rays, const std::vector<std::uint32_t>& group) const {
  const auto copy = [&](Column& column, std::size_t i, const Column& from) {
    const std::size_t stride = column.stride();
    std::memcpy(column.data() + i * stride, from.data() + partner[group[i]] * stride, stride);
  };
  for (std::size_t k = 0; summary.revalued > 0 && k < shared.size(); k++) {
    for (std::size_t i = 0; i < rays.size(); i++) {
      if (revalued[k].has(group[i])) copy(rays.extras[shared[k].first], i, edited.extras[shared[k].second]);
    }
  }
  for (const std::size_t c : new_columns) {
    Column& column = rays.extras.emplace_back(edited.extras[c].info(), rays.size());
    for (std::size_t i = 0; i < rays.size(); i++) {
      if (partner[group[i]] != kNone) copy(column, i, edited.extras[c]);
    }
  }
}

void Restoration::Parts::edit(RayCloud& rays, std::uint64_t row) const {
  if (nothing_changed()) return;
  if (summary.removed == partner.size()) {
    rays.resize(0);
    edit_columns(rays, {});
    return;
  }
  const std::vector<std::uint32_t> group = groups.of(rays, row);
  std::vector<std::uint8_t> mask(rays.size());
  if (displacements) displacements->move(rays, groups, group, row);
  for (std::size_t i = 0; i < rays.size(); i++) {
    const std::uint32_t from = partner[group[i]];
    mask[i] = from != kNone ? 1 : 0;
    const std::uint8_t what = change[group[i]];
    if (what == 0) continue;
    if ((what & kMoved) != 0 && !displacements) {
      rays.starts[i] = summary.pose * rays.starts[i];
      rays.ends[i] = summary.pose * rays.ends[i];
    }
    const Colour& colour = edited.colours[from];
    Colour& mine = rays.colours[i];
    if ((what & kRecoloured) != 0) mine = {colour.red, colour.green, colour.blue, mine.intensity};
    if ((what & kNewIntensity) != 0) mine.intensity = colour.intensity;
    if ((what & kRebounded) != 0) rays.bounded[i] = edited.bounded[from];
  }
  edit_columns(rays, group);
  rays.select(mask);
}

namespace {

RayCloud read_reserved(const Context& context, RaySource& source) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 28;  // a header can promise anything
  RayCloud all;
  all.set_schema(source.info().extras);
  all.reserve(std::min(source.info().ray_count.value_or(0), kMost));
  stream(
      context, source, nullptr, [](RayCloud&) { return Nothing{}; },
      [&](const RayCloud& rays, Nothing&) { all.append(rays); });
  return all;
}

}  // namespace

Restoration::Restoration(const Context& context, RaySource& decimated, RaySource& full,
                         const Decimation& decimation, const RestoreOptions& options)
    : parts_(std::make_unique<Parts>(decimation)) {
  Parts& parts = *parts_;
  parts.edited = read_reserved(context, decimated);
  parts.in_order = std::is_sorted(parts.edited.times.begin(), parts.edited.times.end());
  parts.is_paired.resize(parts.edited.size());
  parts.partner.reserve(parts.edited.size());
  parts.change.reserve(parts.edited.size());
  RayCloud no_rays;
  no_rays.set_schema(full.info().extras);
  parts.find_columns(no_rays);
  parts.groups.gather(context, full, [&](const RayCloud& kept) { parts.see(kept); });
  parts.pair_open(context);
  parts.find_motion(context, options.nonrigid);
  parts.count();
  if (parts.summary.kept == 0 && parts.summary.added > 0 && parts.summary.removed > 0) {
    throw Error(
        ErrorCode::wrong_content,
        "no ray of the decimated cloud has the time of a ray that this decimation keeps of the full one: "
        "another cloud, another decimation, or times that were shifted");
  }
  parts.moved = {};
  parts.open = {};
}

Restoration::~Restoration() = default;

const EditSummary& Restoration::edits() const {
  return parts_->summary;
}

const std::vector<ColumnInfo>& Restoration::extras() const {
  return parts_->extras;
}

StreamCounts Restoration::apply(const Context& context, RaySource& full, RaySink& sink) const {
  const Parts& parts = *parts_;
  const bool in_order = parts.groups.by_row();
  full.rewind();
  std::uint64_t row = 0;
  StreamCounts counts = stream(
      context, full, &sink,
      [&](RayCloud& rays) {
        if (!in_order) parts.edit(rays, 0);
        return Nothing{};
      },
      [&](RayCloud& rays, Nothing) {
        if (!in_order) return;
        const std::size_t count = rays.size();
        parts.edit(rays, row);
        row += count;
      });
  if (!parts.added.empty()) {
    MemorySource added(parts.added);
    counts.rays_out += stream_each(context, added, sink, [](RayCloud&) {}).rays_out;
  }
  return counts;
}

}  // namespace ray
