// Time and error of where and how bodies float: all attitudes of bodies of about 5,000 triangles, a curve of
// righting arms with free trim and a hydrostatic table of hulls of about 100,000. Markdown on standard
// output.
//
// Results are checked before they are timed, against closed forms and against the plain exact method
// (plain_exact.h); a wrong one ends the program with 1. The plain method is also the baseline: it evaluates
// volume and moment at the drafts and trims that the library found, which is the least that a program without
// a moment tree has to do. Times are processor times of the one thread.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <time.h>

#include "fail.h"
#include "flotation/equilibrium.h"
#include "flotation/hydrostatic_table.h"
#include "flotation/righting_arms.h"
#include "geometry/mass_properties.h"
#include "geometry/shapes.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "markdown_table.h"
#include "median.h"
#include "plain_exact.h"

namespace buoyancy::bench {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr int kRepetitions = 5;
const Water kWater;

// [ms], processor time of this thread.
double processor_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

// The shortest of some runs, [ms].
template <typename Run>
double milliseconds(const Run& run) {
  double shortest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kRepetitions; ++i) {
    const double start = processor_time();
    run();
    shortest = std::min(shortest, processor_time() - start);
  }
  return shortest;
}

void require(bool holds, const std::string& reason) {
  if (!holds) fail(reason);
}

struct Hull {
  Hull(std::string hull_name, const Shape& shape)
      : name(std::move(hull_name)), source(make_shape(shape)), mesh(make_hydrostatic_mesh({source, {}})) {}

  FloatingBody body(double mass, const Vec3& center_of_mass_B) const {
    const PlacedMesh placed{.mesh = &mesh};
    return value_or_exit(FloatingBody::make({&placed, 1}, mass, center_of_mass_B));
  }

  std::string name;
  TriangleMesh source;
  HydrostaticMesh mesh;
};

std::string triangles_of(const Hull& hull) {
  return std::to_string(hull.source.triangles.size());
}

// The angle at which a square log of a quarter of the water's density floats: tan^2 = -2 GM/BM = 1/4.
void check_square_log() {
  const Hull log("square log", BoxShape{{8, 1, 1}, {4, 1, 1}});
  const Equilibria found =
      find_equilibria(log.body(0.25 * kWater.density * log.mesh.volume, Vec3::Zero()), kWater);
  require(found.attitudes.size() == 8, "not eight attitudes of the square log");
  for (const Equilibrium& at : found.attitudes) {
    const double tilt = std::remainder(at.angles.heel, 90.0 * kDegree);
    require(std::abs(std::abs(std::tan(tilt)) - 0.5) < 1e-9, "a wrong tilt of the square log");
  }
}

void attitudes_of_bodies() {
  constexpr int kBodies = 12;     // per shape
  constexpr double kLimit = 5.0;  // [ms]
  check_square_log();
  std::printf("### All attitudes of a body\n\n");
  std::printf(
      "%d bodies of each shape, of 0.05 to 0.95 of the water's density, every second one with its centre of\n"
      "mass anywhere in its box, the others of even density. Limit: %.0f ms per body. The error is the "
      "residual\n"
      "over its bound, of force or torque, the largest. The last column is the median in evaluations of the\n"
      "plain exact method, which a search would need for each step and each start.\n\n",
      kBodies, kLimit);
  MarkdownTable table({"shape", "triangles", "attitudes", "error / bound", "median, ms", "worst, ms", "",
                       "in plain evaluations"});
  std::vector<double> all;
  const std::vector<std::pair<std::string, Shape>> shapes{
      {"rock", RockShape{.frequency = 16, .roughness = 0.25}},
      {"rough rock", RockShape{.frequency = 16, .roughness = 0.6, .seed = 2}},
      {"torus knot", TorusKnotShape{.tubular = 250, .radial = 10}},
      {"box", BoxShape{{4, 1.3, 1}, {40, 14, 10}}},
      {"cylinder", CylinderShape{0.5, 3.0, 64, 38}},
      {"cone", ConeShape{0.6, 1.0, 96, 26}},
      {"Wigley hull", WigleyShape{.segments = 68, .levels = 17}},
      {"sphere", SphereShape{}}};
  for (const auto& [name, shape] : shapes) {
    const Hull hull(name, shape);
    const BoundingBox box = bounding_box(hull.source);
    const Vec3 centroid_B = mass_properties(hull.source).centroid_B;
    std::mt19937_64 random(7);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    PlainExact plain(hull.source);
    std::vector<double> times;
    std::vector<double> of_plain;
    std::size_t attitudes = 0;
    double largest = 0.0;
    for (int i = 0; i < kBodies; ++i) {
      const double density = 0.05 + 0.9 * uniform();
      const double x = uniform();
      const double y = uniform();
      const Vec3 share(x, y, uniform());
      const Vec3 center_B =
          i % 2 == 0 ? centroid_B : Vec3(box.min_B + share.cwiseProduct(box.max_B - box.min_B));
      const FloatingBody body = hull.body(density * kWater.density * hull.mesh.volume, center_B);
      const Equilibria found = find_equilibria(body, kWater);
      require(!found.attitudes.empty(), "no attitude of a " + name);
      for (const Equilibrium& at : found.attitudes) {
        largest =
            std::max({largest, at.residual_force / at.force_bound, at.residual_torque / at.torque_bound});
        const PlainWrench wrench = plain(at.pose, kWater, center_B);
        require(std::abs(wrench.volume * kWater.density / body.mass() - 1.0) < 1e-9 &&
                    wrench.torque_W.norm() < 1e-9 * body.mass() * kWater.gravity * hull.mesh.diagonal,
                "an attitude of a " + name + " that the plain method does not confirm");
      }
      attitudes += found.attitudes.size();
      const Pose pose = found.attitudes.front().pose;
      times.push_back(milliseconds([&] { find_equilibria(body, kWater); }));
      of_plain.push_back(milliseconds([&] { plain(pose, kWater, center_B); }));
    }
    require(largest <= 1.0, "a residual beyond its bound");
    const double worst = *std::max_element(times.begin(), times.end());
    all.insert(all.end(), times.begin(), times.end());
    table.add({name, triangles_of(hull), std::to_string(attitudes), format_cell("%.2f", largest),
               format_cell("%.2f", median(times)), format_cell("%.2f", worst), pass_or_fail(worst <= kLimit),
               format_cell("%.0f", median(times) / median(of_plain))});
  }
  table.print(stdout, 1);
  std::printf("Of all bodies: median %.2f ms, worst %.2f ms.\n\n", median(all),
              *std::max_element(all.begin(), all.end()));
}

