#pragma once
/// Which format a file name asks for.

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace ray {

/// The extension in lower case, with its dot.
[[nodiscard]] std::string lower_extension(const std::filesystem::path& path);

/// The extension of `path` in lower case, one of `known`. Throws Error(usage) that lists `known` otherwise.
[[nodiscard]] std::string known_extension(const std::filesystem::path& path,
                                          std::initializer_list<std::string_view> known);

}  // namespace ray
