// JSON in tests. What parses and prints it is compiled once, since a source that instantiates it takes a
// second longer to compile. For the same reason, order is compared between numbers: value.get<double>()
// < 1.0.
#pragma once

#include <iosfwd>
#include <string_view>

#include <nlohmann/json.hpp>

namespace buoyancy {

// Throws nlohmann::json::parse_error.
nlohmann::json parse_json(std::string_view text);

}  // namespace buoyancy

namespace nlohmann {

// Prints a value in the messages of GoogleTest, which finds this function by its name.
void PrintTo(const json& value, std::ostream* out);

}  // namespace nlohmann
