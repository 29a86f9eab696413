#include "same_rays.h"

#include <raycloud/core/error.h>
#include <raycloud/volume/three_way.h>

#include <algorithm>

namespace ray {
namespace {

/// The rays of a cloud whose numbers are marked, with some of its columns.
class MarkedRays final : public RaySource {
 public:
  MarkedRays(RaySource& cloud, std::uint64_t first, const std::vector<bool>& marked,
             const std::vector<std::string>& columns, std::uint64_t count)
      : cloud_(cloud), first_(first), marked_(marked), columns_(columns), info_(cloud.info()) {
    std::erase_if(info_.extras, [&](const ColumnInfo& column) { return !wants(column.name); });
    info_.ray_count = count;
  }

  [[nodiscard]] const CloudInfo& info() const override { return info_; }
  [[nodiscard]] bool fetch(RawChunk& raw) override { return cloud_.fetch(raw); }
  std::size_t decode(const RawChunk& raw, RayCloud& rays) const override {
    const std::size_t dropped = cloud_.decode(raw, rays);
    std::vector<std::uint32_t> rows;
    for (std::uint32_t row = 0; row < rays.size(); ++row)
      if (marked_[first_ + raw.first_row + row]) rows.push_back(row);
    rays.keep_rows(rows);
    std::erase_if(rays.extras, [&](const Column& column) { return !wants(column.name()); });
    return dropped;
  }
  void rewind() override { cloud_.rewind(); }

 private:
  [[nodiscard]] bool wants(const std::string& name) const {
    return std::find(columns_.begin(), columns_.end(), name) != columns_.end();
  }

  RaySource& cloud_;
  std::uint64_t first_;
  const std::vector<bool>& marked_;
  const std::vector<std::string>& columns_;
  CloudInfo info_;
};

bool has_column(const std::vector<ColumnInfo>& schema, const std::string& name) {
  return std::any_of(schema.begin(), schema.end(),
                     [&](const ColumnInfo& column) { return column.name == name; });
}

/// The first column that `schema` has and none of the others.
const ColumnInfo* column_of_its_own(const std::vector<ColumnInfo>& schema,
                                    const std::vector<ColumnInfo>& base,
                                    const std::vector<ColumnInfo>& other) {
  const auto own = std::find_if(schema.begin(), schema.end(), [&](const ColumnInfo& column) {
    return !has_column(base, column.name) && !has_column(other, column.name);
  });
  return own == schema.end() ? nullptr : &*own;
}

}  // namespace

ThreeWayColumns three_way_columns(const ThreeSchemas& schemas) {
  const auto& [base, one, two] = schemas;
  const ColumnInfo* of_one = column_of_its_own(one, base, two);
  const ColumnInfo* of_two = column_of_its_own(two, base, one);
  if (of_one != nullptr && of_two != nullptr)
    throw Error(ErrorCode::wrong_content, "one cloud has added the column " + of_one->name +
                                              " and the other " + of_two->name +
                                              ": give both columns to one of them");
  ThreeWayColumns columns;
  for (const ColumnInfo& column : base)
    if (has_column(one, column.name) && has_column(two, column.name)) columns.compared.push_back(column.name);
  columns.result = columns.compared;
  for (const std::vector<ColumnInfo>* branch : {&one, &two})
    for (const ColumnInfo& column : *branch) {
      const bool known =
          std::find(columns.result.begin(), columns.result.end(), column.name) != columns.result.end();
      if (known || has_column(base, column.name)) continue;
      columns.result.push_back(column.name);
      columns.kept_from = of_two != nullptr ? 2 : 1;
    }
  return columns;
}

ThreeWay::ThreeWay(const Context& context, const ThreeClouds& clouds, ThreeWayColumns columns)
    : clouds_(clouds), columns_(std::move(columns)) {
  NumberedRays numbered(context, clouds, key_rule(clouds, columns_.compared));
  for (const NumberedCloud& cloud : numbered.clouds())
    first_.push_back(cloud.first);
  first_.push_back(numbered.numbers());
  counts_.rays = numbered.rays();
  kept_.resize(first_.back());
  added_.resize(first_.back());
  numbered.each_group(context, [&](std::span<const NumberedRay> same) {
    // In order of their numbers: copies in the base, in cloud 1, in cloud 2.
    std::array<std::span<const NumberedRay>, 3> copies;
    for (std::size_t cloud = 0, begin = 0; cloud < copies.size(); ++cloud) {
      std::size_t end = begin;
      while (end < same.size() && same[end].number < first_[cloud + 1])
        ++end;
      copies[cloud] = same.subspan(begin, end - begin);
      begin = end;
    }
    const std::size_t in_base = copies[0].size();
    const std::size_t in_all = std::min({in_base, copies[1].size(), copies[2].size()});
    for (const NumberedRay& ray : copies[columns_.kept_from].first(in_all))
      kept_[ray.number] = true;
    counts_.base += in_base;
    counts_.kept += in_all;
    for (std::size_t branch = 0; branch < 2; ++branch) {
      const auto& of_branch = copies[branch + 1];
      if (of_branch.size() <= in_base) continue;
      for (const NumberedRay& ray : of_branch.subspan(in_base))
        added_[ray.number] = true;
      counts_.added[branch] += of_branch.size() - in_base;
    }
  });
}

std::unique_ptr<RaySource> ThreeWay::kept() const {
  return std::make_unique<MarkedRays>(*clouds_[columns_.kept_from], first_[columns_.kept_from], kept_,
                                      columns_.result, counts_.kept);
}

std::unique_ptr<RaySource> ThreeWay::added(std::size_t branch) const {
  return std::make_unique<MarkedRays>(*clouds_[branch + 1], first_[branch + 1], added_, columns_.result,
                                      counts_.added[branch]);
}

}  // namespace ray
