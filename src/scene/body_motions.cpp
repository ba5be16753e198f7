#include "scene/body_motions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "hydrodynamics/small_motions.h"
#include "hydrostatics/buoyancy.h"
#include "hydrostatics/displacement_moments.h"
#include "scene/body_key.h"
#include "scene/floating_bodies.h"
#include "scene/start_pose.h"

namespace buoyancy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

constexpr double kHeaveAmplitude = 0.05;    // over the mesh's diagonal
constexpr double kRotationAmplitude = 0.1;  // [rad]

// Columns: e1, e2 and up in W.
Mat3 heave_axes_W(const Mat3& R_WB, const Vec3& up_W) {
  const Vec3 x_W = R_WB.col(0);
  const Vec3 forward_W = std::abs(up_W.dot(x_W)) > 0.9 ? Vec3(R_WB.col(1)) : x_W;
  Mat3 axes;
  axes.col(0) = (forward_W - up_W.dot(forward_W) * up_W).normalized();
  axes.col(1) = up_W.cross(axes.col(0));
  axes.col(2) = up_W;
  return axes;
}

// The body in one state of immersion.
struct State {
  double volume_fraction = 1.0;
  double area_fraction = 1.0;
  Mat6 stiffness_W = Mat6::Zero();  // about C
};

double factor(ImmersionScaling scaling, const State& state) {
  switch (scaling) {
    case ImmersionScaling::kVolume:
      return state.volume_fraction;
    case ImmersionScaling::kWettedArea:
      return state.area_fraction;
    case ImmersionScaling::kNone:
      break;
  }
  return 1.0;
}

// Matrices in E about C.
class MotionMatrices {
 public:
  MotionMatrices(const Body& body, const RigidBodyMass& rigid, const Water& water, const Vec3& current_W)
      : coefficients_(body.hydrodynamics == nullptr ? HydrodynamicCoefficients{}
                                                    : body.hydrodynamics->coefficients()),
        center_of_mass_B_(rigid.center_of_mass_B),
        R_WB_(body.dynamics.orientation.normalized().toRotationMatrix()),
        axes_W_(heave_axes_W(R_WB_, water.up_W)),
        R_EB_(axes_W_.transpose() * R_WB_) {
    rigid_.topLeftCorner<3, 3>() = rigid.mass * Mat3::Identity();
    rigid_.bottomRightCorner<3, 3>() = R_EB_ * rigid.inertia_B * R_EB_.transpose();
    if (coefficients_.drag) {
      given_twist_B_ =
          relative_twist_B({R_WB_, body.dynamics.linear_velocity, body.dynamics.angular_velocity},
                           coefficients_.drag->center_B, current_W);
    }
  }

  const Mat3& R_WB() const { return R_WB_; }
  const Mat6& rigid_mass() const { return rigid_; }
  // nu of [body.client] at the drag's centre.
  const Vec6& given_twist_B() const { return given_twist_B_; }

  Mat6 added_mass(const State& state) const {
    if (!coefficients_.added_mass) return Mat6::Zero();
    const AddedMassCoefficients& added = *coefficients_.added_mass;
    return in_axes(factor(added.immersion, state) * added.matrix, added.center_B);
  }
  Mat6 mass(const State& state) const { return rigid_ + added_mass(state); }
  Mat6 damping(const State& state, const Vec6& twist_B) const {
    if (!coefficients_.drag) return Mat6::Zero();
    const DragCoefficients& drag = *coefficients_.drag;
    const Mat6 jacobian = drag.linear + drag.quadratic * (2.0 * twist_B.cwiseAbs()).asDiagonal();
    return in_axes(factor(drag.immersion, state) * jacobian, drag.center_B);
  }
  Mat6 stiffness(const State& state) const { return rotated(state.stiffness_W, axes_W_.transpose()); }

  // The damping ratio of quadratic drag for a motion of this shape.
  double quadratic_ratio(const State& state, const MotionMode& mode, double amplitude) const {
    if (!coefficients_.drag) return 0.0;
    const DragCoefficients& drag = *coefficients_.drag;
    Vec6 shape_B;
    shape_B.head<3>() = R_EB_.transpose() * mode.shape.head<3>();
    shape_B.tail<3>() = R_EB_.transpose() * mode.shape.tail<3>();
    return factor(drag.immersion, state) *
           quadratic_damping_ratio(twist_at(shape_B, drag.center_B - center_of_mass_B_), drag.quadratic,
                                   amplitude);
  }

 private:
  Mat6 in_axes(const Mat6& matrix_B, const Vec3& center_B) const {
    return rotated(matrix_at(matrix_B, center_of_mass_B_ - center_B), R_EB_);
  }

