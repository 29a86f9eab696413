#pragma once
/// Pictures as files.

#include <raycloud/core/image.h>
#include <raycloud/io/file_options.h>

#include <filesystem>

namespace ray {

/// Writes an 8-bit RGBA PNG, atomically. Memory: 4 bytes a pixel and three times the compressed size. Images
/// up to 20 000 × 20 000 pixels; throws Error(out_of_range) for larger ones and for an image without pixels,
/// Error(file_access) where it cannot be written. Precondition: `image.pixels.size() == image.width *
/// image.height`.
void write_png(const std::filesystem::path& path, const Image& image, const WriteOptions& options = {});

}  // namespace ray
