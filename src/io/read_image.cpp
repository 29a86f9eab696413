#include "file_kind.h"
#include "input_file.h"
#include "jpeg_tables.h"

#include <raycloud/core/error.h>
#include <raycloud/io/image_file.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace {

/// stb hands no context to its allocator, so the limit of the read under way is kept beside it.
thread_local std::size_t largest_block = 0;

void* granted(void* block, std::size_t bytes) {
  return bytes > largest_block ? nullptr : std::realloc(block, bytes);
}

/// Zeros: a JPEG may name a table that it never gives, and stb would follow whatever is there.
void* granted_zeros(std::size_t bytes) {
  return bytes > largest_block ? nullptr : std::calloc(bytes, 1);
}

}  // namespace

#define STBI_MALLOC(bytes) granted_zeros(bytes)
#define STBI_REALLOC(block, bytes) granted(block, bytes)
#define STBI_FREE(block) std::free(block)
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace ray {
namespace {

/// The file's bytes as stb asks for them, remembering whether it asked for more than there were.
struct Input {
  std::span<const std::byte> bytes;
  std::size_t at = 0;
  bool ran_out = false;

  static int read(void* user, char* data, int size) {
    auto& input = *static_cast<Input*>(user);
    const auto wanted = static_cast<std::size_t>(size);
    const std::size_t count = std::min(wanted, input.bytes.size() - input.at);
    // stb fills its buffer of this size ahead; there only getting nothing means that bytes are missing.
    constexpr std::size_t kReadAhead = 128;
    input.ran_out = input.ran_out || count == 0 || (count < wanted && wanted != kReadAhead);
    std::memcpy(data, input.bytes.data() + input.at, count);
    input.at += count;
    return static_cast<int>(count);
  }
  static void skip(void* user, int size) {
    auto& input = *static_cast<Input*>(user);
    input.at += std::min(static_cast<std::size_t>(std::max(size, 0)), input.bytes.size() - input.at);
  }
  static int at_end(void* user) {
    const auto& input = *static_cast<Input*>(user);
    return input.at == input.bytes.size() ? 1 : 0;
  }
};

constexpr stbi_io_callbacks kCallbacks{Input::read, Input::skip, Input::at_end};

[[noreturn]] void fail(ErrorCode code, const std::filesystem::path& path, const std::string& why) {
  throw Error(code, path.string() + ": " + why);
}

[[noreturn]] void fail_as_stb(const std::filesystem::path& path, const Input& input) {
  if (input.ran_out) fail(ErrorCode::file_format, path, "cut: the image ends too early");
  fail(ErrorCode::file_format, path,
       std::string("damaged, or a kind that cannot be read (") + stbi_failure_reason() + ")");
}

bool is_known(std::span<const std::byte> bytes, const std::filesystem::path& path) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  // A TGA begins with nothing of its own.
  return text.starts_with("\x89PNG") || text.starts_with("\xff\xd8\xff") || text.starts_with("BM") ||
         lower_extension(path) == ".tga";
}

std::vector<std::byte> contents(const std::filesystem::path& path) {
  const InputFile file(path);
  if (file.size() > static_cast<std::uint64_t>(std::numeric_limits<int>::max())) {
    fail(ErrorCode::out_of_range, path, "an image of more than 2 GB cannot be read");
  }
  std::vector<std::byte> bytes(file.size());
  bytes.resize(file.read_at(0, bytes));
  if (bytes.empty()) fail(ErrorCode::file_format, path, "an empty file");
  return bytes;
}

/// Throws unless the image can be held, and can be in a file of that many bytes at all.
void check_size(const std::filesystem::path& path, std::uint64_t width, std::uint64_t height,
                std::uint64_t file_bytes) {
  constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 28;
  // Deflate packs at most 1032 bytes into one, each with 8 pixels of a black and white PNG.
  constexpr std::uint64_t kMostPixelsPerByte = 1032 * 8;
  const std::string size = std::to_string(width) + " x " + std::to_string(height) + " pixels";
  if (width == 0 || height == 0) fail(ErrorCode::file_format, path, "damaged: " + size);
  if (width * height > kMostPixels) {
    fail(ErrorCode::out_of_range, path, "an image of " + size + " cannot be read: at most 2^28 in all");
  }
  if (width * height > kMostPixelsPerByte * file_bytes) {
    fail(ErrorCode::file_format, path,
         "damaged: " + size + " cannot be in " + std::to_string(file_bytes) + " bytes");
  }
}

/// stb calls a PNG that is too large for it unknown.
void check_png_size(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  if (bytes.size() < 24 || bytes[0] != std::byte{0x89}) return;
  const auto number = [&](std::size_t at) {
    std::uint64_t value = 0;
    for (const std::byte byte : bytes.subspan(at, 4))
      value = value << 8 | std::to_integer<std::uint64_t>(byte);
    return value;
  };
  check_size(path, number(16), number(20), bytes.size());
}

}  // namespace

Image read_image(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = contents(path);
  if (!is_known(bytes, path)) {
    fail(ErrorCode::wrong_content, path, "not an image: PNG, JPEG, BMP and TGA can be read");
  }
  check_png_size(path, bytes);
  const bool is_jpeg = bytes.size() > 1 && bytes[0] == std::byte{0xff} && bytes[1] > std::byte{1};  // no TGA
  if (is_jpeg && !has_sound_tables(bytes)) {
    fail(ErrorCode::file_format, path, "cut or damaged: it has no sound tables");
  }
  int width = 0, height = 0, channels = 0;
  Input input{bytes};
  constexpr std::size_t kBesides = std::size_t{1} << 20;  // the state of a decoder
  largest_block = kBesides;
  if (stbi_info_from_callbacks(&kCallbacks, &input, &width, &height, &channels) == 0)
    fail_as_stb(path, input);
  check_size(path, static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), bytes.size());
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  // 16-bit RGBA in a buffer that grows by doubling, or the compressed file in such a one.
  largest_block = 16 * pixels + 2 * bytes.size() + kBesides;
  input = Input{bytes};
  const std::unique_ptr<stbi_uc, decltype(&std::free)> decoded(
      stbi_load_from_callbacks(&kCallbacks, &input, &width, &height, &channels, 4), std::free);
  if (input.ran_out || !decoded) fail_as_stb(path, input);
  Image image{static_cast<std::size_t>(width), static_cast<std::size_t>(height), std::vector<Pixel>(pixels)};
  static_assert(sizeof(Pixel) == 4);
  std::memcpy(image.pixels.data(), decoded.get(), 4 * pixels);
  return image;
}

}  // namespace ray
