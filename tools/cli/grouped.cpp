#include "cli/grouped.h"

#include <cstdio>

namespace ray::cli {

std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t end = text.size(); end > 3; end -= 3)
    text.insert(end - 3, ",");
  return text;
}

std::string file_size(std::uint64_t bytes) {
  if (bytes < 10'000) return grouped(bytes) + " bytes";
  char text[32];
  const auto exact = static_cast<double>(bytes);
  if (bytes < 1'000'000'000) {
    std::snprintf(text, sizeof text, exact < 1e7 ? "%.2f MB" : "%.1f MB", exact / 1e6);
  } else {
    std::snprintf(text, sizeof text, "%.2f GB", exact / 1e9);
  }
  return text;
}

}  // namespace ray::cli
