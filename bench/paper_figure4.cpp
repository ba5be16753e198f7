// Reproduces the paper's figure 4: a unit cube and a unit sphere are lowered into the water with rho g = 1,
// and the force of every method is compared with the closed forms of section 5. CSV on standard output, one
// row per mesh, method and height.
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "geometry/shapes.h"
#include "hydrostatics/buoyancy.h"
#include "unit_water.h"

namespace buoyancy::bench {
namespace {

struct Case {
  std::string name;
  Shape shape;
  double reach;  // [m], h runs from -reach to reach
  double whole;  // [m^3], closed form at h = -reach
  std::function<double(double)> force;
};

void run() {
  const auto cube = [](double h) { return 0.5 - h; };
  const auto sphere = [](double h) { return std::numbers::pi / 3.0 * (h - 1.0) * (h - 1.0) * (h + 2.0); };
  const double ball = 4.0 * std::numbers::pi / 3.0;
  const std::vector<Case> cases{
      {"cube", BoxShape{.segments = {10, 10, 10}}, 0.5, 1.0, cube},
      {"cube", BoxShape{.segments = {100, 100, 100}}, 0.5, 1.0, cube},
      {"sphere", SphereShape{.radius = 1.0, .segments = 50}, 1.0, ball, sphere},
      {"sphere", SphereShape{.radius = 1.0, .segments = 200}, 1.0, ball, sphere},
  };
  constexpr int kSteps = 200;

  std::printf("shape,triangles,method,h,force,closed_form,error_of_whole\n");
  for (const Case& c : cases) {
    const HydrostaticMesh mesh = make_hydrostatic_mesh({make_shape(c.shape), {}});
    for (const Method method : kAllMethods) {
      const Solver solver(mesh, method);
      for (int step = 1; step < kSteps; ++step) {
        const double h = c.reach * (2.0 * step / kSteps - 1.0);
        const Pose pose{Vec3(0, 0, h), Eigen::Quaterniond::Identity()};
        const double force = buoyancy(solver, pose, kUnitWater, Vec3::Zero()).force_W.z();
        std::printf("%s,%zu,%s,%.17g,%.17g,%.17g,%.17g\n", c.name.c_str(), mesh.surface.triangles.size(),
                    std::string(to_string(method)).c_str(), h, force, c.force(h),
                    (force - c.force(h)) / c.whole);
      }
    }
  }
}

}  // namespace
}  // namespace buoyancy::bench

int main() {
  buoyancy::bench::run();
}
