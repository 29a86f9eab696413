#include "ply_fixture.h"
#include "support/scratch.h"

#include <raycloud/core/error.h>
#include <raycloud/io/image_file.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

namespace ray {
namespace {

using namespace test;

/// A smooth ramp with some noise, and every alpha.
Image picture(std::size_t width, std::size_t height) {
  Image image{width, height, {}};
  for (std::size_t i = 0; i < width * height; ++i) {
    const auto byte = [&](std::size_t factor) { return static_cast<std::uint8_t>(i * factor >> 3); };
    image.pixels.push_back({byte(1), byte(7), byte(131), byte(3)});
  }
  return image;
}

Image opaque(Image image) {
  for (Pixel& pixel : image.pixels)
    pixel.alpha = 255;
  return image;
}

using Size = std::pair<std::size_t, std::size_t>;
constexpr std::array kSizes = {Size{1, 1}, Size{7, 3}, Size{129, 2}, Size{300, 200}};

TEST(ImageFile, PngAndTgaGiveBackEveryPixel) {
  const Scratch scratch;
  for (const char* name : {"a.png", "a.tga", "a.TGA"}) {
    for (const auto& [width, height] : kSizes) {
      const Image image = picture(width, height);
      write_image(scratch.path(name), image);
      const Image back = read_image(scratch.path(name));
      EXPECT_EQ(back.width, width);
      EXPECT_EQ(back.height, height);
      EXPECT_EQ(back.pixels, image.pixels) << name << ' ' << width;
    }
  }
}

TEST(ImageFile, BmpIsThePictureOnBlack) {
  const Scratch scratch;
  for (const auto& [width, height] : kSizes) {
    const Image image = opaque(picture(width, height));
    write_image(scratch.path("a.bmp"), image);
    EXPECT_EQ(read_image(scratch.path("a.bmp")).pixels, image.pixels);
  }
  write_image(scratch.path("a.bmp"), Image{3, 1, {{200, 100, 50, 0}, {200, 100, 50, 128}, {9, 8, 7, 255}}});
  EXPECT_THAT(read_image(scratch.path("a.bmp")).pixels,
              testing::ElementsAre(Pixel{0, 0, 0, 255}, Pixel{100, 50, 25, 255}, Pixel{9, 8, 7, 255}));
}

TEST(ImageFile, JpegLooksTheSame) {
  const Scratch scratch;
  Image image{64, 48, {}};
  for (std::size_t i = 0; i < 64 * 48; ++i) {
    image.pixels.push_back({static_cast<std::uint8_t>(i % 64 * 4), static_cast<std::uint8_t>(i / 64 * 5), 90,
                            static_cast<std::uint8_t>(i < 32 * 64 ? 255 : 0)});
  }
  for (const char* name : {"a.jpg", "a.jpeg"}) {
    write_image(scratch.path(name), image);
    const Image back = read_image(scratch.path(name));
    ASSERT_EQ(back.pixels.size(), image.pixels.size());
    for (std::size_t i = 0; i < back.pixels.size(); ++i) {
      EXPECT_NEAR(back.pixels[i].red, image.pixels[i].alpha != 0 ? image.pixels[i].red : 0, 12) << i;
      EXPECT_NEAR(back.pixels[i].green, image.pixels[i].alpha != 0 ? image.pixels[i].green : 0, 12) << i;
      EXPECT_EQ(back.pixels[i].alpha, 255);
    }
  }
}

/// Radiance RGBE as its specification says, for the files that fit into it without surprise.
FloatImage decoded_hdr(const std::string& file) {
  FloatImage image;
  std::size_t at = file.find("\n\n-Y ");
  EXPECT_NE(at, std::string::npos);
  EXPECT_EQ(file.find("#?RADIANCE\n"), 0U);
  EXPECT_NE(file.find("FORMAT=32-bit_rle_rgbe\n"), std::string::npos);
  int used = 0;
  EXPECT_EQ(std::sscanf(file.c_str() + at, "\n\n-Y %zu +X %zu%n", &image.height, &image.width, &used), 2);
  at += static_cast<std::size_t>(used) + 1;
  const auto next = [&] { return static_cast<std::uint8_t>(file.at(at++)); };
  for (std::size_t row = 0; row < image.height; ++row) {
    std::vector<std::array<std::uint8_t, 4>> pixels(image.width);
    if (image.width < 8) {
      for (auto& pixel : pixels) {
        for (auto& byte : pixel)
          byte = next();
      }
    } else {
      EXPECT_EQ(next(), 2);
      EXPECT_EQ(next(), 2);
      const std::size_t high = next();
      EXPECT_EQ(high * 256 + next(), image.width);
      for (std::size_t channel = 0; channel < 4; ++channel) {
        for (std::size_t x = 0; x < image.width;) {
          const std::size_t count = next();
          const std::size_t length = count > 128 ? count - 128 : count;
          const std::uint8_t value = count > 128 ? next() : 0;
          for (std::size_t i = 0; i < length; ++i)
            pixels.at(x++)[channel] = count > 128 ? value : next();
        }
      }
    }
    for (const auto& [red, green, blue, exponent] : pixels) {
      const float scale = exponent == 0 ? 0.0F : std::ldexp(1.0F, exponent - 136);
      image.pixels.push_back({static_cast<float>(red) * scale, static_cast<float>(green) * scale,
                              static_cast<float>(blue) * scale});
    }
  }
  EXPECT_EQ(at, file.size());
  return image;
}

RC_GTEST_PROP(ImageFile, HdrKeepsEveryValueToOnePartIn256, ()) {
  const Scratch scratch;
  const auto width = *rc::gen::element<std::size_t>(1, 7, 8, 9, 127, 128, 129, 300, 700);
  FloatImage image{width, *rc::gen::inRange<std::size_t>(1, 4), {}};
  const bool runs = *rc::gen::arbitrary<bool>();
  std::uint64_t state = *rc::gen::arbitrary<std::uint64_t>();
  const auto random = [&] { return (state = state * 6364136223846793005U + 1442695040888963407U) >> 33; };
  while (image.pixels.size() < image.width * image.height) {
    const auto value = [&] {
      return random() % 5 == 0 ? 0.0F
                               : std::ldexp(static_cast<float>(random() % 65536) / 65536.0F,
                                            static_cast<int>(random() % 60) - 30);
    };
    const FloatPixel pixel{value(), value(), value()};
    for (std::size_t i = 0; i < (runs ? 1 + random() % 300 : 1); ++i)
      image.pixels.push_back(pixel);
  }
  image.pixels.resize(image.width * image.height);
  write_image(scratch.path("a.hdr"), image);
  const FloatImage back = decoded_hdr(read_file(scratch.path("a.hdr")));
  RC_ASSERT(back.width == image.width);
  RC_ASSERT(back.pixels.size() == image.pixels.size());
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const FloatPixel &a = image.pixels[i], &b = back.pixels[i];
    const float largest = std::max({a.red, a.green, a.blue});
    for (const float error : {a.red - b.red, a.green - b.green, a.blue - b.blue})
      RC_ASSERT(std::abs(error) <= largest / 256.0F);
    RC_ASSERT((a == FloatPixel{}) == (b == FloatPixel{}));
  }
}

TEST(ImageFile, HdrHoldsTheLargeAndTheSmall) {
  const Scratch scratch;
  const float most = 1.6e38F;
  write_image(scratch.path("a.hdr"), FloatImage{3, 1, {{most, 1, 0}, {1e-44F, 0, 0}, {255.6F, 1.0F, 0.0F}}});
  const FloatImage back = decoded_hdr(read_file(scratch.path("a.hdr")));
  EXPECT_NEAR(back.pixels[0].red / most, 1.0F, 1.0F / 256);
  EXPECT_EQ(back.pixels[1], FloatPixel{});
  EXPECT_NEAR(back.pixels[2].red, 255.6F, 1.0F);
  for (const float bad : {-1.0F, std::nanf(""), INFINITY}) {
    const auto error = error_of([&] { write_image(scratch.path("b.hdr"), FloatImage{1, 1, {{0, bad, 0}}}); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ErrorCode::out_of_range);
  }
  EXPECT_FALSE(std::filesystem::exists(scratch.path("b.hdr")));
}

TEST(ImageFile, RefusesWhatIsNoImageAndKeepsTheOldFile) {
  const Scratch scratch;
  for (const char* name : {"a.png", "a.jpg", "a.bmp", "a.tga"}) {
    write_file(scratch.path(name), "old");
    for (const Image& image : {Image{0, 0, {}}, Image{20001, 1, std::vector<Pixel>(20001)}}) {
      const auto error = error_of([&] { write_image(scratch.path(name), image); });
      ASSERT_TRUE(error);
      EXPECT_EQ(error->code(), ErrorCode::out_of_range);
    }
    EXPECT_EQ(read_file(scratch.path(name)), "old");
  }
  const Image pixel{1, 1, {{}}};
  EXPECT_EQ(error_of([&] { write_image(scratch.path("none/a.png"), pixel); })->code(),
            ErrorCode::file_access);
  for (const char* name : {"a.gif", "a", "a.hdr"}) {
    EXPECT_EQ(error_of([&] { write_image(scratch.path(name), pixel); })->code(), ErrorCode::usage) << name;
  }
  EXPECT_EQ(error_of([&] {
              write_image(scratch.path("a.png"), FloatImage{1, 1, {{}}});
            })->code(),
            ErrorCode::usage);
}

ErrorCode reading(const std::filesystem::path& path, std::string* text = nullptr) {
  try {
    static_cast<void>(read_image(path));
  } catch (const Error& error) {
    if (text != nullptr) *text = error.what();
    return error.code();
  }
  return ErrorCode::cancelled;  // never thrown here: nothing was
}

TEST(ReadImage, SaysWhatIsWrong) {
  const Scratch scratch;
  EXPECT_EQ(reading(scratch.path("none.png")), ErrorCode::file_not_found);
  EXPECT_EQ(reading(scratch.folder()), ErrorCode::file_access);
  write_file(scratch.path("empty.png"), "");
  EXPECT_EQ(reading(scratch.path("empty.png")), ErrorCode::file_format);
  write_file(scratch.path("text.png"), "ply\nformat ascii 1.0\n");
  std::string text;
  EXPECT_EQ(reading(scratch.path("text.png"), &text), ErrorCode::wrong_content);
  EXPECT_THAT(text, testing::EndsWith("text.png: not an image: PNG, JPEG, BMP and TGA can be read"));
}

TEST(ReadImage, IsNeverSatisfiedWithAPartOfAFile) {
  const Scratch scratch;
  for (const std::string extension : {".png", ".jpg", ".bmp", ".tga"}) {
    const auto whole = scratch.path("whole" + extension), cut = scratch.path("cut" + extension);
    write_image(whole, picture(37, 29));
    const std::string bytes = read_file(whole);
    for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 40) {
      // The check sum of a PNG's end mark says nothing about the picture.
      if (extension == ".png" && length + 4 >= bytes.size()) break;
      write_file(cut, bytes.substr(0, length));
      const ErrorCode code = reading(cut);
      EXPECT_TRUE(code == ErrorCode::file_format || (length < 4 && code == ErrorCode::wrong_content))
          << extension << ' ' << length << " of " << bytes.size() << " bytes: " << static_cast<int>(code);
    }
    write_file(cut, bytes.substr(0, bytes.size() / 2));
    std::string text;
    static_cast<void>(reading(cut, &text));
    EXPECT_THAT(text, testing::EndsWith(extension + ": cut: the image ends too early"));
  }
}

/// The head of a PNG that claims a size, and the rest of a small one.
std::string png_of_size(const std::string& small, std::uint32_t width, std::uint32_t height) {
  std::string bytes = small;
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[16 + i] = static_cast<char>(width >> (24 - 8 * i));
    bytes[20 + i] = static_cast<char>(height >> (24 - 8 * i));
  }
  return bytes;
}

