// A complete simulator of one body, the box of scenes/box.toml: `buoyancyd --scene box.toml` knows its mesh
// and the water, this program knows its mass. Usage: float_a_box [LCM URL]
#include <cmath>
#include <cstdint>
#include <cstdio>

#include <Eigen/Geometry>
#include <buoyancy/client/client.h>

int main(int argc, char** argv) {
  const double mass = 256.25;  // kg
  const Eigen::Vector3d inertia =
      mass / 12.0 * Eigen::Vector3d(1.25, 1.25, 2.0);  // kg m^2, about the mesh's axes
  const double linear_damping = 500.0;                 // N/(m/s)
  const double angular_damping = 40.0;                 // N m/(rad/s)
  const Eigen::Vector3d gravity(0.0, 0.0, -9.80665);   // m/s^2
  const double step = 1e-3;                            // s

  // Everything is in the world frame, z up. The mesh's origin is the centre of mass here; docs/sidecar.md has
  // the general case.
  Eigen::Vector3d position(0.0, 0.0, 0.75);
  Eigen::Quaterniond orientation = Eigen::Quaterniond(0.98, 0.15, 0.1, 0.0).normalized();  // w, x, y, z
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();

  buoyancy::ClientOptions options;
  if (argc > 1) options.channel.lcm_url = argv[1];
  options.retry_policy.max_retries = 600;  // a minute for a service that still loads its meshes
  auto client = buoyancy::Client::open(options);
  if (!client) return std::fprintf(stderr, "%s\n", client.error().message().c_str()), 1;

  for (std::int64_t i = 0; i < 20'000; ++i) {
    buoyancy::BodyState state;
    state.body_id = 1;                                       // as in the scene file
    Eigen::Vector3d::Map(state.position.data()) = position;  // m, of the mesh's origin
    state.quaternion_wxyz = {orientation.w(), orientation.x(), orientation.y(), orientation.z()};
    Eigen::Vector3d::Map(state.linear_velocity.data()) = velocity;           // m/s, of the mesh's origin
    Eigen::Vector3d::Map(state.angular_velocity.data()) = angular_velocity;  // rad/s
    const auto response = client->request(1'000 * i, {&state, 1});           // us of simulated time
    if (!response) return std::fprintf(stderr, "%s\n", response.error().message().c_str()), 1;
    const buoyancy::BodyWrench& wrench = (*response)->bodies[0];
    if (wrench.status != buoyancy::BodyStatus::kOk)
      return std::fprintf(stderr, "%s\n", to_string(wrench.status)), 1;

    const Eigen::Vector3d force =
        Eigen::Vector3d::Map(wrench.force.data()) + mass * gravity - linear_damping * velocity;
    const Eigen::Vector3d torque =
        Eigen::Vector3d::Map(wrench.torque.data()) - angular_damping * angular_velocity;
    const Eigen::Matrix3d rotation = orientation.toRotationMatrix();
    const Eigen::Matrix3d inertia_W = rotation * inertia.asDiagonal() * rotation.transpose();
    // Semi-implicit Euler: the new velocities move the body.
    velocity += step * force / mass;
    angular_velocity +=
        step * inertia_W.inverse() * (torque - angular_velocity.cross(inertia_W * angular_velocity));
    position += step * velocity;
    const Eigen::Vector3d turn = step * angular_velocity;
    const double angle = turn.norm();
    if (angle > 0.0) orientation = (Eigen::AngleAxisd(angle, turn / angle) * orientation).normalized();
  }
  const double up = (orientation * Eigen::Vector3d::UnitZ()).z();
  std::printf("draft %.6f m, tilt %.6f rad\n", 0.25 - position.z(), std::acos(std::fmin(up, 1.0)));
}
