// A screenshot as pixels, with measures for tests.
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

// True for colours of which no component differs by more than `tolerance`.
ColourPredicate is_near(const Colour& colour, int tolerance = 2);

struct Region {  // [pixels], from the image's top left corner
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

// Throws std::runtime_error if the bytes are not a PNG, or if a pixel or region is not inside the image.
class Image {
 public:
  explicit Image(std::string png);

  int width() const { return width_; }
  int height() const { return height_; }
  Region whole() const { return {0, 0, width_, height_}; }
  Colour pixel(int x, int y) const;

  // The share of the region's pixels that satisfies the predicate, 0 to 1.
  double share(const Region& region, const ColourPredicate& matches) const;

  // The share of the region's pixels whose colour differs from that in `other`, an image of the same size, by
  // more than `tolerance` in one component.
  double share_changed(const Image& other, const Region& region, int tolerance = 2) const;

  // Writes a PNG; creates the folder if necessary.
  void save(const std::string& path) const;

 private:
  double share_of_pixels(const Region& region, const std::function<bool(int x, int y)>& matches) const;

  std::string png_;
  int width_ = 0;
  int height_ = 0;
  std::vector<unsigned char> rgb_;
};

}  // namespace buoyancy::view
