#include "tests/hydrostatics/random_poses.h"

#include <cmath>

#include "geometry/rotation_between.h"

namespace buoyancy {

double RandomPoses::uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(generator_);
}

Eigen::Quaterniond RandomPoses::rotation() {
  std::normal_distribution<double> normal;
  Eigen::Quaterniond q(normal(generator_), normal(generator_), normal(generator_), normal(generator_));
  return q.normalized();
}

Vec3 RandomPoses::direction() {
  std::normal_distribution<double> normal;
  return Vec3(normal(generator_), normal(generator_), normal(generator_)).normalized();
}

Pose RandomPoses::crossing(const BoundingBox& box, const Water& water) {
  Pose pose;
  pose.q_WB = rotation();
  const double along = 0.55 * box.diagonal() * uniform(-1.0, 1.0);
  const Vec3 sideways = box.diagonal() * direction();
  const Vec3 center_W =
      water.up_W * (water.level + along) + (sideways - water.up_W * water.up_W.dot(sideways));
  pose.p_WB = center_W - pose.q_WB * box.center();
  return pose;
}

Pose RandomPoses::adversarial(const TriangleMesh& mesh, const Water& water) {
  Pose pose;
  switch (pick(4)) {
    case 0:
      pose.q_WB = Eigen::Quaterniond::Identity();
      break;
    case 1:
      pose.q_WB = quarter_turns();
      break;
    case 2:
      pose.q_WB = quarter_turns() * Eigen::Quaterniond(1.0, uniform(-1e-9, 1e-9), uniform(-1e-9, 1e-9), 0.0);
      break;
    default:
      pose.q_WB = rotation();
  }
  const Triangle& face = mesh.triangles[pick(mesh.triangles.size())];
  Vec3 through = mesh.vertex(face[0]);
  if (pick(3) == 0) through = 0.5 * (through + mesh.vertex(face[1]));
  if (pick(4) == 0) {  // the face itself lies on the water
    const Vec3 normal = (mesh.vertex(face[1]) - through).cross(mesh.vertex(face[2]) - through);
    if (normal.norm() > 0) pose.q_WB = rotation_between(normal, pick(2) ? water.up_W : Vec3(-water.up_W));
  }
  double height = water.level - water.up_W.dot(pose.q_WB * through);
  for (std::size_t ulps = pick(9); ulps > 0; --ulps) {
    height = std::nextafter(height, pick(2) ? INFINITY : -INFINITY);
  }
  pose.p_WB = height * water.up_W;
  return pose;
}

std::size_t RandomPoses::pick(std::size_t count) {
  return std::uniform_int_distribution<std::size_t>(0, count - 1)(generator_);
}

Eigen::Quaterniond RandomPoses::quarter_turns() {
  const double r = std::sqrt(0.5);
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  for (std::size_t n = pick(4); n > 0; --n) q = q * Eigen::Quaterniond(r, r, 0, 0);
  for (std::size_t n = pick(4); n > 0; --n) q = q * Eigen::Quaterniond(r, 0, 0, r);
  return q;
}

}  // namespace buoyancy
