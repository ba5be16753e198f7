#include "tests/hydrostatics/random_poses.h"

#include <cmath>

#include "geometry/rotation_between.h"

namespace buoyancy {

void RandomBits::change(std::mt19937_64& random) {
  if (given_.empty()) return;
  for (std::uint64_t changes = 1 + random() % 4; changes > 0; --changes) {
    std::uint64_t& number = given_[random() % given_.size()];
    if (random() % 3 == 0) {
      number = random();
      continue;
    }
    // By a power of two, up or down, from all of the range to its last digits; it does not wrap around.
    const std::uint64_t by = random() >> (1U + random() % 50U);
    if (random() % 2 == 0) {
      number = number > max() - by ? max() : number + by;
    } else {
      number = number < by ? 0 : number - by;
    }
  }
}

RandomPoses RandomPoses::again() const {
  RandomPoses copy = *this;
  copy.generator_.rewind();
  return copy;
}

RandomPoses RandomPoses::changed(std::mt19937_64& random) const {
  RandomPoses copy = again();
  copy.generator_.change(random);
  return copy;
}

double RandomPoses::power_of_ten(double low_exponent, double high_exponent) {
  return std::pow(10.0, uniform(low_exponent, high_exponent));
}

double RandomPoses::log_uniform(double low, double high) {
  return std::exp(uniform(std::log(low), std::log(high)));
}

double RandomPoses::uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(generator_);
}

Eigen::Quaterniond RandomPoses::rotation() {
  std::normal_distribution<double> normal;
  Eigen::Quaterniond q;
  for (const int i : {2, 1, 0, 3}) q.coeffs()[i] = normal(generator_);  // z, y, x, w
  return q.normalized();
}

Vec3 RandomPoses::direction() {
  std::normal_distribution<double> normal;
  Vec3 v;
  for (const int i : {2, 1, 0}) v[i] = normal(generator_);
  return v.normalized();
}

Vec3 RandomPoses::vector(double shortest, double longest) {
  const Vec3 along = direction();
  return uniform(shortest, longest) * along;
}

Vec3 RandomPoses::far_vector(double low_exponent, double high_exponent) {
  const Vec3 along = direction();
  return power_of_ten(low_exponent, high_exponent) * along;
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
    case 2: {
      const double about_y = uniform(-1e-9, 1e-9);
      const Eigen::Quaterniond tilt(1.0, uniform(-1e-9, 1e-9), about_y, 0.0);
      pose.q_WB = quarter_turns() * tilt;
      break;
    }
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
