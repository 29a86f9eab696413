#include <raycloud/core/scalar.h>

#include <array>

namespace ray {

std::size_t size_of(ScalarType type) {
  return visit_scalar(type, []<class T>() { return sizeof(T); });
}

std::string_view name_of(ScalarType type) {
  static constexpr std::array<std::string_view, 10> kNames{"int8",   "uint8", "int16",  "uint16",  "int32",
                                                           "uint32", "int64", "uint64", "float32", "float64"};
  return kNames[static_cast<std::size_t>(type)];
}

}  // namespace ray
