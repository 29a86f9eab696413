#include "ply_fixture.h"
#include "support/scratch.h"

#include <raycloud/core/error.h>
#include <raycloud/io/image_file.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#pragma GCC diagnostic pop

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

namespace ray {
namespace {

using namespace test;

TEST(ImageFile, PngGivesBackEveryPixel) {
  const Scratch scratch;
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {300, 200}}) {
    Image image{static_cast<std::size_t>(width), static_cast<std::size_t>(height), {}};
    for (int i = 0; i < width * height; ++i) {
      const auto byte = [&](int factor) { return static_cast<std::uint8_t>(i * factor >> 3); };
      image.pixels.push_back({byte(1), byte(7), byte(131), byte(3)});
    }
    write_png(scratch.path("a.png"), image);
    int x = 0, y = 0, channels = 0;
    stbi_uc* back = stbi_load(scratch.path("a.png").c_str(), &x, &y, &channels, 4);
    ASSERT_NE(back, nullptr);
    EXPECT_EQ(x, width);
    EXPECT_EQ(y, height);
    EXPECT_EQ(channels, 4);
    EXPECT_EQ(std::memcmp(back, image.pixels.data(), image.pixels.size() * sizeof(Pixel)), 0);
    stbi_image_free(back);
  }
}

TEST(ImageFile, RefusesWhatIsNoImageAndKeepsTheOldFile) {
  const Scratch scratch;
  write_file(scratch.path("a.png"), "old");
  for (const Image& image : {Image{0, 0, {}}, Image{20001, 1, std::vector<Pixel>(20001)}}) {
    const auto error = error_of([&] { write_png(scratch.path("a.png"), image); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ErrorCode::out_of_range);
  }
  EXPECT_EQ(read_file(scratch.path("a.png")), "old");
  EXPECT_EQ(error_of([&] {
              write_png(scratch.path("none/a.png"), {1, 1, {{}}});
            })->code(),
            ErrorCode::file_access);
}

}  // namespace
}  // namespace ray
