// Numbers, points and counts as words, for reports and errors that people read.
#pragma once

#include <cstdint>
#include <string>

#include "base/vec3.h"

namespace buoyancy {

// "0.25", "1e+300", "nan": at most `digits` significant digits, 1 to 17.
std::string number_text(double value, int digits = 9);

// "0.25, 1, -3"
std::string vector_text(const Vec3& vector, int digits = 9);

// "1 hole", "5 holes"
std::string counted(std::int64_t count, const std::string& singular, const std::string& plural);

}  // namespace buoyancy
