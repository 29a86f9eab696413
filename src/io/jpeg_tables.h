#pragma once
/// A look at the tables of a JPEG before stb_image 2.27 takes them, which writes past its arrays where a
/// damaged Huffman table claims more codes than there can be.

#include <cstddef>
#include <span>

namespace ray {

/// Whether every segment up to the end of the picture is whole and every Huffman table has at most 256 codes
/// (ITU T.81, B.2.4.2).
[[nodiscard]] bool has_sound_tables(std::span<const std::byte> jpeg);

}  // namespace ray
