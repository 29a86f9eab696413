#include "jpeg_tables.h"

#include <numeric>

namespace ray {
namespace {

constexpr unsigned kEndOfImage = 0xd9, kStartOfScan = 0xda, kHuffmanTables = 0xc4, kStartOfImage = 0xd8;

unsigned value(std::byte byte) {
  return std::to_integer<unsigned>(byte);
}

bool is_restart(unsigned marker) {
  return marker >= 0xd0 && marker <= 0xd7;
}

/// The content of a segment of Huffman tables.
bool sound(std::span<const std::byte> tables) {
  constexpr std::size_t kHead = 17;  // the table's number and how many codes have 1 to 16 bits
  while (!tables.empty()) {
    if (tables.size() < kHead) return false;
    const auto counts = tables.subspan(1, kHead - 1);
    const std::size_t codes = std::accumulate(counts.begin(), counts.end(), std::size_t{0},
                                              [](std::size_t sum, std::byte n) { return sum + value(n); });
    if (codes > 256 || tables.size() < kHead + codes) return false;
    tables = tables.subspan(kHead + codes);
  }
  return true;
}

/// Where the coded data that begin at `at` end: at the next marker that is no restart.
std::size_t end_of_scan(std::span<const std::byte> jpeg, std::size_t at) {
  for (; at + 1 < jpeg.size(); at++) {
    const unsigned next = value(jpeg[at + 1]);
    if (value(jpeg[at]) == 0xff && next != 0 && next != 0xff && !is_restart(next)) return at;
  }
  return jpeg.size();
}

}  // namespace

bool has_sound_tables(std::span<const std::byte> jpeg) {
  std::size_t at = 0;
  while (at + 1 < jpeg.size()) {
    if (value(jpeg[at]) != 0xff) return false;
    const unsigned marker = value(jpeg[at + 1]);
    at += marker == 0xff ? 1 : 2;  // a marker may have more than one ff before it
    if (marker == kEndOfImage) return true;
    if (marker == 0xff || marker == kStartOfImage) continue;
    if (at + 2 > jpeg.size()) return false;
    const std::size_t length = value(jpeg[at]) << 8 | value(jpeg[at + 1]);
    if (length < 2 || length > jpeg.size() - at) return false;
    if (marker == kHuffmanTables && !sound(jpeg.subspan(at + 2, length - 2))) return false;
    at += length;
    if (marker == kStartOfScan) at = end_of_scan(jpeg, at);
  }
  return true;  // cut, as stb will find
}

}  // namespace ray
