#pragma once
/// The scalar types an extra column can have: those of PLY, and the 64-bit integers of LAS.

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace ray {

enum class ScalarType : std::uint8_t {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};

/// Calls `f.template operator()<T>()` with the C++ type T of `type` and returns what it returns. This is the
/// one place that goes from a run-time type to a static one.
template <class F>
decltype(auto) visit_scalar(ScalarType type, F&& f) {
  switch (type) {
    case ScalarType::int8:
      return f.template operator()<std::int8_t>();
    case ScalarType::uint8:
      return f.template operator()<std::uint8_t>();
    case ScalarType::int16:
      return f.template operator()<std::int16_t>();
    case ScalarType::uint16:
      return f.template operator()<std::uint16_t>();
    case ScalarType::int32:
      return f.template operator()<std::int32_t>();
    case ScalarType::uint32:
      return f.template operator()<std::uint32_t>();
    case ScalarType::int64:
      return f.template operator()<std::int64_t>();
    case ScalarType::uint64:
      return f.template operator()<std::uint64_t>();
    case ScalarType::float32:
      return f.template operator()<float>();
    case ScalarType::float64:
      break;
  }
  return f.template operator()<double>();
}

/// The ScalarType of a C++ type; does not compile for any other type.
template <class T>
[[nodiscard]] constexpr ScalarType scalar_type_of() {
  if constexpr (std::is_same_v<T, float>)
    return ScalarType::float32;
  else if constexpr (std::is_same_v<T, double>)
    return ScalarType::float64;
  else {
    static_assert(std::is_integral_v<T> && !std::is_same_v<T, bool>, "not a column type");
    constexpr int log2_size = sizeof(T) == 1 ? 0 : sizeof(T) == 2 ? 1 : sizeof(T) == 4 ? 2 : 3;
    return static_cast<ScalarType>(2 * log2_size + (std::is_unsigned_v<T> ? 1 : 0));
  }
}

/// Bytes of one value.
[[nodiscard]] std::size_t size_of(ScalarType type);

/// "int8", "uint16", "float64" …: how this project names the type to its users.
[[nodiscard]] std::string_view name_of(ScalarType type);

}  // namespace ray
