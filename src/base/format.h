// Formats numbers, vectors and counts for reports and error messages.
#pragma once

#include <cstdint>
#include <string>

#include "base/vec3.h"

namespace buoyancy {

// Formats as "0.25", "1e+300" or "nan", with at most `digits` significant digits; digits: 1 to 17.
std::string format_number(double value, int digits = 9);

// Returns the shortest text that parses to the same number: "0.1", "1e-09", "nan".
std::string format_shortest(double value);

// Formats as "0.25, 1, -3".
std::string format_vector(const Vec3& vector, int digits = 9);

// Formats as "1 hole" or "5 holes".
std::string pluralize(std::int64_t count, const std::string& singular, const std::string& plural);

}  // namespace buoyancy
