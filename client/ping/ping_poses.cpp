#include "client/ping/ping_poses.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "messages/conversions.h"
#include "waves/sea.h"

namespace buoyancy::ping {
namespace {

constexpr std::int64_t kPlacements = 4;
constexpr double kMaxDistance = 50.0;        // [m], of a body from the world's origin, horizontally
constexpr double kMaxTilt = 0.2;             // of a body near its mesh's attitude: vector part of q over w
constexpr double kMaxNormDefect = 4e-4;      // of a quaternion, below the 1e-3 that the service refuses
constexpr double kMaxSpeed = 1.0;            // [m/s], along each axis
constexpr double kMaxAngularVelocity = 0.5;  // [rad/s], about each axis

// The numbers of a std::uniform_real_distribution depend on the standard library; these do not.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : state_(seed) {}

  // SplitMix64 of Steele, Lea and Flood (2014).
  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t mixed = state_;
    mixed = (mixed ^ (mixed >> 30U)) * 0xbf58476d1ce4e5b9U;
    mixed = (mixed ^ (mixed >> 27U)) * 0x94d049bb133111ebU;
    return mixed ^ (mixed >> 31U);
  }
  double between(double low, double high) {
    constexpr double kUnit = 0x1p-53;
    return low + (high - low) * (static_cast<double>(next() >> 11U) * kUnit);
  }
  Vec3 vector(double max) {
    const double x = between(-max, max);
    const double y = between(-max, max);
    return {x, y, between(-max, max)};
  }

 private:
  std::uint64_t state_;
};

RandomNumbers numbers_of(std::uint64_t seed, std::int64_t request, std::int32_t body_id) {
  RandomNumbers of_seed(seed);
  RandomNumbers of_request(of_seed.next() ^ static_cast<std::uint64_t>(request));
  return RandomNumbers(of_request.next() ^ static_cast<std::uint32_t>(body_id));
}

std::int64_t placement(std::int64_t request, std::size_t body) {
  return (request + static_cast<std::int64_t>(body)) % kPlacements;
}

Eigen::Quaterniond any_attitude(RandomNumbers& random) {
  constexpr double kSmallest = 0.01;  // a shorter vector has no direction to speak of
  while (true) {
    const Vec3 vector = random.vector(1.0);
    const Eigen::Quaterniond quaternion(random.between(-1.0, 1.0), vector.x(), vector.y(), vector.z());
    const double squared_norm = quaternion.squaredNorm();
    if (squared_norm > kSmallest && squared_norm <= 1.0) return quaternion.normalized();
  }
}

Eigen::Quaterniond near_own_attitude(RandomNumbers& random) {
  const Vec3 tilt = random.vector(kMaxTilt);
  return Eigen::Quaterniond(1.0, tilt.x(), tilt.y(), tilt.z()).normalized();
}

// Returns the height [m] of a box's centre above the level. reach: [m], from there to its highest corner.
double height_of_center(Immersion immersion, double reach, double max_elevation, RandomNumbers& random) {
  constexpr double kMaxOfReach = 0.9;
  if (immersion == Immersion::kPiercing) {
    return random.between(-kMaxOfReach * reach, kMaxOfReach * reach);
  }
  const double clear_of_surface = max_elevation + reach * random.between(1.1, 2.0);
  return immersion == Immersion::kDry ? clear_of_surface : -clear_of_surface;
}

}  // namespace

Immersion immersion_of(std::int64_t request, std::size_t body) {
  const std::int64_t now = placement(request, body);
  if (now == 1) return Immersion::kSubmerged;
  return now == 2 ? Immersion::kDry : Immersion::kPiercing;
}

void make_states(const Scene& scene, const WaterSurface& surface, std::uint64_t seed, std::int64_t request,
                 std::vector<BodyState>& states) {
  const Vec3& up_W = scene.water().up_W;
  const HorizontalAxes horizontal = horizontal_axes(up_W);
  states.resize(scene.bodies().size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Body& body = scene.bodies()[i];
    RandomNumbers random = numbers_of(seed, request, body.id);
    const Eigen::Quaterniond attitude =
        placement(request, i) == 3 ? near_own_attitude(random) : any_attitude(random);
    const Mat3 R_WB = attitude.toRotationMatrix();

    const HydrostaticMesh& mesh = body.solver.mesh();
    const Vec3 box_center_B = mesh.center_B + (mesh.box_min + mesh.box_max) / 2.0;
    const Vec3 half_size = (mesh.box_max - mesh.box_min) / 2.0;
    const double reach = (R_WB.transpose() * up_W).cwiseAbs().dot(half_size);
    const double height = height_of_center(immersion_of(request, i), reach, surface.max_elevation, random);
    const double along_e1 = random.between(-kMaxDistance, kMaxDistance);
    const double along_e2 = random.between(-kMaxDistance, kMaxDistance);
    const Vec3 box_center_W =
        up_W * (surface.level + height) + horizontal.e1_W * along_e1 + horizontal.e2_W * along_e2;

    BodyState& state = states[i];
    state.body_id = body.id;
    state.position = to_array(box_center_W - R_WB * box_center_B);
    const bool normalised = random.next() % 4 != 0;
    const double norm = normalised ? 1.0 : 1.0 + random.between(-kMaxNormDefect, kMaxNormDefect);
    state.quaternion_wxyz = {norm * attitude.w(), norm * attitude.x(), norm * attitude.y(),
                             norm * attitude.z()};
    state.linear_velocity = to_array(random.vector(kMaxSpeed));
    state.angular_velocity = to_array(random.vector(kMaxAngularVelocity));
  }
}

}  // namespace buoyancy::ping
