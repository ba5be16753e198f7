#include "tests/view/image.h"

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

#include <png.h>

namespace buoyancy::view {

ColourPredicate is_near(const Colour& colour, int tolerance) {
  return [colour, tolerance](const Colour& other) {
    return std::abs(other.red - colour.red) <= tolerance &&
           std::abs(other.green - colour.green) <= tolerance &&
           std::abs(other.blue - colour.blue) <= tolerance;
  };
}

Image::Image(std::string png) : png_(std::move(png)) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, png_.data(), png_.size()) == 0) {
    throw std::runtime_error("image: " + std::to_string(png_.size()) +
                             " bytes are not a PNG: " + image.message);
  }
  image.format = PNG_FORMAT_RGB;
  rgb_.resize(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, rgb_.data(), 0, nullptr) == 0) {
    throw std::runtime_error(std::string("image: the PNG cannot be read: ") + image.message);
  }
  width_ = static_cast<int>(image.width);
  height_ = static_cast<int>(image.height);
}

Colour Image::pixel(int x, int y) const {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) {
    throw std::runtime_error("image: pixel (" + std::to_string(x) + ", " + std::to_string(y) +
                             ") is not in " + std::to_string(width_) + " x " + std::to_string(height_));
  }
  const std::size_t offset =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x));
  return {rgb_[offset], rgb_[offset + 1], rgb_[offset + 2]};
}

double Image::share(const Region& region, const ColourPredicate& matches) const {
  return share_of_pixels(region, [&](int x, int y) { return matches(pixel(x, y)); });
}

double Image::share_changed(const Image& other, const Region& region, int tolerance) const {
  if (other.width_ != width_ || other.height_ != height_) {
    throw std::runtime_error("image: images of different sizes cannot be compared");
  }
  return share_of_pixels(region,
                         [&](int x, int y) { return !is_near(pixel(x, y), tolerance)(other.pixel(x, y)); });
}

void Image::save(const std::string& path) const {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder);
  std::ofstream file(path, std::ios::binary);
  file.write(png_.data(), static_cast<std::streamsize>(png_.size())).flush();
  if (!file) throw std::runtime_error("image: cannot write " + path);
}

double Image::share_of_pixels(const Region& region, const std::function<bool(int x, int y)>& matches) const {
  if (region.width <= 0 || region.height <= 0) throw std::runtime_error("image: the region is empty");
  std::size_t count = 0;
  for (int y = region.top; y < region.top + region.height; ++y) {
    for (int x = region.left; x < region.left + region.width; ++x) {
      if (matches(x, y)) ++count;
    }
  }
  return static_cast<double>(count) / (static_cast<double>(region.width) * region.height);
}

}  // namespace buoyancy::view
