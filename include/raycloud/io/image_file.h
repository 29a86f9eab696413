#pragma once
/// Pictures as files: .png, .jpg (.jpeg), .bmp and .tga of 8 bits a channel, and .hdr (Radiance RGBE) of real
/// values.

#include <raycloud/core/image.h>
#include <raycloud/io/file_options.h>

#include <filesystem>

namespace ray {

/// Pixels; what write_image writes at most, across and down.
inline constexpr std::size_t kLongestImageSide = 20000;

enum class ImageFormat { png, jpg, bmp, tga, hdr };

/// By the extension, in any case. Throws Error(usage) with the list of those there are.
[[nodiscard]] ImageFormat image_format(const std::filesystem::path& path);

/// Writes by the extension, atomically. PNG and TGA keep the alpha; JPEG (quality 95) and BMP have none and
/// show every pixel on black. PNG, BMP and TGA give the same bytes back. Memory: 4 bytes a pixel and, for
/// PNG, three times the compressed size. Throws Error(out_of_range) for an
/// image without pixels or with a side above kLongestImageSide, Error(usage) for another extension (.hdr
/// too), Error(file_access) where it cannot be written.
void write_image(const std::filesystem::path& path, const Image& image, const WriteOptions& options = {});

/// The same for real values, as .hdr only. RGBE has one exponent for the three channels: each is kept to
/// 1/256 of the largest of its pixel, up to 1.7e38. Throws Error(out_of_range) for a negative, infinite or
/// NaN value too.
void write_image(const std::filesystem::path& path, const FloatImage& image,
                 const WriteOptions& options = {});

/// Reads a PNG, JPEG or BMP, known by its first bytes, or a .tga, with 4 channels of 8 bits: alpha is 255
/// where the file has none, grey becomes three equal channels, 16 bits become 8. Memory: the file, and up to
/// 24 bytes a pixel; before any is taken the size that the file claims is judged against the bytes it has.
///
/// Throws Error(file_not_found), Error(file_access), Error(wrong_content) for what is no such image,
/// Error(file_format) for one that is cut or damaged, and Error(out_of_range) above 2^28 pixels.
[[nodiscard]] Image read_image(const std::filesystem::path& path);

}  // namespace ray
