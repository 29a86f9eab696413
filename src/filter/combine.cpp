#include "united_info.h"

#include <raycloud/core/error.h>
#include <raycloud/filter/combine.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <optional>
#include <utility>

namespace ray {

struct CombinedSource::Member {
  CloudToCombine cloud;
  std::vector<ColumnInfo> extras;
  Precision precision;
  std::optional<std::uint64_t> ray_count;
  std::unique_ptr<RaySource> source;        ///< while it is open
  mutable std::atomic<std::size_t> coming;  ///< chunks fetched and not yet decoded

  [[nodiscard]] std::unique_ptr<RaySource> open() const {
    std::unique_ptr<RaySource> opened = cloud.open();
    if (opened->info().extras != extras)
      throw Error(ErrorCode::file_format, cloud.name + ": changed while it was being read");
    return opened;
  }
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

class CombinedSource::Alone final : public RaySource {
 public:
  Alone(const CombinedSource& all, const Member& member) : all_(all), member_(member), info_(all.info_) {
    info_.precision = member.precision;
    info_.ray_count = member.ray_count;
  }

  [[nodiscard]] const CloudInfo& info() const override { return info_; }
  [[nodiscard]] bool fetch(RawChunk& raw) override {
    if (source_ == nullptr) source_ = member_.open();
    return source_->fetch(raw);
  }
  std::size_t decode(const RawChunk& raw, RayCloud& rays) const override {
    const std::size_t dropped = source_->decode(raw, rays);
    all_.unite_columns(member_, rays);
    return dropped;
  }
  void rewind() override { source_.reset(); }

 private:
  const CombinedSource& all_;
  const Member& member_;
  CloudInfo info_;
  std::unique_ptr<RaySource> source_;
};

CombinedSource::CombinedSource(std::vector<CloudToCombine> clouds) {
  if (clouds.empty()) throw Error(ErrorCode::usage, "there is no cloud to combine");
  std::vector<NamedInfo> infos;
  for (CloudToCombine& cloud : clouds) {
    infos.push_back({cloud.name, cloud.open()->info()});
    auto member = std::make_unique<Member>();
    member->cloud = std::move(cloud);
    member->extras = infos.back().info.extras;
    member->precision = infos.back().info.precision;
    member->ray_count = infos.back().info.ray_count;
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
  if (member.source == nullptr) member.source = member.open();
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
  unite_columns(member, rays);
  return dropped;
}

void CombinedSource::unite_columns(const Member& member, RayCloud& rays) const {
  if (member.extras == info_.extras) return;
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
}

void CombinedSource::rewind() {
  for (const auto& member : members_) {
    member->source.reset();
    member->coming = 0;
  }
  current_ = first_open_ = 0;
}

std::unique_ptr<RaySource> CombinedSource::alone(std::size_t cloud) const {
  return std::make_unique<Alone>(*this, *members_[cloud]);
}

}  // namespace ray
