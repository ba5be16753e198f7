// What a page looks like, pixel by pixel, and what tests ask of that.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace buoyancy::view {

struct Colour {  // 0 to 255 each, sRGB
  int red = 0;
  int green = 0;
  int blue = 0;
  bool operator==(const Colour&) const = default;
};

using ColourPredicate = std::function<bool(const Colour&)>;

// No component differs from the colour's by more than `tolerance`.
ColourPredicate is_near(const Colour& colour, int tolerance = 2);

struct Region {  // pixels, from the picture's top left corner
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

// Throws std::runtime_error where the bytes are no PNG, and where a pixel or region is not in the picture.
class Image {
 public:
  explicit Image(std::string png);

  int width() const { return width_; }
  int height() const { return height_; }
  Region whole() const { return {0, 0, width_, height_}; }
  Colour pixel(int x, int y) const;

  // The part of the region's pixels that satisfies the predicate, 0 to 1.
  double share(const Region& region, const ColourPredicate& wanted) const;

  // The part of the region's pixels that another picture of the same size has in another colour, by more than
  // `tolerance` in one component.
  double share_changed(const Image& other, const Region& region, int tolerance = 2) const;

  // As a PNG. Makes the folder if need be.
  void save(const std::string& path) const;

 private:
  double share_of_pixels(const Region& region, const std::function<bool(int x, int y)>& wanted) const;

  std::string png_;
  int width_ = 0;
  int height_ = 0;
  std::vector<unsigned char> rgb_;
};

}  // namespace buoyancy::view