TEST(ReadImage, TakesNoMemoryForAbsurdSizes) {
  const Scratch scratch;
  write_image(scratch.path("small.png"), picture(20, 20));
  const std::string small = read_file(scratch.path("small.png"));
  write_file(scratch.path("a.png"), png_of_size(small, 16000000, 16000000));
  EXPECT_EQ(reading(scratch.path("a.png")), ErrorCode::out_of_range);
  write_file(scratch.path("a.png"), png_of_size(small, 16000, 16000));
  std::string text;
  EXPECT_EQ(reading(scratch.path("a.png"), &text), ErrorCode::file_format);
  EXPECT_THAT(text, testing::HasSubstr("damaged: 16000 x 16000 pixels cannot be in "));
  write_file(scratch.path("a.png"), png_of_size(small, 0, 20));
  EXPECT_EQ(reading(scratch.path("a.png")), ErrorCode::file_format);
}

TEST(ReadImage, AJpegThatNamesTablesItDoesNotGive) {
  const Scratch scratch;
  const auto path = scratch.path("a.jpg");
  write_image(path, picture(21, 13));
  const std::string whole = read_file(path);
  std::size_t tables = 0;
  for (std::size_t at = 0; at + 4 < whole.size(); ++at) {
    if (whole.compare(at, 2, "\xff\xc4") != 0) continue;
    ++tables;
    std::string bytes = whole;
    bytes[at + 4] = static_cast<char>(bytes[at + 4] ^ 3);  // the number of the table
    write_file(path, bytes);
    const ErrorCode code = reading(path);
    EXPECT_TRUE(code == ErrorCode::cancelled || code == ErrorCode::file_format);
  }
  EXPECT_GE(tables, 1U);
}

RC_GTEST_PROP(ReadImage, SurvivesAnyChangedByte, ()) {
  static const Scratch scratch;
  const auto extension = *rc::gen::element<std::string>(".png", ".jpg", ".bmp", ".tga");
  const auto path = scratch.path("a" + extension);
  write_image(path, picture(21, 13));
  std::string bytes = read_file(path);
  for (int i = *rc::gen::inRange(1, 4); i > 0; --i)
    bytes.at(*rc::gen::inRange<std::size_t>(0, bytes.size())) =
        static_cast<char>(*rc::gen::arbitrary<std::uint8_t>());
  write_file(path, bytes);
  const ErrorCode code = reading(path);
  RC_ASSERT(code == ErrorCode::cancelled || code == ErrorCode::file_format ||
            code == ErrorCode::wrong_content || code == ErrorCode::out_of_range);
}

}  // namespace
}  // namespace ray