  HydrodynamicCoefficients coefficients_;
  Vec3 center_of_mass_B_;
  Mat3 R_WB_;
  Mat3 axes_W_;
  Mat3 R_EB_;
  Mat6 rigid_ = Mat6::Zero();
  Vec6 given_twist_B_ = Vec6::Zero();
};

// Returns the rounding error [N/m] of the heave stiffness. A lever or its square scales it to rotations.
double stiffness_error(const HydrostaticMesh& mesh, const Water& water) {
  return 64.0 * kEpsilon * deepest_density(water) * water.gravity * mesh.area;
}

// What a body displaces fully submerged.
struct Displaced {
  double volume = 0.0;          // [m^3]
  Vec3 lever_B = Vec3::Zero();  // [m], from the centre of mass to its centroid
};

// A body as it floats: its mesh, without the compartments that are open to the sea, and its mass, with the
// liquids frozen at one attitude.
class LoadedBody {
 public:
  LoadedBody(const Body& body, const HydrostaticMesh& mesh, const RigidBodyMass& own, const Vec3& up_B)
      : mesh_(&mesh),
        own_(own),
        total_(mass_with_liquids(body, own, nullptr, up_B)),
        tanks_(tanks_of(body)),
        compartments_(open_compartments(body)) {}

  const HydrostaticMesh& mesh() const { return *mesh_; }
  const RigidBodyMass& total() const { return total_; }

  Displaced submerged() const {
    const auto lever_of = [&](const HydrostaticMesh& mesh) {
      return Vec3(mesh.center_B - total_.center_of_mass_B + mesh.centroid);
    };
    Displaced sum{mesh_->volume, lever_of(*mesh_)};
    if (compartments_.empty()) return sum;
    Vec3 moment = sum.volume * sum.lever_B;
    for (const PlacedMesh& compartment : compartments_) {
      const double lost = -compartment.signed_permeability * compartment.mesh->volume;
      sum.volume -= lost;
      moment -= lost * lever_of(*compartment.mesh);
    }
    sum.lever_B = moment / sum.volume;
    return sum;
  }

  // Finds the pose at which the body floats. The stiffness is about the centre of mass. q_WB: unit.
  std::optional<FloatingPose> afloat(const Eigen::Quaterniond& q_WB, const Water& water) const {
    std::vector<PlacedMesh> meshes = compartments_;
    meshes.insert(meshes.begin(), {.mesh = mesh_});
    const Expected<FloatingBody> floating = FloatingBody::make(meshes, total_.mass, total_.center_of_mass_B);
    return floating ? find_floating_pose(*floating, q_WB, water) : std::nullopt;
  }

  State floating_state(const FloatingPose& floating, const Water& water) const {
    double volume = floating.state.hydrostatics.volume;
    if (!compartments_.empty()) {
      volume = buoyancy(Solver(*mesh_, Method::kHierarchical), floating.pose, water, Vec3::Zero()).volume;
    }
    return {.volume_fraction = mesh_->is_open() ? 1.0 : std::min(1.0, volume / mesh_->volume),
            .area_fraction = std::min(1.0, floating.state.hydrostatics.wetted_area / mesh_->area),
            .stiffness_W = floating.state.hydrostatics.stiffness + of_weights(floating.pose.q_WB, water)};
  }

  State submerged_state(const Displaced& displaced, const Eigen::Quaterniond& q_WB,
                        const Water& water) const {
    DisplacementMoments<double> moments;
    moments.volume = displaced.volume;
    moments.moment = displaced.volume * (q_WB * displaced.lever_B);
    State state{.stiffness_W = deepest_density(water) * water.gravity * stiffness(moments, water.up_W) +
                               of_weights(q_WB, water)};
    const double rounding = stiffness_error(*mesh_, water) * mesh_->diagonal * mesh_->diagonal;
    if (state.stiffness_W.cwiseAbs().maxCoeff() <= rounding) state.stiffness_W.setZero();
    return state;
  }

 private:
  Mat6 of_weights(const Eigen::Quaterniond& q_WB, const Water& water) const {
    return stiffness_of_weights(own_, tanks_, total_.center_of_mass_B, q_WB, water);
  }

  const HydrostaticMesh* mesh_;
  RigidBodyMass own_, total_;  // without and with the liquids
  std::vector<Tank> tanks_;
  std::vector<PlacedMesh> compartments_;
};

