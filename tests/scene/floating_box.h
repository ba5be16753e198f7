// A floating box whose motions have closed forms, for tests of body_motions.h.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "scene/body_motions.h"
#include "tests/scene/scene_texts.h"

namespace buoyancy {

inline constexpr double kPi = std::numbers::pi;

// A box of 2 x 1 x 0.5 m that floats at a draft of 0.3 m.
inline constexpr double kLength = 2.0;
inline constexpr double kBeam = 1.0;
inline constexpr double kDepth = 0.5;
inline constexpr double kDraft = 0.3;
inline constexpr double kDensity = 1000.0;
inline constexpr double kGravity = 9.8;
inline constexpr double kMass = kDensity * kLength * kBeam * kDraft;
inline constexpr double kWaterplane = kLength * kBeam;

inline const std::string kWorld = "[world]\ngravity = 9.8\n[water]\ndensity = 1000\nlevel = 3\n";

inline std::string box_scene(const std::string& tables, const std::string& client = "mass = 600") {
  return kWorld + "[[body]]\nid = 1\nshape = { type = \"box\", size = [2, 1, 0.5], segments = [4, 3, 2] }\n" +
         tables + "\n[body.client]\n" + client + "\n";
}

inline BodyMotions motions_of(const std::string& text) {
  const Scene scene = prepared(text);
  return *scene_motions(scene).at(0).motions;
}

inline double period(double inertia, double stiffness) {
  return 2.0 * kPi * std::sqrt(inertia / stiffness);
}

// Roll stiffness of the box over its breadth across the axis, with C at its middle.
inline double stiffness_of_box(double breadth) {
  const double metacentric_height = 0.5 * kDraft + breadth * breadth / (12.0 * kDraft) - 0.5 * kDepth;
  return kMass * kGravity * metacentric_height;
}

inline double inertia_of_box(double breadth) {
  return kMass / 12.0 * (breadth * breadth + kDepth * kDepth);
}

inline void expect_relative(double value, double expected, double tolerance, const char* what) {
  EXPECT_NEAR(value, expected, tolerance * std::abs(expected)) << what;
}

}  // namespace buoyancy
