// Random bodies and requests in waves, for the search against the bound of wave loads: bodies of 12 to 30,000
// triangles and 0.1 to 30 m; seas that are regular, irregular, short, steep, very long, deep or hardly deeper
// than their troughs, or less deep; bodies that pierce the surface or the bed, touch the surface, are deep,
// dry or below the bed; near the world's origin and 1e6 m away, today and at the origin of time.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "tests/hydrostatics/random_poses.h"
#include "wave_loads/wave_load.h"

namespace buoyancy {

struct WaveSearchBody {
  std::string kind;  // "rock of 2880 triangles, 3.1 m"
  TriangleMesh source_B;
  HydrostaticMesh mesh;
  PatchTree tree;
};

enum class SeaKind { kRegular, kSeveral, kIrregular, kShort, kSteep, kLong };
inline constexpr std::array kSeaKinds{SeaKind::kRegular, SeaKind::kSeveral, SeaKind::kIrregular,
                                      SeaKind::kShort,   SeaKind::kSteep,   SeaKind::kLong};
std::string_view to_string(SeaKind kind);

struct WaveRequest {
  SeaKind kind = SeaKind::kRegular;
  std::string placement;  // "piercing"
  SeaDescription description;
  Water water;
  std::int64_t utime = 0;  // [us]
  double lead_time = 0.0;  // [s]
  Pose pose;
  Vec3 reference_B = Vec3::Zero();
  double tolerance = 1e-3;
};

WaveSearchBody random_wave_mesh(RandomPoses& random);
WaveRequest random_wave_request(const WaveSearchBody& mesh, RandomPoses& random);

// What kind of request it is, and where, in two lines.
std::string describe(const WaveRequest& request);

}  // namespace buoyancy
