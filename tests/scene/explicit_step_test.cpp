#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/scene/floating_box.h"

namespace buoyancy {
namespace {

// Semi-implicit Euler of heave: the displacement after some steps, from 1.
double heave_after(double mass, double damping, double stiffness, double h) {
  double x = 1.0;
  double v = 0.0;
  for (int n = 0; n < 20000; ++n) {
    v += h / mass * (-stiffness * x - damping * v);
    x += h * v;
  }
  return std::abs(x) + h * std::abs(v);
}

TEST(ExplicitStep, LimitOfHeaveSeparatesDecayFromGrowth) {
  // A flat box, whose heave is its fastest motion.
  const BodyMotions motions = motions_of(
      kWorld +
      "[[body]]\nid = 1\nshape = { type = \"box\", size = [1, 1, 0.2] }\n[body.drag]\nlinear = [0, 0, "
      "300, 0, 0, 0]\nimmersion = \"none\"\n[body.client]\nmass = 100\n");
  const double stiffness = kDensity * kGravity;
  const double omega = std::sqrt(stiffness / 100.0);
  const double zeta = 300.0 / (2.0 * std::sqrt(stiffness * 100.0));
  EXPECT_EQ(motions.step_limit, StepLimit::kFloating);
  const double step = motions.max_explicit_step;
  expect_relative(step, 2.0 / (omega * (zeta + std::sqrt(1.0 + zeta * zeta))), 1e-9, "step");
  EXPECT_LT(heave_after(100.0, 300.0, stiffness, 0.999 * step), 1.0);
  EXPECT_GT(heave_after(100.0, 300.0, stiffness, 1.001 * step), 1e6);
}

TEST(ExplicitStep, IsLimitedByDragAtTerminalVelocity) {
  const BodyMotions motions = motions_of(box_scene(
      "[body.drag]\nquadratic = [1, 1, 5000, 0, 0, 0]\n[body.added_mass]\nmatrix = [0, 0, 250, 0, 0, 0]",
      "density = 2000"));
  EXPECT_EQ(motions.step_limit, StepLimit::kTerminalVelocity);
  const double v = std::abs(motions.terminal_velocity.value());
  const double step = motions.max_explicit_step;
  expect_relative(step, 2.0 * 2250.0 / (2.0 * 5000.0 * v), 1e-9, "step");
  // The drag itself, near the terminal velocity, relative to which it grows or decays.
  const auto offset_after = [&](double h) {
    double u = v * (1.0 + 1e-6);
    for (int n = 0; n < 400; ++n) u += h / 2250.0 * (1000.0 * kGravity - 5000.0 * std::abs(u) * u);
    return std::abs(u - v) / v;
  };
  EXPECT_LT(offset_after(0.98 * step), 1e-8);
  EXPECT_GT(offset_after(1.02 * step), 1e-4);
}

TEST(ExplicitStep, IsLimitedByGivenVelocityAndCurrent) {
  const std::string tables = "[body.drag]\nquadratic = [4000, 0, 0, 0, 0, 0]";
  const std::string client = "density = 1000\nlinear_velocity = [1, 0, 0]";
  const BodyMotions still = motions_of(box_scene(tables, client));
  EXPECT_EQ(still.step_limit, StepLimit::kSubmerged);
  expect_relative(still.max_explicit_step, 2.0 * 1000.0 / (2.0 * 4000.0 * 1.0), 1e-9, "still");
  const BodyMotions in_current =
      motions_of(box_scene(tables, client) + "[water.current]\nvelocity = [-2, 0, 0]\n");
  expect_relative(in_current.max_explicit_step, 2.0 * 1000.0 / (2.0 * 4000.0 * 3.0), 1e-9, "in a current");
}

}  // namespace
}  // namespace buoyancy
