// A number as text for messages: the shortest that reads back as the same number ("0.1", "1e-09", "nan").
#pragma once

#include <string>

namespace buoyancy {

std::string number_text(double value);

}  // namespace buoyancy
