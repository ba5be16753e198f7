// Converts vectors, orientations and optional values to JSON, and JSON to text.
#pragma once

#include <optional>
#include <string>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "base/vec3.h"

namespace buoyancy {

using Json = nlohmann::ordered_json;  // keeps the order in which keys are added

// Returns indented lines with a final newline. Non-finite numbers become null. Bytes that are not UTF-8, as
// in some file names, become replacement characters.
std::string json_lines(const Json& json);
// Returns the JSON in one line without a newline, for programs and web pages; otherwise as json_lines().
std::string json_line(const nlohmann::json& json);
std::string json_line(const Json& json);

}  // namespace buoyancy

namespace nlohmann {

// [x, y, z]
template <>
struct adl_serializer<buoyancy::Vec3> {
  template <typename JsonType>
  static void to_json(JsonType& json, const buoyancy::Vec3& v) {
    json = JsonType::array({v.x(), v.y(), v.z()});
  }
};

// [w, x, y, z]
template <>
struct adl_serializer<Eigen::Quaterniond> {
  template <typename JsonType>
  static void to_json(JsonType& json, const Eigen::Quaterniond& q) {
    json = JsonType::array({q.w(), q.x(), q.y(), q.z()});
  }
};

// null if there is no value
template <typename T>
struct adl_serializer<std::optional<T>> {
  template <typename JsonType>
  static void to_json(JsonType& json, const std::optional<T>& value) {
    if (value) {
      json = *value;
    } else {
      json = nullptr;
    }
  }
};

}  // namespace nlohmann
