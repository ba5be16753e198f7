#include "tests/random_search/search_pose.h"

#include <array>
#include <cmath>
#include <limits>

#include "geometry/rotation_between.h"

namespace buoyancy {
namespace {

Vec3 normal_of(const TriangleMesh& mesh, const Triangle& face) {
  const Vec3 a = mesh.vertex(face[0]);
  return (mesh.vertex(face[1]) - a).cross(mesh.vertex(face[2]) - a);
}

Eigen::Quaterniond random_rotation(const TriangleMesh& mesh, const Triangle& face, const Vec3& up_W,
                                   RandomPoses& random) {
  switch (random.pick(6)) {
    case 0:
      return random.quarter_turns();
    case 1: {
      const double tilt = random.power_of_ten(-17.0, -3.0);
      const Eigen::Quaterniond tilted{1.0, tilt * random.sign(), tilt * random.uniform(-1, 1), 0.0};
      return random.quarter_turns() * tilted;
    }
    case 2: {  // a face lies in the water plane, or nearly so
      const Vec3 normal = normal_of(mesh, face).normalized();
      if (!(normal.norm() > 0.5)) return random.rotation();
      Eigen::Quaterniond flat = rotation_between(normal, random.sign() * up_W);
      if (random.pick(2) == 0) return flat;
      const double tilt = random.power_of_ten(-17.0, -6.0);
      return flat * Eigen::Quaterniond(1.0, tilt, 0.0, tilt);
    }
    default:
      return random.rotation();
  }
}

// A point of B through which the water plane is to pass.
Vec3 random_target(const TriangleMesh& mesh, const Triangle& face, const Vec3& up_B, RandomPoses& random) {
  const BoundingBox box = bounding_box(mesh);
  Vec3 a = mesh.vertex(face[0]);
  switch (random.pick(6)) {
    case 0:
      return a;
    case 1:
      return 0.5 * (a + mesh.vertex(face[1]));
    case 2: {  // grazes the highest or the lowest vertex
      const double side = random.sign();
      Vec3 farthest = a;
      for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
        const Vec3 x = mesh.vertex(static_cast<std::int32_t>(i));
        if (side * up_B.dot(x - farthest) > 0.0) farthest = x;
      }
      return farthest - side * random.power_of_ten(-15.0, -1.0) * box.diagonal() * up_B;
    }
    default:
      return box.center() + box.diagonal() * random.vector(-0.6, 0.6);
  }
}

double nudged(double value, RandomPoses& random) {
  const double to = random.sign() * std::numeric_limits<double>::infinity();
  for (std::size_t ulps = random.pick(9); ulps > 0; --ulps) value = std::nextafter(value, to);
  return value;
}

}  // namespace

SearchPose random_search_pose(const TriangleMesh& mesh, RandomPoses& random) {
  const double size = bounding_box(mesh).diagonal();
  SearchPose requested;
  if (random.pick(3) == 0) requested.water.up_W = random.direction();
  const Vec3 up_W = requested.water.up_W;
  const Triangle face = mesh.triangles[random.pick(mesh.triangles.size())];
  requested.pose.q_WB = random_rotation(mesh, face, up_W, random);
  const Eigen::Quaterniond q_WB = requested.pose.q_WB.normalized();
  const Vec3 target_B = random_target(mesh, face, q_WB.conjugate() * up_W, random);

  Vec3 target_W = Vec3::Zero();  // position of the target point, relative to the water plane at level 0
  if (random.pick(3) == 0) {
    target_W = size * random.far_vector(0.0, 8.0);
    target_W -= up_W.dot(target_W) * up_W;
  }
  if (random.pick(3) == 0) {
    requested.water.level = random.sign() * size;
    requested.water.level *= random.power_of_ten(-2.0, 6.0);
    target_W += requested.water.level * up_W;
  }
  if (random.pick(12) == 0) {
    const double height = random.sign() * size;
    target_W += height * random.power_of_ten(-1.0, 4.0) * up_W;
  }
  requested.pose.p_WB = target_W - q_WB * target_B;
  switch (random.pick(4)) {
    case 0:
      requested.water.level = nudged(requested.water.level, random);
      break;
    case 1:  // the level is the rounded height of the target point
      requested.water.level = up_W.dot(q_WB * target_B + requested.pose.p_WB);
      requested.water.level = nudged(requested.water.level, random);
      break;
    default:
      break;
  }
  if (random.pick(4) == 0) {
    requested.pose.q_WB.coeffs() *= random.sign();
    requested.pose.q_WB.coeffs() *= random.uniform(0.999, 1.001);
  }
  requested.reference_B = bounding_box(mesh).center();
  if (random.pick(2) == 0) requested.reference_B += size * random.far_vector(-1.0, 3.0);
  if (random.pick(3) == 0) requested.reference_B = Vec3::Zero();
  requested.tolerance = random.power_of_ten(-9.0, -1.0);
  return requested;
}

}  // namespace buoyancy