Hull box_hull() {
  return {"box", BoxShape{{80, 20, 12}, {220, 64, 40}}};
}
Hull wigley_hull() {
  return {"Wigley hull", WigleyShape{.segments = 600, .levels = 40}};
}

// The arm by the plain method at a heel and trim: the height by the secant method.
double plain_arm(PlainExact& plain, const FloatingBody& body, const RightingArm& arm) {
  const Eigen::Quaterniond q = attitude_at({}, {arm.heel, arm.trim}, kWater.up_W);
  const double target = body.mass() / kWater.density;
  const double length = std::cbrt(body.volume());
  // From nearby: a program would start further away.
  const Vec3 up_B = q.conjugate() * kWater.up_W;
  double height = -arm.draft - lowest_along(body, up_B) - up_B.dot(body.center_B()) + 1e-3 * length;
  double last_height = height + 1e-3 * length;
  const auto wrench_at = [&](double z) {
    return plain({z * kWater.up_W, q}, kWater, body.center_of_mass_B());
  };
  double last_excess = wrench_at(last_height).volume - target;
  constexpr int kMaxRounds = 20;
  for (int round = 0;; ++round) {
    const PlainWrench wrench = wrench_at(height);
    const double excess = wrench.volume - target;
    const bool is_found = std::abs(excess) <= 1e-12 * target || excess == last_excess || round == kMaxRounds;
    // The torque about the bow turns the body to port.
    if (is_found)
      return -wrench.torque_W.dot(q * Vec3::UnitX()) / (body.mass() * kWater.gravity * std::cos(arm.trim));
    const double next = height - excess * (height - last_height) / (excess - last_excess);
    last_height = height;
    last_excess = excess;
    height = next;
  }
}

void curves_of_righting_arms() {
  constexpr double kLimit = 500.0;  // [ms]
  std::vector<double> heels;
  for (int i = -36; i < 36; ++i) heels.push_back(5 * i * kDegree);
  std::printf("### A curve of righting arms\n\n");
  std::printf(
      "72 heels from -180 to 175 degrees with free trim, zero crossings and largest arms refined. Limit: "
      "%.0f ms.\n"
      "`plain` finds the height alone, with the trims given. The error is the largest difference of GZ from "
      "it,\n"
      "and for the box that from the figures of its closed form as well.\n\n",
      kLimit);
  MarkdownTable table({"hull", "triangles", "error of GZ, m", "time, ms", "", "plain, ms", "ratio"});
  for (const bool is_box : {true, false}) {
    const Hull hull = is_box ? box_hull() : wigley_hull();
    // The box floats at half its depth with KG 8 m. The centre of mass of the hull is aft of its middle.
    const FloatingBody body = is_box
                                  ? hull.body(0.5 * kWater.density * hull.mesh.volume, Vec3(0, 0, 2))
                                  : hull.body(0.4 * kWater.density * hull.mesh.volume, Vec3(-0.3, 0, -0.25));
    const auto curve = righting_curve(body, kWater, heels);
    require(curve.has_value(), "no righting arms of the " + hull.name);
    PlainExact plain(hull.source);
    double error = 0.0;
    for (const RightingCurvePoint& point : curve->points) {
      error = std::max(error, std::abs(point.arm.gz - plain_arm(plain, body, point.arm)));
      if (!is_box) continue;
      constexpr std::array<std::pair<int, double>, 8> kFigures{{{10, 0.11146824},
                                                                {20, 0.315869218},
                                                                {30, 0.740740741},
                                                                {40, 0.972596655},
                                                                {50, 0.638956531},
                                                                {60, 0.067949192},
                                                                {75, -0.959488704},
                                                                {90, -2.0}}};
      for (const auto& [heel, gz] : kFigures) {
        if (std::abs(std::abs(point.arm.heel) - heel * kDegree) > 1e-9) continue;
        error = std::max(error, std::abs(point.arm.gz - std::copysign(gz, point.arm.heel * gz)));
      }
    }
    require(error < 2e-9, "wrong righting arms of the " + hull.name);
    const double time = milliseconds([&] { righting_curve(body, kWater, heels); });
    const double of_plain = milliseconds([&] {
      for (const RightingCurvePoint& point : curve->points) plain_arm(plain, body, point.arm);
    });
    table.add({hull.name, triangles_of(hull), format_cell("%.1e", error), format_cell("%.1f", time),
               pass_or_fail(time <= kLimit), format_cell("%.0f", of_plain),
               format_cell("%.0f", of_plain / time)});
  }
  table.print(stdout, 1);
}

