#include "scene/coefficient_warnings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>

#include "base/format.h"
#include "hydrodynamics/coefficient_checks.h"
#include "scene/body_warning_list.h"

namespace buoyancy {
namespace {

constexpr std::array<std::string_view, 6> kAxes{"x", "y", "z", "about x", "about y", "about z"};

// Finds driving twists, and searches equal matrices only once.
class DrivingTwists {
 public:
  std::optional<Vec6> find(const Mat6& quadratic) {
    if (quadratic == Mat6(quadratic.diagonal().asDiagonal())) return std::nullopt;
    std::array<double, 36> key{};
    std::copy(quadratic.data(), quadratic.data() + 36, key.begin());
    const auto known = found_.find(key);
    if (known != found_.end()) return known->second;
    if (found_.size() >= kMaxSearchedMatrices) return std::nullopt;
    return found_.emplace(key, find_driving_twist(quadratic)).first->second;
  }

 private:
  std::map<std::array<double, 36>, std::optional<Vec6>> found_;
};

void warn_of_driving_drag(const Body& body, const Mat6& quadratic, DrivingTwists& twists,
                          BodyWarningList& list) {
  const std::optional<Vec6> twist = twists.find(quadratic);
  if (!twist) return;
  list.add(body,
           {"",
            format_text(
                "[body.drag] quadratic drives the body at a twist of [{:4}, {:4}] (m/s and rad/s, body axes)",
                Vec3(twist->head<3>()), Vec3(twist->tail<3>())),
            "drag that opposes every motion: twist . D2 (|twist| o twist) at least 0",
            "large elements off the diagonal, which were fitted for motions along one axis at a time",
            "Reduce them, or leave them out: energy may grow without a bound at such motions"});
}

// Warns if the centre is farther from the bounding box of the mesh than the length of the box's diagonal.
void warn_of_far_center(const Body& body, std::string_view table, const Vec3& center_B,
                        BodyWarningList& list) {
  const HydrostaticMesh& mesh = body.prepared_mesh->mesh;
  const Vec3 from_center = center_B - mesh.center_B;
  const Vec3 nearest = from_center.cwiseMax(mesh.box_min).cwiseMin(mesh.box_max);
  const double distance = (from_center - nearest).norm();
  if (!(distance > mesh.diagonal)) return;
  list.add(body,
           {"", format_text("{} center = [{}] is {:4} m from the mesh", table, center_B, distance),
            format_text("a point in or near the mesh, whose box has a diagonal of {:4} m", mesh.diagonal),
            "a centre in another frame or unit: it is in m, in the frame of the mesh after scale",
            "Leave center out for the centre of mass, or correct it"});
}

// limit: per coordinate, the largest number that a body of this size may have. The first that exceeds it is
// reported.
void warn_of_size(const Body& body, const std::string& name, const Mat6& matrix, const Vec6& limit,
                  std::string_view unit, std::string_view rotation_unit, std::string_view expected,
                  BodyWarningList& list) {
  for (Eigen::Index i = 0; i < 6; ++i) {
    if (!(matrix(i, i) > limit[i])) continue;
    const std::string_view of_axis = i < 3 ? unit : rotation_unit;
    list.add(
        body,
        {"", format_text("{} {} = {} {}", name, kAxes[static_cast<std::size_t>(i)], matrix(i, i), of_axis),
         format_text("{}: {:4} {} for this mesh", expected, limit[i], of_axis),
         "coefficients of a vehicle of another size, or a mesh in another unit",
         "Check both; set scale for a mesh in millimetres"});
    return;
  }
}

// The limit is 100 times the displaced water or, since a thin plate exceeds that, the water in a cube whose
// edge is the mesh's diagonal.
void warn_of_added_mass(const Body& body, const Mat6& matrix, const Water& water, BodyWarningList& list) {
  const HydrostaticMesh& mesh = body.prepared_mesh->mesh;
  const double L = mesh.diagonal;
  const double mass = water.density * std::max(100.0 * std::abs(mesh.volume), L * L * L);
  Vec6 limit;
  limit << mass, mass, mass, mass * L * L, mass * L * L, mass * L * L;
  warn_of_size(body, "[body.added_mass] matrix", matrix, limit, "kg", "kg m^2",
               "at most 100 times the displaced water", list);
}

// The limit is a drag coefficient of 100 on the whole surface.
void warn_of_quadratic_drag(const Body& body, const Mat6& matrix, const Water& water, BodyWarningList& list) {
  const HydrostaticMesh& mesh = body.prepared_mesh->mesh;
  const double L = mesh.diagonal;
  const double drag = 100.0 * 0.5 * water.density * mesh.area;
  Vec6 limit;
  limit << drag, drag, drag, drag * L * L * L, drag * L * L * L, drag * L * L * L;
  warn_of_size(body, "[body.drag] quadratic", matrix, limit, "N/(m/s)^2", "N m/(rad/s)^2",
               "a drag coefficient of at most 100 on the whole surface", list);
}

void warn_of_missing_bound(const Body& body, BodyWarningList& list) {
  const Method method = body.solver.method();
  if (method == Method::kHierarchical) return;
  list.add(body, {"", "method = \"" + std::string(to_string(method)) + "\" with drag or added mass in waves",
                  "\"hierarchical\"",
                  "the loads are scaled by an immersion that this method gives without an error bound: those "
                  "of the wrench are infinite",
                  "Use hierarchical"});
}

}  // namespace

std::vector<Warning> coefficient_warnings(const Scene& scene) {
  BodyWarningList list;
  DrivingTwists twists;
  const bool has_waves = scene.sea() != nullptr || scene.receives_sea();
  for (const Body& body : scene.bodies()) {
    if (body.hydrodynamics == nullptr) continue;
    const HydrodynamicCoefficients& coefficients = body.hydrodynamics->coefficients();
    if (has_waves) warn_of_missing_bound(body, list);
    if (coefficients.drag) {
      warn_of_driving_drag(body, coefficients.drag->quadratic, twists, list);
      warn_of_far_center(body, "[body.drag]", coefficients.drag->center_B, list);
      warn_of_quadratic_drag(body, coefficients.drag->quadratic, scene.water(), list);
    }
    if (coefficients.added_mass) {
      warn_of_far_center(body, "[body.added_mass]", coefficients.added_mass->center_B, list);
      warn_of_added_mass(body, coefficients.added_mass->matrix, scene.water(), list);
    }
  }
  return list.with_subjects(scene.name());
}

}  // namespace buoyancy