// coordinate: the index in the mode's shape that names it. A stiffness within its rounding error is none.
NaturalMotion natural_motion(const MotionMatrices& matrices, const State& state, const MotionMode& mode,
                             Eigen::Index coordinate, double amplitude, double lever, double error) {
  const double size = mode.shape.head<3>().norm() + lever * mode.shape.tail<3>().norm();
  if (!(mode.stiffness > error * size * size)) return {};
  NaturalMotion motion;
  motion.frequency = std::sqrt(mode.stiffness);
  motion.amplitude = amplitude;
  motion.damping_ratio = damping_ratio(mode, matrices.damping(state, Vec6::Zero()));
  motion.damping_ratio_at_amplitude =
      motion.damping_ratio +
      matrices.quadratic_ratio(state, mode, amplitude / std::abs(mode.shape[coordinate]));
  return motion;
}

std::optional<NaturalMotions> natural_motions(const MotionMatrices& matrices, const State& state,
                                              const HydrostaticMesh& mesh, const Vec3& center_of_mass_B,
                                              const Water& water) {
  const std::optional<HeaveRollPitch> modes =
      heave_roll_pitch(matrices.mass(state), matrices.stiffness(state));
  if (!modes) return std::nullopt;
  const double lever = mesh.max_lever_arm(center_of_mass_B);
  const double error = stiffness_error(mesh, water);
  const auto motion = [&](const MotionMode& mode, Eigen::Index coordinate, double amplitude) {
    return natural_motion(matrices, state, mode, coordinate, amplitude, lever, error);
  };
  return NaturalMotions{.heave = motion(modes->heave, 2, kHeaveAmplitude * mesh.diagonal),
                        .roll = motion(modes->roll, 3, kRotationAmplitude),
                        .pitch = motion(modes->pitch, 4, kRotationAmplitude)};
}

// Lowers the step of `motions` to that of a state. Returns false where it is beyond double's range.
bool limit_step(const MotionMatrices& matrices, const State& state, const Vec6& twist_B, StepLimit limit,
                BodyMotions& motions) {
  const std::optional<double> step =
      max_explicit_step(matrices.mass(state), matrices.damping(state, twist_B), matrices.stiffness(state));
  if (!step) return false;
  if (*step < motions.max_explicit_step) {
    motions.max_explicit_step = *step;
    motions.step_limit = limit;
  }
  return true;
}

// [m/s], at the centre of the drag where the body starts.
Vec3 current_at_start(const Body& body, const Scene& scene) {
  if (body.hydrodynamics == nullptr || !body.hydrodynamics->coefficients().drag) return scene.current_W();
  const Vec3& center_B = body.hydrodynamics->coefficients().drag->center_B;
  return scene.current().at(scene.water(), body.dynamics.position + body.dynamics.orientation * center_B);
}

// Everything that the motions of a body depend on, beside the scene's water.
BodyKey key_of(const Body& body, const BodyKeys& keys, const RigidBodyMass& own, const Vec3& current_W) {
  BodyKey key = keys.floating(body, own);
  append(current_W, key);
  append(own.inertia_B, key);
  append(body.dynamics.orientation.coeffs(), key);
  append(body.dynamics.linear_velocity, key);
  append(body.dynamics.angular_velocity, key);
  if (body.hydrodynamics == nullptr) return key;
  const HydrodynamicCoefficients& coefficients = body.hydrodynamics->coefficients();
  key.push_back(coefficients.drag ? 1.0 : 0.0);
  if (coefficients.drag) {
    append(coefficients.drag->linear, key);
    append(coefficients.drag->quadratic, key);
    append(coefficients.drag->center_B, key);
    key.push_back(static_cast<double>(coefficients.drag->immersion));
  }
  if (coefficients.added_mass) {
    append(coefficients.added_mass->matrix, key);
    append(coefficients.added_mass->center_B, key);
    key.push_back(static_cast<double>(coefficients.added_mass->immersion));
  }
  return key;
}

}  // namespace

double NaturalMotion::period() const {
  return frequency > 0.0 ? 2.0 * std::numbers::pi / frequency : kInfinity;
}

std::optional<double> terminal_velocity_of(const Body& body, const Vec3& up_B, double force) {
  if (force == 0.0) return 0.0;
  if (body.hydrodynamics == nullptr || !body.hydrodynamics->coefficients().drag) return std::nullopt;
  const DragCoefficients& drag = *body.hydrodynamics->coefficients().drag;
  const double linear = up_B.dot(drag.linear.topLeftCorner<3, 3>() * up_B);
  const double quadratic =
      up_B.dot(drag.quadratic.topLeftCorner<3, 3>() * up_B.cwiseAbs().cwiseProduct(up_B));
  // linear v + quadratic v^2 = |force|, in the form that does not cancel.
  const double denominator = linear + std::sqrt(linear * linear + 4.0 * quadratic * std::abs(force));
  const double speed = 2.0 * std::abs(force) / denominator;
  if (!std::isfinite(speed)) return std::nullopt;
  return std::copysign(speed, force);
}

