#include "united_info.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <utility>

namespace ray {
namespace {

bool is_real(ScalarType type) {
  return type == ScalarType::float32 || type == ScalarType::float64;
}

bool is_signed(ScalarType type) {
  return visit_scalar(type, []<class T>() { return std::is_signed_v<T>; });
}

const ColumnInfo* find(const std::vector<ColumnInfo>& columns, const std::string& name) {
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [&](const ColumnInfo& column) { return column.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

template <class T>
bool contains(const std::vector<T>& list, const T& value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

void unite_columns(std::vector<ColumnInfo>& columns, const NamedInfo& other) {
  for (const ColumnInfo& theirs : other.info.extras) {
    const auto mine = std::find_if(columns.begin(), columns.end(),
                                   [&](const ColumnInfo& column) { return column.name == theirs.name; });
    if (mine == columns.end()) {
      columns.push_back(theirs);
      continue;
    }
    const auto type = common_type(mine->type, theirs.type);
    if (!type) {
      throw Error(ErrorCode::wrong_content, other.name + ": its column " + theirs.name + " is " +
                                                std::string(name_of(theirs.type)) +
                                                ", which no type holds together with the " +
                                                std::string(name_of(mine->type)) + " of the other clouds");
    }
    mine->type = *type;
  }
}

/// One line for each column that is not in every cloud, or not of the same type in all.
void note_columns(const std::vector<NamedInfo>& clouds, UnitedInfo& united) {
  for (const ColumnInfo& column : united.info.extras) {
    std::vector<std::string> lacking;
    bool converted = false;
    for (const NamedInfo& cloud : clouds) {
      const ColumnInfo* own = find(cloud.info.extras, column.name);
      if (own == nullptr) lacking.push_back(cloud.name);
      converted = converted || (own != nullptr && own->type != column.type);
    }
    if (converted) {
      united.notes.push_back("column " + column.name + " has several types and becomes " +
                             std::string(name_of(column.type)));
    }
    // Rays of a cloud that was never split are whole, which is what 0 means.
    if (lacking.empty() || column.name == "clipped") continue;
    const std::string others =
        lacking.size() == 1 ? "" : " and " + std::to_string(lacking.size() - 1) + " more";
    united.notes.push_back("column " + column.name + " is filled with " +
                           (is_real(column.type) ? "NaN" : "0") + " for " + lacking.front() + others);
  }
}

/// `field` of all clouds that state it, or nothing if they contradict each other.
void unite_statement(const std::vector<NamedInfo>& clouds, std::string CloudInfo::*field, const char* what,
                     UnitedInfo& united) {
  const NamedInfo* first = nullptr;
  for (const NamedInfo& cloud : clouds) {
    if ((cloud.info.*field).empty()) continue;
    if (first == nullptr) first = &cloud;
    if (cloud.info.*field == first->info.*field) continue;
    united.warnings.push_back(first->name + " and " + cloud.name + " have different " + what +
                              ": the combined cloud states none");
    united.info.*field = "";
    return;
  }
  if (first != nullptr) united.info.*field = first->info.*field;
}

void unite_rest(const std::vector<NamedInfo>& clouds, CloudInfo& info) {
  for (const NamedInfo& cloud : clouds) {
    const CloudInfo& other = cloud.info;
    if (other.coordinate_step > 0.0 &&
        (info.coordinate_step <= 0.0 || other.coordinate_step < info.coordinate_step)) {
      info.coordinate_step = other.coordinate_step;
    }
    for (const std::string& line : other.history) {
      if (!contains(info.history, line)) info.history.push_back(line);
    }
    for (const std::string& line : other.comments) {
      if (!contains(info.comments, line)) info.comments.push_back(line);
    }
    for (const std::string& name : other.formal_extras) {
      if (!contains(info.formal_extras, name)) info.formal_extras.push_back(name);
    }
  }
  // Zeros mean "not recorded" only where that is so in every cloud that has the column.
  const auto recorded = [&](const std::string& name) {
    return std::any_of(clouds.begin(), clouds.end(), [&](const NamedInfo& cloud) {
      return find(cloud.info.extras, name) != nullptr && !contains(cloud.info.formal_extras, name);
    });
  };
  std::erase_if(info.formal_extras, recorded);
}

}  // namespace

std::optional<ScalarType> common_type(ScalarType a, ScalarType b) {
  if (a == b) return a;
  if (is_real(b) && !is_real(a)) std::swap(a, b);
  if (is_real(a)) {
    if (is_real(b)) return ScalarType::float64;
    const std::size_t bytes = size_of(b);
    if (bytes > 4) return {};
    return bytes <= 2 ? a : ScalarType::float64;
  }
  if (is_signed(a) == is_signed(b)) return size_of(a) > size_of(b) ? a : b;
  if (is_signed(b)) std::swap(a, b);
  if (size_of(a) > size_of(b)) return a;
  switch (b) {
    case ScalarType::uint8:
      return ScalarType::int16;
    case ScalarType::uint16:
      return ScalarType::int32;
    case ScalarType::uint32:
      return ScalarType::int64;
    default:
      return {};
  }
}

UnitedInfo unite(const std::vector<NamedInfo>& clouds) {
  UnitedInfo united;
  CloudInfo& info = united.info;
  info.ray_count = 0;
  std::size_t in_double = 0;
  for (const NamedInfo& cloud : clouds) {
    unite_columns(info.extras, cloud);
    info.ray_count = info.ray_count && cloud.info.ray_count
                         ? std::optional(*info.ray_count + *cloud.info.ray_count)
                         : std::nullopt;
    in_double += cloud.info.precision == Precision::double_ ? 1 : 0;
  }
  unite_rest(clouds, info);
  note_columns(clouds, united);
  info.precision = in_double > 0 ? Precision::double_ : Precision::single;
  if (in_double > 0 && in_double < clouds.size()) {
    united.notes.push_back("some clouds are in double precision, so the combined one is");
  }
  unite_statement(clouds, &CloudInfo::crs, "coordinate systems", united);
  unite_statement(clouds, &CloudInfo::time_base, "time bases", united);
  return united;
}

}  // namespace ray
