// Example of a simulator that uses buoyancyd: MuJoCo (package libmujoco-dev) moves the bodies of a model,
// buoyancyd computes the loads of water and waves, drag and added mass on them.
//
//   buoyancyd --scene scenes/rov.toml &
//   mujoco_bodies client/examples/rov.xml [LCM URL [DURATION [RETRIES]]]
//
// In the model, a body is in the water if it has a free joint and its `user` attribute is its id in the
// scene. Its frame is that of the scene's mesh, about whose origin the scene leaves the torque; its mass and
// inertia are the model's. The scene requests its loads: outputs = ["wrench", "loads"].
//
// Added mass and damping enter MuJoCo's own mass matrix between mj_step1 and mj_step2. The constraint solver
// uses that matrix too, so that contacts and joints feel the added mass, and drag makes no step too large.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "client/client.h"
#include "client/coupled_load.h"
#include "client/examples/heave_period.h"

namespace {

using buoyancy::Mat3;
using buoyancy::Mat6;
using buoyancy::Vec3;
using buoyancy::Vec6;

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using Model = std::unique_ptr<mjModel, DeleteModel>;
using Data = std::unique_ptr<mjData, DeleteData>;

// A body on a free joint, whose six degrees of freedom are the velocity of its origin in the world's axes and
// its angular velocity in its own axes.
struct WetBody {
  std::int32_t id = 0;    // in the scene
  const char* name = "";  // in the model
  int coordinate = 0;     // of the joint, in qpos
  int dof = 0;            // of the joint, in qvel
  HeavePeriod heave = {};
};

std::vector<WetBody> find_wet_bodies(const mjModel& model) {
  std::vector<WetBody> bodies;
  for (int i = 1; i < model.nbody && model.nuser_body > 0; ++i) {
    const mjtNum* const user = model.body_user + static_cast<std::ptrdiff_t>(i) * model.nuser_body;
    const auto id = static_cast<std::int32_t>(*user);
    const int joint = model.body_jntadr[i];
    if (id == 0 || joint < 0 || model.jnt_type[joint] != mjJNT_FREE) continue;
    bodies.push_back({.id = id,
                      .name = model.names + model.name_bodyadr[i],
                      .coordinate = model.jnt_qposadr[joint],
                      .dof = model.jnt_dofadr[joint]});
  }
  return bodies;
}

Mat3 rotation_of(const buoyancy::BodyState& state) {
  const auto& [w, x, y, z] = state.quaternion_wxyz;
  return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
}

buoyancy::BodyState state_of(const WetBody& body, const mjData& data) {
  const mjtNum* p = data.qpos + body.coordinate;
  const mjtNum* v = data.qvel + body.dof;
  buoyancy::BodyState state{.body_id = body.id,
                            .position = {p[0], p[1], p[2]},
                            .quaternion_wxyz = {p[3], p[4], p[5], p[6]},
                            .linear_velocity = {v[0], v[1], v[2]},
                            .angular_velocity = {}};
  const Vec3 w_W = rotation_of(state) * Vec3(v[3], v[4], v[5]);
  state.angular_velocity = {w_W.x(), w_W.y(), w_W.z()};
  return state;
}

// Adds a symmetric matrix to MuJoCo's mass matrix, for the degrees of freedom of one free joint. MuJoCo
// stores a row of its lower triangle from the diagonal to the left.
void add_to_mass_matrix(const Mat6& matrix, int dof, const mjModel& model, mjData& data) {
  for (int row = 0; row < 6; ++row) {
    mjtNum* const diagonal = data.qM + model.dof_Madr[dof + row];
    for (int column = 0; column <= row; ++column) diagonal[row - column] += matrix(row, column);
  }
}

// The equation of motion of client/coupled_load.h: added mass and h times the damping to the left side, the
// wrench and s A (w x v) to the right side; all in W's axes and about the body's origin at first.
void apply_water(const WetBody& body, const buoyancy::BodyState& state, const buoyancy::BodyWrench& wrench,
                 const buoyancy::BodyLoads& loads, const mjModel& model, mjData& data) {
  const auto& [added_mass, water_damping] = matrices_of(loads);
  const Vec3 v(state.linear_velocity.data());
  const Vec3 w(state.angular_velocity.data());
  const Vec6 right = wrench_of(wrench) + added_mass.leftCols<3>() * w.cross(v);
  Mat6 damping = water_damping;
  damping.leftCols<3>() -= added_mass.leftCols<3>() * buoyancy::cross_matrix(w);
  damping.rightCols<3>() += added_mass.leftCols<3>() * buoyancy::cross_matrix(v);
  // MuJoCo's matrix is symmetric. The antisymmetric part of the damping, from lift and Coriolis terms,
  // remains explicit: it does no work over a small step.
  const Mat6 left_W = added_mass + 0.5 * model.opt.timestep * (damping + damping.transpose());

  // The rotational degrees of freedom are in the body's axes: turn the rows and columns of the rotation.
  const Mat3 R_WB = rotation_of(state);
  Mat6 left = left_W;
  left.topRightCorner<3, 3>() = left_W.topRightCorner<3, 3>() * R_WB;
  left.bottomLeftCorner<3, 3>() = left.topRightCorner<3, 3>().transpose();
  left.bottomRightCorner<3, 3>() = R_WB.transpose() * left_W.bottomRightCorner<3, 3>() * R_WB;
  const Vec3 torque_B = R_WB.transpose() * right.tail<3>();
  for (int i = 0; i < 3; ++i) {
    data.qfrc_applied[body.dof + i] = right[i];
    data.qfrc_applied[body.dof + 3 + i] = torque_B[i];
  }
  add_to_mass_matrix(left, body.dof, model, data);
}

// Command line: MODEL [LCM URL [DURATION [RETRIES]]].
struct Arguments {
  Arguments(int argc, char** argv) {
    if (argc > 1) model = argv[1];
    if (argc > 2) lcm_url = argv[2];
    if (argc > 3) duration = std::stod(argv[3]);
    if (argc > 4) max_retries = std::stoll(argv[4]);
  }
  std::string model;
  std::string lcm_url;     // "": the default of LCM's own tools
  double duration = 10.0;  // [s]
  // One minute at 0.1 s each: a service that is started at the same time loads its scene meanwhile.
  std::int64_t max_retries = 600;
};

int fail(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  return 1;
}

// Makes one step of the model in the water. Returns why that failed, or "".
std::string step(const mjModel& model, mjData& data, std::vector<WetBody>& bodies, buoyancy::Client& client) {
  mj_step1(&model, &data);  // the mass matrix at this pose
  std::vector<buoyancy::BodyState> states;
  for (WetBody& body : bodies) {
    states.push_back(state_of(body, data));
    body.heave.add(data.time, states.back().linear_velocity[2]);
  }
  const auto response = client.request(std::llround(1e6 * data.time), states);
  if (!response) return response.error().message();
  if (const auto* failed = buoyancy::find_failed_body(**response)) {
    return "body " + std::to_string(failed->body_id) + " has status " + to_string(failed->status);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const buoyancy::BodyLoads* loads = find_loads(client.loads(), bodies[i].id);
    if (loads == nullptr) {
      return "body " + std::to_string(bodies[i].id) +
             " has no loads: its scene needs outputs = [\"wrench\", \"loads\"]";
    }
    apply_water(bodies[i], states[i], (*response)->bodies[i], *loads, model, data);
  }
  mj_factorM(&model, &data);  // mj_step2 solves with the factors
  mj_step2(&model, &data);    // semi-implicit Euler
  return "";
}

void report(const std::vector<WetBody>& bodies, const mjData& data) {
  for (const WetBody& body : bodies) {
    const buoyancy::BodyState state = state_of(body, data);
    std::printf("%s: position %.6f %.6f %.6f m, velocity %.6f %.6f %.6f m/s", body.name, state.position[0],
                state.position[1], state.position[2], state.linear_velocity[0], state.linear_velocity[1],
                state.linear_velocity[2]);
    if (body.heave.mean()) std::printf(", heave period %.6f s", *body.heave.mean());
    std::printf(" after %.6g s\n", data.time);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments(argc, argv);
  std::array<char, 1000> error{};
  const Model model(
      mj_loadXML(arguments.model.c_str(), nullptr, error.data(), static_cast<int>(error.size())));
  if (!model) return fail(arguments.model + ": " + error.data());
  if (model->opt.integrator != mjINT_EULER || model->opt.solver != mjSOL_NEWTON) {
    // The other ones compute forces, or factorise the mass matrix, before the water's terms are added to it.
    return fail(arguments.model +
                ": use integrator=\"Euler\" and solver=\"Newton\", which are MuJoCo's defaults");
  }
  const Data data(mj_makeData(model.get()));
  std::vector<WetBody> bodies = find_wet_bodies(*model);
  if (bodies.empty()) {
    return fail(arguments.model +
                ": no body has a free joint and the id of a scene's body as its user attribute");
  }
  buoyancy::ClientOptions options;
  options.channel.lcm_url = arguments.lcm_url;
  options.channel.wait_for_loads = true;
  options.retry_policy.max_retries = arguments.max_retries;
  buoyancy::Expected<buoyancy::Client> client = buoyancy::Client::open(options);
  if (!client) return fail(client.error().message());
  const std::int64_t steps = std::llround(arguments.duration / model->opt.timestep);
  for (std::int64_t n = 0; n < steps; ++n) {
    const std::string problem = step(*model, *data, bodies, *client);
    if (!problem.empty()) return fail(problem);
  }
  report(bodies, *data);
  return 0;
}
