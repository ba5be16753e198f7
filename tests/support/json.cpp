#include "tests/support/json.h"

#include <ostream>

nlohmann::json buoyancy::parse_json(std::string_view text) {
  return nlohmann::json::parse(text);
}

void nlohmann::PrintTo(const json& value, std::ostream* out) {
  *out << value;
}
