// The true wrench of a body, from the exact oracle in numbers of 512 bits: rationals would take a hundred
// times as long. For values that are 0 or within 2^-40 and 2^40: what is rounded, 2^-512 of the fourth power
// of 2^41, is far below the smallest bound that an exact method can publish, 2^-52 of the third power of
// 2^-40.
//
// A library of its own, without sanitizers: they would make it most of the fuzzer's time, and what it is to
// find is not here.
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

  // How far what was found is off, rounded once: m^3; N; N m.
  double volume_error(double volume) const;
  double force_error(const Vec3& force_W) const;
  double torque_error(const Vec3& torque_W) const;

 private:
  struct Numbers;
  std::unique_ptr<const Numbers> numbers_;
};

}  // namespace buoyancy
