#include "rgbe.h"

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

/// Runs of at least 4 equal bytes as (128 + length, byte), the rest as (length, bytes…).
void append_runs(std::span<const std::uint8_t> bytes, std::string& file) {
  constexpr std::size_t kShortestRun = 4;
  constexpr std::size_t kLongestRun = 127;
  constexpr std::size_t kLongestRest = 128;
  const auto run_at = [&](std::size_t at) {
    std::size_t length = 1;
    while (length < kLongestRun && at + length < bytes.size() && bytes[at + length] == bytes[at])
      length++;
    return length;
  };
  std::size_t at = 0;
  while (at < bytes.size()) {
    std::size_t rest = 0, run = 0;
    while (at + rest < bytes.size() && rest < kLongestRest) {
      run = run_at(at + rest);
      if (run >= kShortestRun) break;
      rest = std::min(rest + run, kLongestRest);
    }
    if (rest > 0) {
      file.push_back(static_cast<char>(rest));
      file.append(reinterpret_cast<const char*>(bytes.data() + at), rest);
      at += rest;
    } else {
      file.push_back(static_cast<char>(128 + run));
      file.push_back(static_cast<char>(bytes[at]));
      at += run;
    }
  }
}

}  // namespace

Rgbe rgbe_of(const FloatPixel& pixel) {
  constexpr int kBias = 128;
  const float largest = std::max({pixel.red, pixel.green, pixel.blue});
  if (largest == 0.0F) return {0, 0, 0, 0};
  int exponent = 0;
  std::frexp(largest, &exponent);  // largest = 0.5…1 · 2^exponent
  if (exponent + kBias < 1) return {0, 0, 0, 0};
  exponent = std::min(exponent, 255 - kBias);
  // 255 for what would round to 256: half the step is better for the other channels.
  const auto mantissa = [&](float value) {
    return static_cast<std::uint8_t>(std::min(std::lround(std::ldexp(value, 8 - exponent)), 255L));
  };
  return {mantissa(pixel.red), mantissa(pixel.green), mantissa(pixel.blue),
          static_cast<std::uint8_t>(exponent + kBias)};
}

std::string rgbe_header(std::size_t width, std::size_t height) {
  return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
         std::to_string(width) + "\n";
}

void append_rgbe_row(std::span<const FloatPixel> row, std::string& file) {
  const std::size_t width = row.size();
  std::vector<std::uint8_t> planes(4 * width);
  for (std::size_t x = 0; x < width; x++) {
    const Rgbe rgbe = rgbe_of(row[x]);
    for (std::size_t channel = 0; channel < 4; channel++)
      planes[channel * width + x] = rgbe[channel];
  }
  if (width < 8 || width > 32767) {  // the format has no runs for these
    for (std::size_t x = 0; x < width; x++) {
      for (std::size_t channel = 0; channel < 4; channel++)
        file.push_back(static_cast<char>(planes[channel * width + x]));
    }
    return;
  }
  file.append({2, 2, static_cast<char>(width >> 8), static_cast<char>(width & 255)});
  for (std::size_t channel = 0; channel < 4; channel++)
    append_runs(std::span(planes).subspan(channel * width, width), file);
}

}  // namespace ray
