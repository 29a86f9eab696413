#pragma once
/// Lossless compression as PNG and TIFF have it.

#include <cstddef>
#include <span>
#include <vector>

namespace ray {

/// A zlib stream (RFC 1950). Throws std::bad_alloc without memory. Precondition: less than 2^31 bytes.
[[nodiscard]] std::vector<std::byte> deflated(std::span<const std::byte> bytes);

}  // namespace ray
