// The true wrench of a body, from the exact oracle in numbers of 512 bits: rationals would take a hundred
// times as long. Valid for values that are 0 or of magnitude 2^-40 to 2^40: the rounding error, 2^-512 times
// the fourth power of 2^41, is far below the smallest bound that an exact method can publish, 2^-52 times the
// third power of 2^-40.
//
// This is a library of its own, compiled without sanitizers: with them it would take most of the fuzzer's
// time, and it is not the code under test.
#pragma once

#include <memory>

#include "geometry/triangle_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

inline constexpr int kMaxExponent = 40;

class TrueWrench {
 public:
  TrueWrench(const TriangleMesh& mesh, const Pose& pose, const Water& water, const Vec3& reference_B);
  TrueWrench(const TrueWrench&) = delete;
  TrueWrench& operator=(const TrueWrench&) = delete;
  ~TrueWrench();

  // The errors of given values, rounded once: [m^3], [N], [N m].
  double volume_error(double volume) const;
  double force_error(const Vec3& force_W) const;
  double torque_error(const Vec3& torque_W) const;

 private:
  struct Numbers;
  std::unique_ptr<const Numbers> numbers_;
};

}  // namespace buoyancy
