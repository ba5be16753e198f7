// Water planes of many bodies at once, and on every instruction set.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hydrostatics/water_plane.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "tests/hydrostatics/forced_target.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/support/allocation_count.h"

namespace buoyancy {
namespace {

using PlaneBits = std::array<std::uint64_t, 9>;

PlaneBits bits_of(const WaterPlane& plane) {
  // Which NaN it is does not matter: a plane with one has no result.
  const auto bits = [](double value) {
    return std::isnan(value) ? ~std::uint64_t{0} : std::bit_cast<std::uint64_t>(value);
  };
  return {bits(plane.up_B.x()),      bits(plane.up_B.y()),      bits(plane.up_B.z()),
          bits(plane.up_B_rest.x()), bits(plane.up_B_rest.y()), bits(plane.up_B_rest.z()),
          bits(plane.h_c),           bits(plane.h_c_rest),      bits(plane.error)};
}

struct PlaneRequests {
  std::vector<Pose> poses;
  std::vector<Vec3> centers_B;

  void add(const Pose& pose, const Vec3& center_B) {
    poses.push_back(pose);
    centers_B.push_back(center_B);
  }
};

std::vector<PlaneBits> bits_one_by_one(const PlaneRequests& requests, const Water& water) {
  std::vector<PlaneBits> bits;
  for (std::size_t i = 0; i < requests.poses.size(); ++i) {
    bits.push_back(bits_of(water_plane_in_body(requests.poses[i], water, requests.centers_B[i])));
  }
  return bits;
}

// Checks planes computed together on the current instruction set.
void expect_bits(const std::vector<PlaneBits>& expected, const PlaneRequests& requests, const Water& water) {
  std::vector<WaterPlane> planes(requests.poses.size());
  water_planes_in_body(requests.poses, water, requests.centers_B, planes);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    ASSERT_EQ(bits_of(planes[i]), expected[i]) << simd_target() << ", plane " << i;
  }
}

TEST(WaterPlanes, HaveSameBitsOneByOneAndOnEveryTarget) {
  RandomPoses random(1);
  for (int set = 0; set < 200; ++set) {
    Water water;
    if (set % 2 == 1) water.up_W = random.direction();
    water.level = set % 4 < 2 ? 0.0 : random.uniform(-1e6, 1e6);
    PlaneRequests requests;
    for (int i = 0; i < set; ++i) {  // all sizes, so that the last group has any number of bodies
      Pose pose{.p_WB = random.far_vector(-3.0, 9.0), .q_WB = random.rotation()};
      pose.q_WB.coeffs() *= i % 3 == 0 ? std::pow(10.0, random.uniform(-100.0, 100.0)) : 1.0;
      requests.add(pose, random.far_vector(-3.0, 6.0));
    }
    const std::vector<PlaneBits> expected = bits_one_by_one(requests, water);
    for (const std::string& target : simd_targets()) {
      const ForcedTarget forced(target);
      ASSERT_EQ(bits_one_by_one(requests, water), expected) << target;
      ASSERT_NO_FATAL_FAILURE(expect_bits(expected, requests, water));
    }
  }
}

TEST(WaterPlanes, EqualsPlaneOfEachBodyAtLimitsOfDouble) {
  using Limits = std::numeric_limits<double>;
  PlaneRequests requests;
  for (const double size :
       {Limits::denorm_min(), Limits::min(), 2.0 * Limits::min(), 1e-300, 1e-160, 0.5, 1.0, 2.0, 1e150, 1e300,
        0.25 * Limits::max(), 0.5 * Limits::max(), Limits::max()}) {
    for (const double other : {0.0, -0.0, 0.1, 1.0, 1e-200}) {
      const Eigen::Quaterniond q(size, other * size, -size, 0.3 * size);
      requests.add({.p_WB = {1.0, -2.0, 3.0}, .q_WB = q}, {0.1, 0.2, 0.3});
      requests.add({.p_WB = Vec3::Zero(), .q_WB = {0.0, 0.0, 0.0, size}}, Vec3::Zero());
      requests.add({.p_WB = {0.0, 0.0, size}, .q_WB = {1.0, 0.0, 0.0, other}}, {size, 0.0, -size});
    }
  }
  // Where products underflow, an instruction set with fused multiply-add gives other bits than one without.
  for (const std::string& target : simd_targets()) {
    const ForcedTarget forced(target);
    ASSERT_NO_FATAL_FAILURE(expect_bits(bits_one_by_one(requests, Water()), requests, Water()));
  }
}

TEST(WaterPlanes, DoNotAllocate) {
  const std::vector<Pose> poses(100);
  const std::vector<Vec3> centers_B(100, Vec3::Zero());
  std::vector<WaterPlane> planes(100);
  const AllocationCount allocations;
  water_planes_in_body(poses, Water(), centers_B, planes);
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace buoyancy