std::optional<BodyMotions> body_motions(const Body& body, const HydrostaticMesh& mesh, const Water& water,
                                        const Vec3& current_W) {
  const Expected<RigidBodyMass> own = mass_of_body(body, water);
  if (!own) return std::nullopt;
  const Eigen::Quaterniond q_WB = body.dynamics.orientation.normalized();
  const LoadedBody loaded(body, mesh, *own, q_WB.conjugate() * water.up_W);
  const RigidBodyMass& rigid = loaded.total();
  const MotionMatrices matrices(body, rigid, water, current_W);
  const Vec3 up_B = matrices.R_WB().transpose() * water.up_W;

  BodyMotions motions;
  motions.max_explicit_step = kInfinity;
  const std::optional<double> ratio = max_mass_ratio(matrices.rigid_mass(), matrices.added_mass({}));
  if (!ratio) return std::nullopt;
  motions.added_mass_ratio = *ratio;

  const Displaced whole = loaded.submerged();
  const double displaced = deepest_density(water) * whole.volume;  // [kg], of a closed mesh
  const bool neutral =
      !mesh.is_open() && outcome_by_mass(rigid.mass, displaced) == FlotationOutcome::kNeutral;
  if (!neutral) {
    if (const std::optional<FloatingPose> floating = loaded.afloat(q_WB, water)) {
      motions.balance = VerticalBalance::kFloats;
      motions.draft = floating->draft;
      const Vec3 lever_W =
          floating->state.hydrostatics.center_of_buoyancy_W - matrices.R_WB() * rigid.center_of_mass_B;
      motions.turning_lever = (lever_W - water.up_W.dot(lever_W) * water.up_W).norm();
      const State state = loaded.floating_state(*floating, water);
      motions.natural = natural_motions(matrices, state, mesh, rigid.center_of_mass_B, water);
      if (!limit_step(matrices, state, matrices.given_twist_B(), StepLimit::kFloating, motions)) {
        return std::nullopt;
      }
    }
  }
  if (mesh.is_open()) return motions;

  if (!motions.draft) motions.balance = neutral ? VerticalBalance::kNeutral : VerticalBalance::kSinks;
  const State state = loaded.submerged_state(whole, q_WB, water);
  if (!motions.draft) {
    motions.natural = natural_motions(matrices, state, mesh, rigid.center_of_mass_B, water);
    const Vec3 lever_W = matrices.R_WB() * whole.lever_B;
    motions.turning_lever = (lever_W - water.up_W.dot(lever_W) * water.up_W).norm();
  }
  const double force = neutral ? 0.0 : (displaced - rigid.mass) * water.gravity;
  motions.terminal_velocity = terminal_velocity_of(body, up_B, force);
  bool finite = limit_step(matrices, state, matrices.given_twist_B(), StepLimit::kSubmerged, motions);
  if (motions.terminal_velocity) {
    Vec6 twist_B = Vec6::Zero();
    twist_B.head<3>() = *motions.terminal_velocity * up_B;
    finite = finite && limit_step(matrices, state, twist_B, StepLimit::kTerminalVelocity, motions);
  }
  if (!finite) return std::nullopt;
  return motions;
}

std::vector<MotionsOfBody> scene_motions(const Scene& scene, std::size_t max_vertices) {
  const BodyKeys keys(scene);
  StartFinder starts(scene);
  std::vector<MotionsOfBody> bodies;
  MeshesWithTrees meshes;
  std::map<BodyKey, std::shared_ptr<const BodyMotions>> known;
  std::size_t vertices = 0;
  for (const Body& given : scene.bodies()) {
    MotionsOfBody& entry = bodies.emplace_back();
    const Expected<RigidBodyMass> own = mass_of_body(given, scene.water());
    if (!given.dynamics.given || !own) continue;
    Body body = given;
    if (const Expected<DynamicsSpec> start = starts.start_of(given)) body.dynamics = *start;
    const Vec3 current_W = current_at_start(body, scene);
    BodyKey key = key_of(body, keys, *own, current_W);
    auto found = known.find(key);
    if (found == known.end()) {
      const std::size_t more = body.prepared_mesh->mesh.surface.x.size();
      entry.left_out = vertices + more > max_vertices;
      if (entry.left_out) continue;
      vertices += more;
      const std::optional<BodyMotions> motions =
          body_motions(body, meshes.of(*body.prepared_mesh), scene.water(), current_W);
      found = known.emplace(std::move(key), motions ? std::make_shared<const BodyMotions>(*motions) : nullptr)
                  .first;
    }
    entry.motions = found->second;
  }
  return bodies;
}

}  // namespace buoyancy
