#include <raycloud/core/error.h>
#include <raycloud/io/atomic_file.h>
#include <raycloud/io/image_file.h>

#include <cstdlib>
#include <exception>
#include <new>
#include <string>

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

/// stb is C, which would not free its memory if an exception passed: it is kept for later.
struct Output {
  AtomicFile file;
  std::exception_ptr error;
};

void append(void* context, void* data, int size) {
  auto& output = *static_cast<Output*>(context);
  if (output.error) return;
  try {
    output.file.write(std::span(static_cast<const std::byte*>(data), static_cast<std::size_t>(size)));
  } catch (...) {
    output.error = std::current_exception();
  }
}

}  // namespace

void write_png(const std::filesystem::path& path, const Image& image, const WriteOptions& options) {
  // stb counts bytes in an int.
  constexpr std::size_t kMaxSide = 20000;
  if (image.pixels.empty() || image.width > kMaxSide || image.height > kMaxSide) {
    throw Error(ErrorCode::out_of_range, path.string() + ": an image of " + std::to_string(image.width) +
                                             " x " + std::to_string(image.height) +
                                             " pixels cannot be written: a side has 1 to 20000");
  }
  static_assert(sizeof(Pixel) == 4);
  Output output{AtomicFile(path, options), nullptr};
  const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  int done = 0;
  try {
    done = stbi_write_png_to_func(append, &output, width, height, 4, image.pixels.data(), width * 4);
  } catch (const std::bad_alloc&) {
    done = 0;
  }
  if (output.error) std::rethrow_exception(output.error);
  if (done == 0) {
    throw Error(ErrorCode::out_of_range, path.string() + ": not enough memory to compress the image");
  }
  output.file.commit();
}

}  // namespace ray
