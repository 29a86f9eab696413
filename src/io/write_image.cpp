#include "deflate.h"
#include "file_kind.h"
#include "rgbe.h"

#include <raycloud/core/error.h>
#include <raycloud/io/atomic_file.h>
#include <raycloud/io/image_file.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

namespace {

/// stb does not look whether growing succeeded.
void* grown(void* block, std::size_t bytes) {
  void* larger = std::realloc(block, bytes);
  if (larger == nullptr) throw std::bad_alloc();
  return larger;
}

}  // namespace

#define STBIW_MALLOC(bytes) std::malloc(bytes)
#define STBIW_REALLOC(block, bytes) grown(block, bytes)
#define STBIW_FREE(block) std::free(block)
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <stb_image_write.h>
#pragma GCC diagnostic pop

namespace ray {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;  // bytes written at a time

/// stb is C, which would not free its memory if an exception passed: it is kept for later.
struct Output {
  AtomicFile file;
  std::vector<std::byte> piece;
  std::exception_ptr error;

  void flush() {
    file.write(piece);
    piece.clear();
  }

  static void append(void* context, void* data, int size) {
    auto& output = *static_cast<Output*>(context);
    if (output.error) return;
    try {
      const auto* bytes = static_cast<const std::byte*>(data);
      output.piece.insert(output.piece.end(), bytes, bytes + size);
      if (output.piece.size() >= kPiece) output.flush();
    } catch (...) {
      output.error = std::current_exception();
    }
  }
};

void check_size(const std::filesystem::path& path, std::size_t width, std::size_t height) {
  if (width > 0 && height > 0 && width <= kLongestImageSide && height <= kLongestImageSide) return;
  throw Error(ErrorCode::out_of_range,
              path.string() + ": an image of " + std::to_string(width) + " x " + std::to_string(height) +
                  " pixels cannot be written: a side has 1 to " + std::to_string(kLongestImageSide));
}

/// Red, green and blue of every pixel as it looks on black.
std::vector<std::uint8_t> on_black(const Image& image) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * image.pixels.size());
  for (const Pixel& pixel : image.pixels) {
    for (const unsigned value : {pixel.red, pixel.green, pixel.blue})
      bytes.push_back(static_cast<std::uint8_t>((value * pixel.alpha + 127) / 255));
  }
  return bytes;
}

/// Whether stb had the memory it needed.
bool encode(ImageFormat format, const Image& image, Output& output) {
  const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  switch (format) {
    case ImageFormat::jpg: {
      constexpr int kQuality = 95;  // from 91 on the colour of single pixels is kept
      return stbi_write_jpg_to_func(Output::append, &output, width, height, 3, on_black(image).data(),
                                    kQuality) != 0;
    }
    case ImageFormat::bmp:
      return stbi_write_bmp_to_func(Output::append, &output, width, height, 3, on_black(image).data()) != 0;
    case ImageFormat::tga:
      return stbi_write_tga_to_func(Output::append, &output, width, height, 4, image.pixels.data()) != 0;
    default:
      return stbi_write_png_to_func(Output::append, &output, width, height, 4, image.pixels.data(),
                                    width * 4) != 0;
  }
}

}  // namespace

// Here, as this file has stb's compressor.
std::vector<std::byte> deflated(std::span<const std::byte> bytes) {
  constexpr int kEffort = 8;
  std::vector<std::byte> copy(bytes.begin(), bytes.end());  // stb takes no const
  int size = 0;
  unsigned char* stream = stbi_zlib_compress(reinterpret_cast<unsigned char*>(copy.data()),
                                             static_cast<int>(copy.size()), &size, kEffort);
  if (stream == nullptr) throw std::bad_alloc();
  const auto* begin = reinterpret_cast<const std::byte*>(stream);
  const auto free_stream = [](unsigned char* block) { std::free(block); };
  const std::unique_ptr<unsigned char, decltype(free_stream)> owner(stream, free_stream);
  return {begin, begin + size};
}

ImageFormat image_format(const std::filesystem::path& path) {
  const std::string extension = known_extension(path, {".png", ".jpg", ".jpeg", ".bmp", ".tga", ".hdr"});
  if (extension == ".png") return ImageFormat::png;
  if (extension == ".bmp") return ImageFormat::bmp;
  if (extension == ".tga") return ImageFormat::tga;
  if (extension == ".hdr") return ImageFormat::hdr;
  return ImageFormat::jpg;
}

void write_image(const std::filesystem::path& path, const Image& image, const WriteOptions& options) {
  const ImageFormat format = image_format(path);
  if (format == ImageFormat::hdr) {
    throw Error(ErrorCode::usage, path.string() + ": an image of 8 bits a channel is no .hdr");
  }
  check_size(path, image.width, image.height);
  static_assert(sizeof(Pixel) == 4);
  Output output{AtomicFile(path, options), {}, nullptr};
  bool done = false;
  try {
    done = encode(format, image, output);
  } catch (const std::bad_alloc&) {
    done = false;
  }
  if (output.error) std::rethrow_exception(output.error);
  if (!done) {
    throw Error(ErrorCode::out_of_range, path.string() + ": not enough memory to compress the image");
  }
  output.flush();
  output.file.commit();
}

void write_image(const std::filesystem::path& path, const FloatImage& image, const WriteOptions& options) {
  if (image_format(path) != ImageFormat::hdr) {
    throw Error(ErrorCode::usage, path.string() + ": an image of real values is written as .hdr");
  }
  check_size(path, image.width, image.height);
  for (const FloatPixel& pixel : image.pixels) {
    for (const float value : {pixel.red, pixel.green, pixel.blue}) {
      if (value >= 0.0F && std::isfinite(value)) continue;
      throw Error(ErrorCode::out_of_range, path.string() + ": .hdr holds no negative, infinite or NaN value");
    }
  }
  AtomicFile file(path, options);
  std::string piece = rgbe_header(image.width, image.height);
  for (std::size_t row = 0; row < image.height; row++) {
    append_rgbe_row(std::span(image.pixels).subspan(row * image.width, image.width), piece);
    if (piece.size() < kPiece && row + 1 < image.height) continue;
    file.write(piece);
    piece.clear();
  }
  file.commit();
}

}  // namespace ray
