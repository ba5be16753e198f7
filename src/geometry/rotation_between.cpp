#include "geometry/rotation_between.h"

namespace buoyancy {

Eigen::Quaterniond rotation_between(const Vec3& from, const Vec3& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace buoyancy
