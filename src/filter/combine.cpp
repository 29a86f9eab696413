#include "united_info.h"

#include <raycloud/core/error.h>
#include <raycloud/filter/combine.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

namespace ray {

struct CombinedSource::Member {
  CloudToCombine cloud;
  std::vector<ColumnInfo> extras;
  std::unique_ptr<RaySource> source;        ///< while it is open
  mutable std::atomic<std::size_t> coming;  ///< chunks fetched and not yet decoded
};

namespace {

/// The same values in another type. Exact, as 64-bit integers are never converted (common_type).
Column converted(const Column& from, const ColumnInfo& to) {
  Column column(to, from.size());
  visit_scalar(to.type, [&]<class T>() {
    const std::span<T> values = column.values<T>();
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<T>(from.as_double(i));
  });
  return column;
}

Column filled(const ColumnInfo& info, std::size_t rows) {
  Column column(info, rows);
  visit_scalar(info.type, [&]<class T>() {
    if constexpr (std::is_floating_point_v<T>) {
      const std::span<T> values = column.values<T>();
      std::fill(values.begin(), values.end(), std::numeric_limits<T>::quiet_NaN());
    }
  });
  return column;
}

}  // namespace

CombinedSource::CombinedSource(std::vector<CloudToCombine> clouds) {
  if (clouds.empty()) throw Error(ErrorCode::usage, "there is no cloud to combine");
  std::vector<NamedInfo> infos;
  for (CloudToCombine& cloud : clouds) {
    infos.push_back({cloud.name, cloud.open()->info()});
    auto member = std::make_unique<Member>();
    member->cloud = std::move(cloud);
    member->extras = infos.back().info.extras;
    members_.push_back(std::move(member));
  }
  UnitedInfo united = unite(infos);
  info_ = std::move(united.info);
  notes_ = std::move(united.notes);
  warnings_ = std::move(united.warnings);
}

CombinedSource::~CombinedSource() = default;

bool CombinedSource::fetch(RawChunk& raw) {
  close_finished();
  for (; current_ < members_.size(); ++current_) {
    Member& member = *members_[current_];
    open_current();
    if (member.source->fetch(raw)) {
      raw.source = current_;
      ++member.coming;
      return true;
    }
  }
  return false;
}

void CombinedSource::open_current() {
  Member& member = *members_[current_];
  if (member.source != nullptr) return;
  member.source = member.cloud.open();
  if (member.source->info().extras != member.extras) {
    throw Error(ErrorCode::file_format, member.cloud.name + ": changed while it was being read");
  }
}

void CombinedSource::close_finished() {
  while (first_open_ < current_ && members_[first_open_]->coming == 0) {
    members_[first_open_]->source.reset();
    ++first_open_;
  }
}

std::size_t CombinedSource::decode(const RawChunk& raw, RayCloud& rays) const {
  const Member& member = *members_[raw.source];
  const std::size_t dropped = member.source->decode(raw, rays);
  --member.coming;
  if (member.extras == info_.extras) return dropped;
  std::vector<Column> columns;
  columns.reserve(info_.extras.size());
  for (const ColumnInfo& wanted : info_.extras) {
    Column* own = rays.extra(wanted.name);
    if (own == nullptr) {
      columns.push_back(wanted.name == "clipped" ? Column(wanted, rays.size()) : filled(wanted, rays.size()));
    } else {
      columns.push_back(own->type() == wanted.type ? std::move(*own) : converted(*own, wanted));
    }
  }
  rays.extras = std::move(columns);
  return dropped;
}

void CombinedSource::rewind() {
  for (const auto& member : members_) {
    member->source.reset();
    member->coming = 0;
  }
  current_ = first_open_ = 0;
}

}  // namespace ray
