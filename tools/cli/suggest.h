#pragma once
/// "Did you mean": the nearest of some spellings.

#include <span>
#include <string>
#include <string_view>

namespace ray::cli {

/// The candidate nearest to `typed` if it is near enough to be a slip, else empty. A slip is a letter
/// changed, added, lost or swapped with its neighbour; words of 3 or 4 letters may have one, of 5 to 7 two,
/// and so on.
[[nodiscard]] std::string nearest(std::string_view typed, std::span<const std::string> candidates);

/// `; did you mean cm?`, or nothing.
[[nodiscard]] std::string did_you_mean(std::string_view typed, std::span<const std::string> candidates);

}  // namespace ray::cli
