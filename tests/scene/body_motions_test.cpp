#include "scene/body_motions.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/format.h"
#include "geometry/rotation_between.h"
#include "geometry/shapes.h"
#include "tests/geometry/mesh_files.h"
#include "tests/scene/floating_box.h"

namespace buoyancy {
namespace {

void expect_same_motions(const BodyMotions& actual, const BodyMotions& expected, double tolerance) {
  const auto expect_same = [tolerance](const std::optional<double>& a, const std::optional<double>& b,
                                       const char* name) {
    ASSERT_EQ(a.has_value(), b.has_value()) << name;
    if (a) expect_relative(*a, *b, tolerance, name);
  };
  expect_relative(actual.natural->heave.frequency, expected.natural->heave.frequency, tolerance, "heave");
  expect_relative(actual.natural->roll.frequency, expected.natural->roll.frequency, tolerance, "roll");
  expect_relative(actual.natural->pitch.frequency, expected.natural->pitch.frequency, tolerance, "pitch");
  expect_same(actual.draft, expected.draft, "draft");
  expect_same(actual.terminal_velocity, expected.terminal_velocity, "terminal velocity");
  expect_relative(actual.max_explicit_step, expected.max_explicit_step, tolerance, "step");
}

void expect_same_damping(const BodyMotions& actual, const BodyMotions& expected, double tolerance) {
  for (const auto motion : {&NaturalMotions::heave, &NaturalMotions::roll, &NaturalMotions::pitch}) {
    const NaturalMotion& a = (*actual.natural).*motion;
    const NaturalMotion& b = (*expected.natural).*motion;
    expect_relative(a.damping_ratio, b.damping_ratio, tolerance, "damping ratio");
    expect_relative(a.damping_ratio_at_amplitude, b.damping_ratio_at_amplitude, tolerance, "at amplitude");
  }
}

TEST(BodyMotions, PeriodsOfBoxHaveTheirClosedForms) {
  struct Case {
    const char* immersion;
    double factor;
  };
  const double area = 2.0 * (kLength * kBeam + kLength * kDepth + kBeam * kDepth);
  const double wetted = kLength * kBeam + 2.0 * kDraft * (kLength + kBeam);
  for (const Case& c :
       {Case{"volume", kDraft / kDepth}, Case{"wetted_area", wetted / area}, Case{"none", 1.0}}) {
    const BodyMotions motions =
        motions_of(box_scene("[body.added_mass]\nmatrix = [50, 300, 900, 20, 70, 30]\nimmersion = \"" +
                             std::string(c.immersion) + "\""));
    EXPECT_EQ(motions.balance, VerticalBalance::kFloats);
    expect_relative(motions.draft.value(), kDraft, 1e-12, "draft");
    EXPECT_LT(motions.turning_lever, 1e-12);
    const NaturalMotions& natural = motions.natural.value();
    expect_relative(natural.heave.period(),
                    period(kMass + 900.0 * c.factor, kDensity * kGravity * kWaterplane), 1e-9, c.immersion);
    expect_relative(natural.roll.period(),
                    period(inertia_of_box(kBeam) + 20.0 * c.factor, stiffness_of_box(kBeam)), 1e-9,
                    c.immersion);
    expect_relative(natural.pitch.period(),
                    period(inertia_of_box(kLength) + 70.0 * c.factor, stiffness_of_box(kLength)), 1e-9,
                    c.immersion);
  }
}

TEST(BodyMotions, PeriodOfSphereHasItsClosedForm) {
  // A sphere of 64 meridians that is half immersed: its waterplane is a regular polygon.
  const BodyMotions motions =
      motions_of(kWorld + "[[body]]\nid = 1\nshape = { type = \"sphere\", radius = 0.5, segments = 63 }\n" +
                 "[body.added_mass]\nmatrix = [1, 1, 40, 0, 0, 0]\n[body.client]\ndensity = 500\n");
  const BodyMotions heavier =
      motions_of(kWorld + "[[body]]\nid = 1\nshape = { type = \"sphere\", radius = 0.5, segments = 63 }\n" +
                 "[body.client]\ndensity = 500\n");
  const double volume =
      make_hydrostatic_mesh(
          validate_mesh({make_shape(SphereShape{0.5, 63}), {}}, "sphere", ValidationOptions{}).mesh.value())
          .volume;
  const double mass = 500.0 * volume;
  const double polygon = 0.5 * 63.0 * std::sin(2.0 * kPi / 63.0) * 0.25;
  const double K = kDensity * kGravity * polygon;
  expect_relative(motions.natural->heave.period(), period(mass + 20.0, K), 1e-6, "with added mass");
  expect_relative(heavier.natural->heave.period(), period(mass, K), 1e-6, "without");
  EXPECT_NEAR(motions.draft.value(), 0.5, 1e-6);
}

TEST(BodyMotions, DampingRatiosOfBoxHaveTheirClosedForms) {
  const BodyMotions motions =
      motions_of(box_scene("[body.drag]\nlinear = [10, 20, 300, 40, 50, 60]\nquadratic = [1, 2, 800, 70, 5, "
                           "6]\n[body.added_mass]\nmatrix = [0, 0, 900, 20, 0, 0]"));
  const double s = kDraft / kDepth;
  const double heave_mass = kMass + s * 900.0;
  const double heave_stiffness = kDensity * kGravity * kWaterplane;
  const NaturalMotion& heave = motions.natural->heave;
  const double linear = s * 300.0 / (2.0 * std::sqrt(heave_stiffness * heave_mass));
  expect_relative(heave.damping_ratio, linear, 1e-9, "heave");
  const double amplitude = 0.05 * std::sqrt(kLength * kLength + kBeam * kBeam + kDepth * kDepth);
  expect_relative(heave.amplitude, amplitude, 1e-12, "amplitude");
  expect_relative(heave.damping_ratio_at_amplitude,
                  linear + 4.0 / (3.0 * kPi) * amplitude * s * 800.0 / heave_mass, 1e-9, "heave, quadratic");
  const NaturalMotion& roll = motions.natural->roll;
  const double roll_inertia = inertia_of_box(kBeam) + s * 20.0;
  const double roll_linear = s * 40.0 / (2.0 * std::sqrt(stiffness_of_box(kBeam) * roll_inertia));
  expect_relative(roll.damping_ratio, roll_linear, 1e-9, "roll");
  expect_relative(roll.damping_ratio_at_amplitude,
                  roll_linear + 4.0 / (3.0 * kPi) * 0.1 * s * 70.0 / roll_inertia, 1e-9, "roll, quadratic");
}

TEST(BodyMotions, QuadraticDragActsAtItsCenter) {
  // A plate 0.8 m before C resists pitch by heaving.
  const BodyMotions motions = motions_of(
      box_scene("[body.drag]\nquadratic = [0, 0, 500, 0, 0, 0]\ncenter = [0.8, 0, 0]\nimmersion = \"none\""));
  EXPECT_EQ(motions.natural->pitch.damping_ratio, 0.0);
  expect_relative(motions.natural->pitch.damping_ratio_at_amplitude,
                  4.0 / (3.0 * kPi) * 0.1 * 500.0 * std::pow(0.8, 3) / inertia_of_box(kLength), 1e-9,
                  "pitch");
}

TEST(BodyMotions, MatricesMayBeGivenAboutAnyCenter) {
  Expected<SceneDescription> description =
      parse(box_scene("[body.drag]\nlinear = [10, 20, 300, 40, 50, 60]\ncenter = [0.3, -0.1, "
                      "0.2]\n[body.added_mass]\nmatrix = "
                      "[50, 300, 900, 20, 70, 30]\ncenter = [-0.2, 0.3, 0.1]",
                      "mass = 600\ncenter_of_mass = [0.3, 0.05, 0]\ninertia = [80, 250, 300]"));
  const Scene as_given = Scene::prepare(*description).value();
  const BodyMotions expected = *scene_motions(as_given)[0].motions;
  BodyDescription& body = description->bodies[0];
  const Vec3 center_of_mass_B(0.3, 0.05, 0.0);
  body.drag->linear = matrix_at(body.drag->linear, center_of_mass_B - *body.drag->center_B);
  body.drag->center_B = center_of_mass_B;
  body.added_mass->matrix = matrix_at(body.added_mass->matrix, center_of_mass_B - *body.added_mass->center_B);
  body.added_mass->center_B = center_of_mass_B;
  const Scene moved = Scene::prepare(*description).value();
  const BodyMotions motions = *scene_motions(moved)[0].motions;
  expect_same_motions(motions, expected, 1e-10);
  expect_same_damping(motions, expected, 1e-10);
  expect_relative(motions.added_mass_ratio, expected.added_mass_ratio, 1e-10, "ratio");
}

TEST(BodyMotions, RollTakesSwayAlong) {
  // Added mass in sway whose centre lies d below C: a body free to sway has the inertia I + d^2 m A / (m +
  // A).
  const BodyMotions motions = motions_of(box_scene(
      "[body.added_mass]\nmatrix = [0, 400, 0, 0, 0, 0]\ncenter = [0, 0, -0.2]\nimmersion = \"none\""));
  const double inertia = inertia_of_box(kBeam) + 0.04 * kMass * 400.0 / (kMass + 400.0);
  expect_relative(motions.natural->roll.period(), period(inertia, stiffness_of_box(kBeam)), 1e-9, "roll");
}

TEST(BodyMotions, HeaveAndPitchAreCoupledModes) {
  // C lies 0.3 m forward of the waterplane's centroid.
  const BodyMotions motions =
      motions_of(box_scene("", "mass = 600\ncenter_of_mass = [0.3, 0, 0]\ninertia = [80, 250, 300]"));
  const double rho_g = kDensity * kGravity;
  const double K_33 = rho_g * kWaterplane;
  const double K_35 = rho_g * kWaterplane * 0.3;
  const double K_55 = stiffness_of_box(kLength) + rho_g * kWaterplane * 0.09;
  const double a = std::pow(2.0 * kPi / motions.natural->heave.period(), 2);
  const double b = std::pow(2.0 * kPi / motions.natural->pitch.period(), 2);
  expect_relative(a + b, K_33 / kMass + K_55 / 250.0, 1e-9, "trace");
  expect_relative(a * b, (K_33 * K_55 - K_35 * K_35) / (kMass * 250.0), 1e-9, "determinant");
  expect_relative(motions.turning_lever, 0.3, 1e-9, "lever");
}

TEST(BodyMotions, DoNotDependOnHeadingAndUpDirection) {
  const std::string tables =
      "[body.drag]\nlinear = [10, 20, 300, 40, 50, 60]\nquadratic = [1, 2, 800, 70, 5, 6]\ncenter = [0.1, 0, "
      "0.05]\n[body.added_mass]\nmatrix = [50, 300, 900, 20, 70, 30]\ncenter = [0, 0.05, 0.1]\n";
  Expected<SceneDescription> description = parse(box_scene(tables));
  const Scene upright = Scene::prepare(*description).value();
  const BodyMotions expected = *scene_motions(upright)[0].motions;
  const Vec3 up = Vec3(0.3, -0.8, 0.2).normalized();
  description->water.up_W = up;
  description->bodies[0].dynamics.orientation =
      rotation_between(Vec3::UnitZ(), up) * Eigen::Quaterniond(Eigen::AngleAxisd(2.0, Vec3::UnitZ()));
  const Scene turned = Scene::prepare(*description).value();
  const BodyMotions motions = *scene_motions(turned)[0].motions;
  expect_same_motions(motions, expected, 1e-8);
  expect_same_damping(motions, expected, 1e-8);
}

TEST(BodyMotions, TerminalVelocityBalancesWeightBuoyancyAndDrag) {
  struct Case {
    double linear, quadratic, density;
  };
  for (const Case& c : {Case{30.0, 80.0, 3000.0}, Case{30.0, 80.0, 200.0}, Case{0.0, 80.0, 1100.0},
                        Case{30.0, 0.0, 990.0}, Case{1e4, 1e-6, 2000.0}}) {
    const auto all = [](double number) {
      std::string list = "[" + std::to_string(number);
      for (int i = 1; i < 6; ++i) list += ", " + std::to_string(number);
      return list + "]";
    };
    const BodyMotions motions =
        motions_of(box_scene("[body.drag]\nlinear = " + all(c.linear) + "\nquadratic = " + all(c.quadratic),
                             "density = " + std::to_string(c.density)));
    const double force = (kDensity - c.density) * kGravity * kLength * kBeam * kDepth;
    const double v = motions.terminal_velocity.value();
    EXPECT_EQ(v > 0.0, force > 0.0);
    expect_relative((c.linear + c.quadratic * std::abs(v)) * v, force, 1e-9, "force");
  }
}

TEST(BodyMotions, TerminalVelocityFollowsTheAttitude) {
  // Against the drag that the service computes, for a tilted body with a full matrix.
  const Scene scene =
      prepared(box_scene("[body.drag]\nquadratic = [10, 2, 0, 0, 0, 0, 1, 200, 3, 0, 0, 0, 0, 4, 300, 0, 0, "
                         "0, 0, 0, 0, 1, 0, 0, "
                         "0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1]\nlinear = [1, 2, 3, 4, 5, 6]",
                         "density = 1500\norientation = [0.8, 0.3, 0.2, -0.1]"));
  const Body& body = scene.bodies()[0];
  const double v = scene_motions(scene)[0].motions->terminal_velocity.value();
  HydrodynamicState state;
  state.motion.R_WB = body.dynamics.orientation.toRotationMatrix();
  state.motion.velocity_W = v * Vec3::UnitZ();
  EXPECT_LT(v, 0.0);
  expect_relative(body.hydrodynamics->load(state).drag_W[2], 500.0 * kGravity, 1e-9, "drag");
}

TEST(BodyMotions, TerminalVelocityNeedsDragAlongUp) {
  EXPECT_FALSE(motions_of(box_scene("")).terminal_velocity);
  EXPECT_FALSE(motions_of(box_scene("[body.drag]\nlinear = [1, 1, 0, 1, 1, 1]")).terminal_velocity);
}

TEST(BodyMotions, NeutrallyBuoyantBodyRightsItselfAboutItsCenterOfBuoyancy) {
  const BodyMotions motions =
      motions_of(box_scene("[body.added_mass]\nmatrix = [0, 0, 0, 20, 70, 0]",
                           "mass = 1000\ncenter_of_mass = [0, 0, -0.1]\ninertia = [100, 200, 300]"));
  EXPECT_EQ(motions.balance, VerticalBalance::kNeutral);
  EXPECT_FALSE(motions.draft);
  EXPECT_EQ(motions.terminal_velocity, 0.0);
  const double stiffness = 1000.0 * kGravity * 0.1;
  EXPECT_EQ(motions.natural->heave.frequency, 0.0);
  expect_relative(motions.natural->roll.period(), period(120.0, stiffness), 1e-9, "roll");
  expect_relative(motions.natural->pitch.period(), period(270.0, stiffness), 1e-9, "pitch");
}

TEST(BodyMotions, ReportsWhatNothingRestores) {
  const BodyMotions even = motions_of(box_scene("", "density = 1000"));
  EXPECT_EQ(even.balance, VerticalBalance::kNeutral);
  EXPECT_EQ(even.natural->heave.frequency, 0.0);
  EXPECT_EQ(even.natural->roll.frequency, 0.0) << "rounding is no stiffness";
  EXPECT_EQ(even.natural->pitch.frequency, 0.0);
  EXPECT_EQ(even.max_explicit_step, std::numeric_limits<double>::infinity());
  EXPECT_EQ(even.step_limit, StepLimit::kNone);
  // Its centroid is rounded.
  const BodyMotions ball =
      motions_of(kWorld +
                 "[[body]]\nid = 1\nshape = { type = \"rock\" }\n[body.client]\ndensity = "
                 "1000\norientation = [0.8, 0.3, 0.2, -0.1]\n");
  EXPECT_EQ(ball.natural->roll.frequency, 0.0);
  EXPECT_EQ(ball.natural->pitch.frequency, 0.0);
  EXPECT_EQ(ball.step_limit, StepLimit::kNone);
  const double metacenter = 0.5 * kDraft + kBeam * kBeam / (12.0 * kDraft) - 0.5 * kDepth;
  for (const double offset : {-1e-15, 0.0, 1e-15}) {
    const BodyMotions level =
        motions_of(box_scene("", "mass = 600\ncenter_of_mass = [0, 0, " +
                                     format_shortest(metacenter + offset) + "]\ninertia = [80, 250, 300]"));
    EXPECT_EQ(level.natural->roll.frequency, 0.0) << "with C at the metacentre";
  }
  const BodyMotions heavy_top =
      motions_of(box_scene("", "mass = 600\ncenter_of_mass = [0, 0, 0.6]\ninertia = [80, 250, 300]"));
  EXPECT_EQ(heavy_top.natural->roll.frequency, 0.0) << "it capsizes";
  EXPECT_GT(heavy_top.natural->pitch.frequency, 0.0);
  const BodyMotions stone = motions_of(box_scene("", "density = 2500"));
  EXPECT_EQ(stone.balance, VerticalBalance::kSinks);
  EXPECT_FALSE(stone.draft);
}

TEST(BodyMotions, AddedMassRatioIsThatOfTheWholeMatrix) {
  EXPECT_EQ(motions_of(box_scene("")).added_mass_ratio, 0.0);
  const BodyMotions motions =
      motions_of(box_scene("[body.added_mass]\nmatrix = [50, 300, 900, 0, 0, 0]\ncenter = [0, 0, 0]"));
  expect_relative(motions.added_mass_ratio, 900.0 / 600.0, 1e-12, "ratio");
}

TEST(BodyMotions, OpenMeshFloatsAsLongAsItsBoundaryIsDry) {
  // A box of 1 x 1 x 1 m without its lid.
  const TempDir directory;
  const std::string mesh = directory.write(
      "tub.obj",
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 1 4 3 2\nf 1 2 6 5\nf 2 3 7 "
      "6\nf 3 4 8 7\nf 4 1 5 8\n");
  const auto tub = [&](double mass) {
    return motions_of(kWorld + "[[body]]\nid = 1\nmesh = \"" + mesh + "\"\nopen = \"dry_boundary\"\n" +
                      "[body.client]\nmass = " + std::to_string(mass) +
                      "\ncenter_of_mass = [0.5, 0.5, 0.2]\ninertia = [50, 50, 50]\n");
  };
  const BodyMotions floating = tub(400.0);
  EXPECT_EQ(floating.balance, VerticalBalance::kFloats);
  EXPECT_NEAR(floating.draft.value(), 0.4, 1e-9);
  expect_relative(floating.natural->heave.period(), period(400.0, kDensity * kGravity), 1e-9, "heave");
  EXPECT_FALSE(floating.terminal_velocity);
  const BodyMotions swamped = tub(1200.0);
  EXPECT_EQ(swamped.balance, VerticalBalance::kUnknown);
  EXPECT_FALSE(swamped.natural);
}

TEST(SceneMotions, EqualBodiesShareTheirMotions) {
  const std::string body = "shape = { type = \"box\", size = [2, 1, 0.5] }\n[body.client]\nmass = 600\n";
  const Scene scene =
      prepared(kWorld + "[[body]]\nid = 1\n" + body + "[[body]]\nid = 2\n" + body +
               "position = [5, 0, 0]\n[[body]]\nid = 3\n" + body +
               "orientation = [1, 0.1, 0, 0]\n[[body]]\nid = 4\nshape = { type = \"box\" }\n");
  const std::vector<MotionsOfBody> bodies = scene_motions(scene);
  ASSERT_EQ(bodies.size(), 4U);
  EXPECT_NE(bodies[0].motions, nullptr);
  EXPECT_EQ(bodies[0].motions, bodies[1].motions);
  EXPECT_NE(bodies[0].motions, bodies[2].motions);
  EXPECT_EQ(bodies[3].motions, nullptr) << "without [body.client]";
  EXPECT_FALSE(bodies[2].left_out || bodies[3].left_out);

  // The box has 8 vertices.
  const std::vector<MotionsOfBody> limited = scene_motions(scene, 15);
  EXPECT_NE(limited[0].motions, nullptr);
  EXPECT_NE(limited[1].motions, nullptr);
  EXPECT_EQ(limited[2].motions, nullptr);
  EXPECT_TRUE(limited[2].left_out);
  EXPECT_FALSE(scene_motions(scene, 16)[2].left_out);
}

TEST(SceneMotions, LeaveOutALargeBodyAndNotTheSmallOnesAfterIt) {
  const std::string client = "[body.client]\nmass = 600\n";
  const Scene scene =
      prepared(kWorld + "[[body]]\nid = 1\nshape = { type = \"sphere\", radius = 1, segments = 40 }\n" +
               client + "[[body]]\nid = 2\nshape = { type = \"box\", size = [2, 1, 0.5] }\n" + client);
  const std::vector<MotionsOfBody> bodies = scene_motions(scene, 100);
  EXPECT_TRUE(bodies[0].left_out);
  EXPECT_FALSE(bodies[1].left_out);
  EXPECT_NE(bodies[1].motions, nullptr);
}

// The box of floating_box.h with 100 kg of liquid in a tank on its bottom.
std::string box_with_tank(const std::string& fill_and_density, double own_mass) {
  return kWorld + "[[body]]\nid = 1\nshape = { type = \"box\", size = [2, 1, 0.5] }\n" +
         "[[body.tank]]\nshape = { type = \"box\", size = [1, 0.5, 0.2] }\nposition = [0, 0, -0.15]\n" +
         fill_and_density + "\n[body.client]\nmass = " + format_number(own_mass) +
         "\ninertia = [60, 200, 210]\ncenter_of_mass = [0, 0, 0]\n";
}

TEST(BodyMotions, TanksWithFreeSurfacesLengthenRollAndPitch) {
  const BodyMotions motions = motions_of(box_with_tank("fill = 0.5\ndensity = 2000", 500.0));
  const NaturalMotions& natural = motions.natural.value();
  expect_relative(motions.draft.value(), kDraft, 1e-12, "draft");
  expect_relative(natural.heave.period(), period(600.0, kDensity * kGravity * kWaterplane), 1e-9, "heave");
  const double liquid_height = -0.2;  // [m], of its centroid in B
  const double center = 100.0 * liquid_height / 600.0;
  const auto rotation = [&](double breadth, double own_inertia, double tank_breadth) {
    const double other = 0.5 / tank_breadth;  // [m], of the tank across the axis
    const double free_surface = 2000.0 * other * std::pow(tank_breadth, 3) / 12.0;
    const double height = (0.5 * kDraft - 0.5 * kDepth) - center + breadth * breadth / (12.0 * kDraft);  // GM
    const double stiffness = kGravity * (600.0 * height - free_surface);
    const double inertia = own_inertia + 500.0 * center * center +
                           100.0 * ((tank_breadth * tank_breadth + 0.01) / 12.0 +
                                    (liquid_height - center) * (liquid_height - center));
    return period(inertia, stiffness);
  };
  expect_relative(natural.roll.period(), rotation(kBeam, 60.0, 0.5), 1e-9, "roll");
  expect_relative(natural.pitch.period(), rotation(kLength, 200.0, 1.0), 1e-9, "pitch");
}

TEST(BodyMotions, FullTanksAreBallast) {
  // The same masses as one rigid body: 500 kg, and 100 kg of 1 x 0.5 x 0.2 m.
  const BodyMotions tank = motions_of(box_with_tank("fill = 1\ndensity = 1000", 500.0));
  const double center = 100.0 * -0.15 / 600.0;
  const double moved = 500.0 * center * center + 100.0 * std::pow(-0.15 - center, 2);
  const Vec3 inertia(60.0 + 100.0 / 12.0 * 0.29 + moved, 200.0 + 100.0 / 12.0 * 1.04 + moved,
                     210.0 + 100.0 / 12.0 * 1.25);
  const BodyMotions rigid = motions_of(
      kWorld +
      "[[body]]\nid = 1\nshape = { type = \"box\", size = [2, 1, 0.5] }\n[body.client]\nmass = 600\n" +
      "center_of_mass = [0, 0, -0.025]\ninertia = [" + format_vector(inertia, 17) + "]\n");
  expect_same_motions(tank, rigid, 1e-9);
}

TEST(BodyMotions, FloodedCompartmentsAreCutOut) {
  const std::string client =
      "[body.drag]\nlinear = [1, 1, 1, 1, 1, 1]\nimmersion = \"none\"\n[body.client]\nmass = 300\n"
      "center_of_mass = [-0.4, 0, -0.1]\ninertia = [60, 200, 210]\n";
  const BodyMotions flooded = motions_of(
      kWorld + "[[body]]\nid = 1\nshape = { type = \"box\", size = [2, 1, 0.5] }\n[[body.compartment]]\n" +
      "shape = { type = \"box\", size = [0.8, 1, 0.5] }\nposition = [0.6, 0, 0]\n" + client);
  const BodyMotions cut =
      motions_of(kWorld + "[[body]]\nid = 1\n[[body.part]]\n" +
                 "shape = { type = \"box\", size = [1.2, 1, 0.5] }\nposition = [-0.4, 0, 0]\n" + client);
  EXPECT_EQ(flooded.balance, VerticalBalance::kFloats);
  expect_relative(flooded.draft.value(), 0.25, 1e-12, "draft");
  expect_same_motions(flooded, cut, 1e-9);
}

TEST(BodyMotions, AreThoseOfTheAttitudeAtWhichABodyStarts) {
  // A bar of square section that floats on its edge: it rolls about a GM of 0.2357 m.
  const std::string bar =
      kWorld +
      "[[body]]\nid = 1\nshape = { type = \"box\", size = [4, 1, 1] }\n[body.client]\ndensity = 500\n";
  EXPECT_EQ(motions_of(bar).natural->roll.frequency, 0.0);
  const BodyMotions motions = motions_of(bar + "start = \"equilibrium\"\n");
  expect_relative(motions.draft.value(), std::sqrt(0.5), 1e-9, "draft");
  EXPECT_LT(motions.turning_lever, 1e-9);
  expect_relative(motions.natural->roll.period(),
                  period(2000.0 / 6.0, 2000.0 * kGravity * std::sqrt(2.0) / 6.0), 1e-6, "roll");
}

}  // namespace
}  // namespace buoyancy
