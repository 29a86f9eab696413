#pragma once
/// Numbers as people read them.

#include <cstdint>
#include <string>

namespace ray::cli {

/// 1,234,567
[[nodiscard]] std::string grouped(std::uint64_t number);

/// `0.44 MB`, `36 bytes`: decimal units, as file managers show them.
[[nodiscard]] std::string file_size(std::uint64_t bytes);

}  // namespace ray::cli
