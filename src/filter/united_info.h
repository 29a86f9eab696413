#pragma once
/// What a combination of clouds says about itself.

#include <raycloud/core/cloud_info.h>

#include <optional>
#include <string>
#include <vector>

namespace ray {

/// The smallest type that holds every value of both exactly.
[[nodiscard]] std::optional<ScalarType> common_type(ScalarType a, ScalarType b);

struct NamedInfo {
  std::string name;
  CloudInfo info;
};

struct UnitedInfo {
  CloudInfo info;
  std::vector<std::string> notes;
  std::vector<std::string> warnings;
};

/// As CombinedSource says. Precondition: at least one.
[[nodiscard]] UnitedInfo unite(const std::vector<NamedInfo>& clouds);

}  // namespace ray
