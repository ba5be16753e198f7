// The numbers and texts that the scripts of pages compute, compared with those that a test computes.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "base/vec3.h"
#include "tests/support/json.h"
#include "tests/view/browser.h"
#include "view/page/page_assets.h"

namespace buoyancy::view {

// Numbers agree within the tolerance, relative where they are above 1; all else is equal. A browser returns
// null for a number that is not finite.
inline testing::AssertionResult agrees(const nlohmann::json& actual, const nlohmann::json& expected,
                                       double tolerance = 1e-12) {
  if (expected.is_number() && actual.is_number()) {
    const auto number = expected.get<double>();
    if (std::abs(actual.get<double>() - number) <= tolerance * std::max(1.0, std::abs(number))) {
      return testing::AssertionSuccess();
    }
  } else if (expected.is_number_float() && !std::isfinite(expected.get<double>())) {
    if (actual.is_null()) return testing::AssertionSuccess();
  } else if (expected.is_array() && actual.is_array() && actual.size() == expected.size()) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (testing::AssertionResult one = agrees(actual[i], expected[i], tolerance); !one) {
        return one << "; place " << i;
      }
    }
    return testing::AssertionSuccess();
  } else if (expected.is_object() && actual.is_object() && actual.size() == expected.size()) {
    for (const auto& [name, value] : expected.items()) {
      if (!actual.contains(name)) return testing::AssertionFailure() << actual.dump() << " has no " << name;
      if (testing::AssertionResult one = agrees(actual[name], value, tolerance); !one) {
        return one << "; " << name;
      }
    }
    return testing::AssertionSuccess();
  } else if (actual == expected) {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << actual.dump() << ", expected " << expected.dump();
}

inline nlohmann::json json_of(const Vec3& v) {
  return nlohmann::json::array({v.x(), v.y(), v.z()});
}

// A page with these scripts of view/page, a picture of 640 x 400 pixels and a box for plots of the same
// width.
inline std::string page_of_scripts(const std::vector<std::string_view>& names) {
  std::string page =
      "<!DOCTYPE html><html><head><meta charset='utf-8'></head><body>"
      "<div><canvas id='canvas' style='width:640px;height:400px'></canvas></div>"
      "<div id='plots' style='width:640px'></div><script>" +
      three_js(kThreeJs).value() + "</script>";
  for (const std::string_view name : names) page += "<script>" + page_text(name, true) + "</script>";
  return page + "</body></html>";
}

// Of `scene`, the page's WaterScene: the vertices of a body's drawn mesh in W.
inline nlohmann::json vertices_in_W(Browser& browser, std::int32_t id) {
  return browser.run(
      "scene.scene.updateMatrixWorld(true);"
      "const { drawn } = scene.bodies.get(arguments[0]), { position } = drawn.geometry.attributes;"
      "return Array.from({ length: position.count }, (_, i) => drawn.localToWorld("
      "new THREE.Vector3().fromBufferAttribute(position, i)).toArray().map((x, k) => x + scene.origin[k]))",
      id);
}

// Of `scene`: where a point is in W, or where an arrow begins and ends; null where it is not shown.
inline nlohmann::json marker_in_W(Browser& browser, std::int32_t id, const std::string& name) {
  return browser.run(
      "scene.scene.updateMatrixWorld(true);"
      "const marker = scene.bodies.get(arguments[0]).markers[arguments[1]];"
      "if (!marker.visible) return null;"
      "const in_W = (v) => v.toArray().map((x, k) => x + scene.origin[k]);"
      "return marker.head ? [in_W(marker.position), in_W(marker.head.getWorldPosition(new THREE.Vector3()))]"
      " : in_W(marker.position)",
      id, name);
}

// The cells of the tables below an element, table by table, as texts.
inline nlohmann::json cells_of(Browser& browser, const std::string& selector) {
  return browser.run(
      "return [...document.querySelectorAll(`${arguments[0]} table`)].map((table) => "
      "[...table.tBodies[0].rows]"
      ".map((row) => [...row.cells].map((cell) => cell.textContent)))",
      selector);
}

}  // namespace buoyancy::view
