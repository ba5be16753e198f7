#include "tests/view/image.h"

#include <array>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <png.h>

#include "tests/support/temp_dir.h"

namespace buoyancy::view {
namespace {

constexpr Colour kSea{10, 20, 200};
constexpr Colour kDuck{250, 220, 0};

// A PNG of two rows of three pixels; column `duck` has the colour kDuck, the others have kSea.
std::string three_by_two(int duck = 1) {
  std::array<png_byte, 18> pixels{};
  for (int at = 0; at < 6; ++at) {
    const Colour colour = at % 3 == duck ? kDuck : kSea;
    const std::size_t byte = 3 * static_cast<std::size_t>(at);
    pixels.at(byte) = static_cast<png_byte>(colour.red);
    pixels.at(byte + 1) = static_cast<png_byte>(colour.green);
    pixels.at(byte + 2) = static_cast<png_byte>(colour.blue);
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = 3;
  image.height = 2;
  image.format = PNG_FORMAT_RGB;
  std::string png(10'000, '\0');
  png_alloc_size_t size = png.size();
  EXPECT_NE(png_image_write_to_memory(&image, png.data(), &size, 0, pixels.data(), 0, nullptr), 0);
  png.resize(size);
  return png;
}

TEST(Image, DecodesEveryPixelOfPng) {
  const Image image(three_by_two());
  EXPECT_EQ(image.width(), 3);
  EXPECT_EQ(image.height(), 2);
  EXPECT_EQ(image.pixel(0, 0), kSea);
  EXPECT_EQ(image.pixel(1, 1), kDuck);
  EXPECT_EQ(image.pixel(2, 1), kSea);
}

TEST(Image, ComputesShareOfMatchingPixels) {
  const Image image(three_by_two());
  EXPECT_DOUBLE_EQ(image.share(image.whole(), is_near(kDuck)), 2.0 / 6.0);
  EXPECT_DOUBLE_EQ(image.share({1, 0, 2, 2}, is_near(kDuck)), 0.5);
  EXPECT_DOUBLE_EQ(image.share({1, 1, 1, 1}, is_near(kDuck)), 1.0);
}

TEST(Image, ComparesColoursWithinTolerance) {
  EXPECT_TRUE(is_near(kSea, 5)({15, 15, 205}));
  EXPECT_FALSE(is_near(kSea, 5)({16, 20, 200}));
  EXPECT_FALSE(is_near(kSea, 5)({10, 14, 200}));
  EXPECT_FALSE(is_near(kSea, 5)({10, 20, 206}));
}

TEST(Image, ComputesShareOfChangedPixels) {
  const Image before(three_by_two(1));
  const Image after(three_by_two(2));
  EXPECT_DOUBLE_EQ(before.share_changed(after, before.whole()), 4.0 / 6.0);
  EXPECT_DOUBLE_EQ(before.share_changed(after, {0, 0, 1, 2}), 0.0);
  EXPECT_DOUBLE_EQ(before.share_changed(after, before.whole(), 255), 0.0);
}

TEST(Image, SavesIdenticalPng) {
  const TempDir directory;
  const std::string path = directory.path("a/new/folder/image.png");
  Image(three_by_two()).save(path);
  EXPECT_EQ(read_file(path), three_by_two());
}

TEST(Image, ThrowsForInvalidPngOrRegion) {
  EXPECT_THROW(Image("not a PNG"), std::runtime_error);
  const std::string png = three_by_two();
  EXPECT_THROW(Image(png.substr(0, png.size() / 2)), std::runtime_error);
  const Image image(png);
  EXPECT_THROW(image.pixel(3, 0), std::runtime_error);
  EXPECT_THROW(image.pixel(0, -1), std::runtime_error);
  EXPECT_THROW(image.share({2, 0, 2, 1}, is_near(kSea)), std::runtime_error);
  EXPECT_THROW(image.share({0, 0, 0, 1}, is_near(kSea)), std::runtime_error);
}

}  // namespace
}  // namespace buoyancy::view
