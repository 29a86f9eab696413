#pragma once
/// Where a command writes: the input's name plus a suffix, unless the user says otherwise.

#include "cli/match.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace ray::cli {

/// `a/b.ply` and `_decimated` give `a/b_decimated.ply`; with an extension given (".png") `a/b_decimated.png`.
[[nodiscard]] std::filesystem::path output_name(const std::filesystem::path& input, std::string_view suffix,
                                                std::string_view extension = {});

/// The value of --output, or the name above.
[[nodiscard]] std::filesystem::path main_output(const Match& match, const std::filesystem::path& input,
                                                std::string_view suffix, std::string_view extension = {});

}  // namespace ray::cli
