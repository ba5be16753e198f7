#include "base/format.h"

#include <array>
#include <cstdio>

namespace buoyancy {

std::string number_text(double value, int digits) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

std::string vector_text(const Vec3& vector, int digits) {
  return number_text(vector.x(), digits) + ", " + number_text(vector.y(), digits) + ", " +
         number_text(vector.z(), digits);
}

std::string counted(std::int64_t count, const std::string& singular, const std::string& plural) {
  return std::to_string(count) + " " + (count == 1 ? singular : plural);
}

}  // namespace buoyancy
