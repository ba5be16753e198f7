#include "tests/stress/exact_truth.h"

#include <cmath>
#include <vector>

#include "hydrostatics/triangle_clip.h"
#include "tests/truth/exact_oracle.h"
#include "tests/truth/rational.h"

namespace buoyancy {

void check_result(StressCase& stress, const StressedBody& body, const BuoyancyResult& result,
                  const Truth& truth, const Vec3& reference_B, double factor, const std::string& where) {
  stress.require(result.status == BuoyancyStatus::kOk, "the status of " + where);
  const double gate = factor * body.volume_tolerance();
  const double torque_gate = factor * body.torque_tolerance(reference_B);
  stress.check(truth.volume_error(result.volume, gate), gate, "volume, " + where);
  stress.check(truth.force_error(result.force_W, gate), gate, "force, " + where);
  stress.check(truth.torque_error(result.torque_W, torque_gate), torque_gate, "torque, " + where);
}

void check_result(StressCase& stress, const StressedBody& body, const BuoyancyResult& result,
                  const BuoyancyResult& other, const Vec3& reference_B, double factor,
                  const std::string& where) {
  stress.check(std::abs(result.volume - other.volume), factor * body.volume_tolerance(), "volume, " + where);
  stress.check((result.torque_W - other.torque_W).norm(), factor * body.torque_tolerance(reference_B),
               "torque, " + where);
}

void check_exactly(StressCase& stress, const StressedBody& body, const Pose& pose, const Water& water,
                   const Vec3& reference_B, const std::string& where, double factor) {
  const Truth truth({&body.source}, pose, water, reference_B);
  visit_exact_solvers(body.mesh, [&](const std::string& method, const Solver& solver) {
    check_result(stress, body, buoyancy(solver, pose, water, reference_B), truth, reference_B,
                 factor * depth_factor(solver, pose, water), body.name + ", " + method + where);
  });
}

TrueWaterplane true_waterplane(const TriangleMesh& mesh, const Pose& pose, const Water& water,
                               double raised) {
  const ExactPlane<Rational> plane = exact_plane<Rational>(pose, water);
  const Vec3T<Rational>& k = plane.up_B;
  const Rational h = plane.h + Rational(raised);
  const auto corner = [&](std::int32_t i) {
    const Vec3T<Rational> x = mesh.vertex(i).cast<Rational>();
    return ClipVertex<Rational>{Point<Rational>::from(x), Rational(k.dot(x) - h)};
  };
  const auto as_double = [](const Vec3T<Rational>& v) {
    return Vec3(v.x().convert_to<double>(), v.y().convert_to<double>(), v.z().convert_to<double>());
  };
  const auto twice_projected = [&](const auto& a, const auto& b, const auto& c) {
    return Rational(k.dot(cross(b.y - a.y, c.y - a.y).vec3()));
  };
  TrueWaterplane found;
  // Twice the wetted surface's area projected on the water plane; the waterplane has the opposite sign.
  Rational twice_area(0);
  for (const Triangle& triangle : mesh.triangles) {
    const ClipVertex<Rational> a = corner(triangle[0]);
    const ClipVertex<Rational> b = corner(triangle[1]);
    const ClipVertex<Rational> c = corner(triangle[2]);
    const int wet = int(a.wet()) + int(b.wet()) + int(c.wet());
    if (wet == 3) twice_area += twice_projected(a, b, c);
    if (wet == 0 || wet == 3) continue;
    if (wet == 2) found.cut_area += std::abs(twice_projected(a, b, c).convert_to<double>()) / 2.0;
    std::vector<Vec3> on_water;
    for_each_wet_triangle(a, b, c, [&](const auto& p, const auto& q, const auto& r) {
      twice_area += twice_projected(p, q, r);
      for (const auto* one : {&p, &q, &r}) {
        if (one->z == Rational(0)) on_water.push_back(as_double(one->y.vec3()));
      }
    });
    if (!on_water.empty()) found.perimeter += (on_water.front() - on_water.back()).norm();
  }
  found.area = std::abs(twice_area.convert_to<double>()) / 2.0;
  return found;
}

}  // namespace buoyancy
