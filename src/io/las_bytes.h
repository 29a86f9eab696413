#pragma once
/// Numbers in the bytes of LAS: little-endian, as is every machine this project runs on.

#include <bit>
#include <cstddef>
#include <cstring>

namespace ray {

static_assert(std::endian::native == std::endian::little);

template <class T>
[[nodiscard]] T load(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

template <class T>
void store(std::byte* bytes, T value) {
  std::memcpy(bytes, &value, sizeof value);
}

}  // namespace ray
