// Fuzz target: bytes as the text of a scene file. A rejection must state its reason on one line; an accepted
// scene must be within the ranges of docs/scene_file.md. If every body is a small generated shape and the sea
// has few components, the scene is also prepared, reported on and evaluated for each body. No mesh is read.
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <type_traits>
#include <variant>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "hydrostatics/buoyancy.h"
#include "scene/scene.h"
#include "scene/scene_report.h"
#include "tests/fuzz/fuzz_check.h"
#include "waves/sea_ranges.h"
#include "waves/wave_spectrum.h"

namespace buoyancy {
namespace {

// Of all bodies and of all wave systems together, to keep the fuzzer fast.
constexpr std::int64_t kMaxTriangles = 1500;
constexpr std::size_t kMaxComponents = 20;

// The formulas of docs/scene_file.md, "Shapes".
std::int64_t triangle_count(const Shape& shape) {
  const auto count = [](const auto& s) -> std::int64_t {
    using S = std::decay_t<decltype(s)>;
    if constexpr (std::is_same_v<S, BoxShape>) {
      const auto& [a, b, c] = s.segments;
      return 4 * (std::int64_t{a} * b + std::int64_t{b} * c + std::int64_t{c} * a);
    } else if constexpr (std::is_same_v<S, SphereShape>) {
      return 2 * std::int64_t{s.segments} * s.segments;
    } else if constexpr (std::is_same_v<S, CylinderShape>) {
      return 2 * std::int64_t{s.segments} * (std::int64_t{s.stacks} + 1);
    } else if constexpr (std::is_same_v<S, ConeShape>) {
      return 2 * std::int64_t{s.segments} * s.stacks;
    } else if constexpr (std::is_same_v<S, TorusKnotShape>) {
      return 2 * std::int64_t{s.tubular} * s.radial;
    } else if constexpr (std::is_same_v<S, WigleyShape>) {
      return 4 * std::int64_t{s.segments} * (std::int64_t{s.levels} + 1) + 2 * std::int64_t{s.segments} - 2;
    } else {
      static_assert(std::is_same_v<S, RockShape>);
      return 20 * std::int64_t{s.frequency} * s.frequency;
    }
  };
  return std::visit(count, shape);
}

void check_error(const Error& error) {
  const std::string message = error.message();
  require(message.starts_with("fuzz.toml"), "an error names the file");
  require(!error.actual.empty() && !error.expected.empty(), "an error states actual and expected");
  const bool one_line = std::none_of(message.begin(), message.end(), [](char c) {
    const auto code = static_cast<unsigned char>(c);
    return code < 0x20 || code == 0x7f;
  });
  require(one_line, "an error is one line without control characters");
}

void check_water(const Water& water) {
  require(std::abs(water.up_W.norm() - 1.0) <= 1e-15, "up is a unit vector");
  require(std::isfinite(water.level), "the level is finite");
  require(std::isfinite(water.density) && water.density >= 0.0, "the density is at least 0");
  require(std::isfinite(water.gravity) && water.gravity >= 0.0, "gravity is at least 0");
}

void check_system(const RegularWave& wave) {
  require(sea_ranges::kHeight.contains(wave.height) && sea_ranges::kPeriod.contains(wave.period) &&
              sea_ranges::kAngle.contains(wave.direction) && sea_ranges::kAngle.contains(wave.phase),
          "a regular wave is within its ranges");
}

void check_system(const IrregularWaves& waves) {
  require(sea_ranges::kHeight.contains(waves.significant_wave_height) &&
              sea_ranges::kPeriod.contains(waves.peak_period) &&
              sea_ranges::kAngle.contains(waves.direction) && sea_ranges::kCutoff.contains(waves.cutoff),
          "a spectrum is within its ranges");
  require(!waves.gamma || sea_ranges::kGamma.contains(*waves.gamma), "gamma is within its range");
  require(!waves.spreading || sea_ranges::kSpreading.contains(*waves.spreading),
          "the spreading is within its range");
  require(sea_ranges::kBins.contains(waves.frequencies.value_or(1)) &&
              sea_ranges::kBins.contains(waves.directions),
          "the numbers of bins are within their range");
  require(waves.spreading || waves.directions == 1, "long-crested waves have one direction");
}

void check_system(const WaveComponents& components) {
  for (const WaveComponent& component : components) {
    require(sea_ranges::kHeight.contains(component.amplitude) &&
                sea_ranges::kAngularFrequency.contains(component.angular_frequency) &&
                sea_ranges::kAngle.contains(component.direction) &&
                sea_ranges::kAngle.contains(component.phase),
            "a component is within its ranges");
  }
}

void check_sea(const SeaDescription& sea) {
  require(sea.depth > 0.0, "the depth is above 0");
  require(sea_ranges::kRamp.contains(sea.ramp), "the ramp is within its range");
  for (const WaveSystem& system : sea.systems) {
    std::visit([](const auto& waves) { check_system(waves); }, system);
  }
}

void check_dynamics(const DynamicsSpec& dynamics) {
  require(!(dynamics.mass && dynamics.density), "mass and density exclude each other");
  for (const auto& given : {dynamics.mass, dynamics.density}) {
    require(!given || (std::isfinite(*given) && *given > 0.0), "mass and density are above 0");
  }
  require(!dynamics.center_of_mass_B || dynamics.center_of_mass_B->allFinite(),
          "the centre of mass is finite");
  if (dynamics.inertia_B) {
    require(dynamics.inertia_B->allFinite() && Eigen::LLT<Mat3>(*dynamics.inertia_B).info() == Eigen::Success,
            "the inertia is positive definite");
  }
  require(dynamics.position.allFinite() && dynamics.linear_velocity.allFinite() &&
              dynamics.angular_velocity.allFinite(),
          "position and velocities are finite");
  require(std::abs(dynamics.orientation.norm() - 1.0) <= 1e-15, "the orientation is a unit quaternion");
  for (const double damping : {dynamics.linear_damping, dynamics.linear_damping_quadratic,
                               dynamics.angular_damping, dynamics.angular_damping_quadratic}) {
    require(std::isfinite(damping) && damping >= 0.0, "damping is at least 0");
  }
}

// Does a motion lose energy by drag, or gain none by added mass? The limits of coefficient_checks.h allow for
// rounded digits.
bool is_semidefinite(const Mat6& matrix) {
  const Mat6 symmetric = 0.5 * matrix + 0.5 * matrix.transpose();
  const double least = Eigen::SelfAdjointEigenSolver<Mat6>(symmetric / std::max(1.0, symmetric.norm()))
                           .eigenvalues()
                           .minCoeff();
  return least >= -1e-6;
}

void check_coefficients(const BodyDescription& body) {
  if (body.drag) {
    require(body.drag->linear.allFinite() && body.drag->quadratic.allFinite(), "drag is finite");
    require(is_semidefinite(body.drag->linear) && is_semidefinite(body.drag->quadratic),
            "drag opposes every motion");
    require(!body.drag->center_B || body.drag->center_B->allFinite(), "the centre of drag is finite");
  }
  if (body.added_mass) {
    const Mat6& matrix = body.added_mass->matrix;
    require(matrix.allFinite() && matrix == matrix.transpose(), "added mass is finite and symmetric");
    require(is_semidefinite(matrix), "added mass has no negative kinetic energy");
    require(!body.added_mass->center_B || body.added_mass->center_B->allFinite(),
            "the centre of added mass is finite");
  }
}

void check_description(const SceneDescription& scene) {
  check_water(scene.water);
  check_sea(scene.sea);
  require(!scene.bodies.empty(), "a scene has a body");
  std::set<std::int32_t> ids;
  for (const BodyDescription& body : scene.bodies) {
    require(ids.insert(body.id).second, "ids are unique");
    require(!body.name.empty() && !body.source_location.empty(), "a body has a name and a source location");
    require(body.mesh.placement.scale.allFinite() && (body.mesh.placement.scale.array() != 0.0).all(),
            "a scale is finite and not 0");
    const double tolerance = body.tolerance.value_or(0.0);
    require(tolerance >= 0.0 && tolerance <= 1.0, "a tolerance is from 0 to 1");
    require(body.reference_B.allFinite(), "the reference point is finite");
    if (const auto* file = std::get_if<MeshFile>(&body.mesh.source)) {
      require(!file->path.empty(), "a mesh file has a name");
    } else {
      require(check_shape(std::get<Shape>(body.mesh.source)).has_value(), "a shape is within its ranges");
    }
    check_dynamics(body.dynamics);
    check_coefficients(body);
  }
  require(scene.sea.current_W.allFinite(), "the current is finite");
  require(scene.water.layers.size() <= kMaxWaterLayers, "the layers are limited");
  double height = scene.water.level;
  double density = scene.water.density;
  for (const WaterLayer& layer : scene.water.layers) {
    require(layer.below < height && layer.density >= density && density > 0.0, "layers are stable");
    height = layer.below;
    density = layer.density;
  }
  require(scene.current_profile.size() <= kMaxCurrentPoints, "the profile is limited");
  for (const CurrentPoint& point : scene.current_profile) {
    require(point.velocity_W.allFinite() && std::isfinite(point.height), "the profile is finite");
  }
}

bool is_small_and_generated(const SceneDescription& scene) {
  std::size_t components = 0;
  for (const WaveSystem& system : scene.sea.systems) components += number_of_components(system);
  if (components > kMaxComponents) return false;
  std::int64_t triangles = 0;
  for (const BodyDescription& body : scene.bodies) {
    const auto* shape = std::get_if<Shape>(&body.mesh.source);
    if (shape == nullptr) return false;
    triangles += triangle_count(*shape);
    if (triangles > kMaxTriangles) return false;
  }
  return true;
}

void check_prepared(const SceneDescription& description) {
  const Expected<Scene> scene = Scene::prepare(description);
  if (!scene) return check_error(scene.error());
  require(scene->bodies().size() == description.bodies.size(), "every body is prepared");
  for (std::size_t i = 0; i < scene->bodies().size(); ++i) {
    const BodyDescription& body = description.bodies[i];
    require((scene->bodies()[i].hydrodynamics != nullptr) == (body.drag || body.added_mass),
            "a body has hydrodynamics if it has drag or added mass");
  }
  const SceneReportOptions with_motions{.motions = true};
  require(!scene_report_text(*scene, with_motions).empty() &&
              scene_report_json(*scene, with_motions).ends_with("\n"),
          "the reports are not empty");
  for (const Body& body : scene->bodies()) {
    const Pose pose{.p_WB = body.dynamics.position, .q_WB = body.dynamics.orientation};
    const BuoyancyResult result = buoyancy(body.solver, pose, scene->water(), body.reference_B);
    require(result.status != BuoyancyStatus::kOpenEdgeWet, "a generated shape is closed");
    require(result.force_W.allFinite() && result.torque_W.allFinite() && std::isfinite(result.volume) &&
                result.center_of_buoyancy_W.allFinite(),
            "a result holds finite numbers");
  }
}

void check(std::string_view text) {
  const Expected<SceneDescription> scene = parse_scene(text, "fuzz.toml", "/nowhere");
  if (!scene) return check_error(scene.error());
  check_description(*scene);
  if (is_small_and_generated(*scene)) check_prepared(*scene);
}

}  // namespace
}  // namespace buoyancy

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  buoyancy::check({reinterpret_cast<const char*>(data), size});
  return 0;
}