double relative_error(double found, double expected) {
  return std::abs(found / expected - 1.0);
}

// The largest relative error of a row at the design draft.
double error_of_form(const Hull& hull, const HydrostaticTable& table, bool is_box) {
  if (is_box) {
    const auto row = table.row(6.0);
    return std::max({relative_error(row->volume, 9600), relative_error(row->kb, 3),
                     relative_error(row->bm_t, 400.0 / 72), relative_error(row->bm_l, 6400.0 / 72),
                     relative_error(row->on_lpp.block, 1)});
  }
  const WigleyShape form;
  const double L = form.length;
  const double B = form.beam;
  const double T = form.draft;
  const auto row = table.row(T);
  require(row.has_value(), "no row of the " + hull.name);
  return std::max({relative_error(row->volume, 4 * L * B * T / 9), relative_error(row->kb, 5 * T / 8),
                   relative_error(row->bm_t, 3 * B * B / (35 * T)),
                   relative_error(row->bm_l, 3 * L * L / (40 * T)), relative_error(row->midship, 2.0 / 3),
                   relative_error(row->on_lpp.waterplane, 2.0 / 3)});
}

void tables_of_hulls() {
  constexpr double kLimit = 500.0;  // [ms]
  std::printf("### A hydrostatic table\n\n");
  std::printf(
      "100 drafts and 5 trims, all columns, after the preparation of the table. Limit: %.0f ms. `plain`\n"
      "finds volume and moment alone. The errors are relative: the largest of volumes from `plain`, and of "
      "V, KB,\n"
      "BM and coefficients at the design draft from the closed form of the smooth hull.\n\n",
      kLimit);
  MarkdownTable table({"hull", "triangles", "error of V", "of the form", "preparation, ms", "time, ms", "",
                       "plain, ms", "ratio"});
  for (const bool is_box : {true, false}) {
    const Hull hull = is_box ? box_hull() : wigley_hull();
    const FloatingBody body = hull.body(0.5 * kWater.density * hull.mesh.volume, Vec3::Zero());
    const HydrostaticTable rows = value_or_exit(HydrostaticTable::make(body, kWater));
    std::vector<std::pair<double, double>> places;  // draft and trim
    const double deepest = is_box ? 11.0 : 0.625;
    for (int i = 1; i <= 100; ++i) {
      for (int trim = -2; trim <= 2; ++trim) places.emplace_back(0.01 * i * deepest, 0.5 * trim * kDegree);
    }
    PlainExact plain(hull.source);
    const auto plain_volume = [&](const std::pair<double, double>& place) {
      const auto& [draft, trim] = place;
      const Eigen::Quaterniond q = attitude_at({}, {0.0, trim}, kWater.up_W);
      const Vec3 on_water_B(rows.midship(), 0.0, rows.keel() + draft);
      return plain({Vec3(0, 0, -(q * on_water_B).z()), q}, kWater, Vec3::Zero()).volume;
    };
    double error = 0.0;
    for (const auto& place : places) {
      const auto row = rows.row(place.first, place.second);
      require(row.has_value(), "no row of the " + hull.name);
      error = std::max(error, relative_error(row->volume, plain_volume(place)));
    }
    const double of_form = error_of_form(hull, rows, is_box);
    require(error < 1e-9 && of_form < (is_box ? 1e-12 : 1e-3), "a wrong table of the " + hull.name);
    const double preparation = milliseconds([&] { value_or_exit(HydrostaticTable::make(body, kWater)); });
    const double time = milliseconds([&] {
      for (const auto& [draft, trim] : places) rows.row(draft, trim);
    });
    const double of_plain = milliseconds([&] {
      for (const auto& place : places) plain_volume(place);
    });
    table.add({hull.name, triangles_of(hull), format_cell("%.1e", error), format_cell("%.1e", of_form),
               format_cell("%.2f", preparation), format_cell("%.1f", time), pass_or_fail(time <= kLimit),
               format_cell("%.0f", of_plain), format_cell("%.0f", of_plain / time)});
  }
  table.print(stdout, 1);
}

}  // namespace
}  // namespace buoyancy::bench

int main() {
  using namespace buoyancy::bench;
  attitudes_of_bodies();
  curves_of_righting_arms();
  tables_of_hulls();
  return 0;
}
