// JSON of what reports contain: vectors, orientations and optional values, and the text of an object.
#pragma once

#include <optional>
#include <string>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "base/vec3.h"

namespace buoyancy {

using Json = nlohmann::ordered_json;  // keeps the order in which keys are added

// Returns indented lines with a final newline. Non-finite numbers become null, and bytes that are not UTF-8,
// such as those of file names, replacement characters.
std::string json_lines(const Json& json);
// The same in one line, without a newline: for programs and pages.
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

// Null without a value.
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
