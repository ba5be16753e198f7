// The scene file: TOML in, a plain description out. The only user of toml++.
//
// Every key is known or an error that names file, line and the nearest known key; every number is checked for
// its range where it stands. Nothing is loaded here: see Scene.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"
#include "geometry/mesh_import.h"
#include "geometry/mesh_validation.h"
#include "geometry/shapes.h"
#include "hydrostatics/solver.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// What only a simulator needs to know of a body: [body.client]. Of mass and density one is given, or neither
// (density then is half the water's).
struct DynamicsSpec {
  bool given = false;                    // there is a [body.client]
  std::optional<double> mass;            // kg, > 0
  std::optional<double> density;         // kg/m^3, > 0: mass = density * enclosed volume
  std::optional<Vec3> center_of_mass_B;  // m; default: the volume's centroid
  std::optional<Mat3> inertia_B;         // kg m^2 about the centre of mass, as a rigid body can have it;
                                         // default: the enclosed volume's, scaled to the mass. In the file:
                                         // [Ixx, Iyy, Izz] or [Ixx, Iyy, Izz, Ixy, Ixz, Iyz]
  Vec3 position = Vec3::Zero();          // m, W: of B's origin at the start
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // q_WB at the start; normalised
  Vec3 linear_velocity = Vec3::Zero();                              // m/s, W: of B's origin
  Vec3 angular_velocity = Vec3::Zero();                             // rad/s, W
  double linear_damping = 0.0;             // N/(m/s), >= 0: force  -c v of the centre of mass
  double linear_damping_quadratic = 0.0;   // N/(m/s)^2:     force  -c |v| v
  double angular_damping = 0.0;            // N m/(rad/s):   torque -c w
  double angular_damping_quadratic = 0.0;  // N m/(rad/s)^2: torque -c |w| w
};

struct MeshFile {
  std::filesystem::path path;  // as resolved against the scene file's directory
};

struct BodyDescription {
  std::int32_t id = 0;
  std::string name;  // default: "body <id>"
  std::variant<MeshFile, Shape> source;
  double scale = 1.0;  // > 0, of the mesh's coordinates; meshes only
  Method method = Method::kHierarchical;
  double tolerance = 0.0;  // 0 to 1, relative to the whole displacement's weight
  OpenPolicy open = OpenPolicy::kRefuse;
  Vec3 reference_B = Vec3::Zero();  // m
  bool hydrostatics = false;        // outputs names them, beside the wrench
  DynamicsSpec client;
  std::string source_location;  // "scene.toml:12", for errors; empty where there is no scene file
};

// As the scene file's `open` and buoyancy-replay's --open name them.
inline constexpr std::array<std::pair<std::string_view, OpenPolicy>, 2> kOpenPolicyNames{
    std::pair{std::string_view("refuse"), OpenPolicy::kRefuse},
    std::pair{std::string_view("dry_boundary"), OpenPolicy::kDryBoundary}};

struct SceneDescription {
  std::string name;  // the file as named, or what stands for it
  Water water;
  ImportLimits limits;
  std::vector<BodyDescription> bodies;  // at least one; ids unique
};

// Errors: no such file, not TOML (with line and column), unknown or missing keys, wrong types or ranges, ids
// used twice, a body with both or neither of mesh and shape.
Expected<SceneDescription> read_scene_file(const std::filesystem::path& path);

// The same from text; name stands for the file in errors, directory resolves relative mesh paths.
Expected<SceneDescription> parse_scene(std::string_view text, const std::string& name,
                                       const std::filesystem::path& directory);

// One body, id 1, scale 1, reference point the mesh's origin, level 0, up +z, density 1025, gravity 9.80665:
// what `buoyancy-replay --mesh` asks for.
SceneDescription single_mesh_scene(const std::filesystem::path& mesh, Method method, double tolerance,
                                   OpenPolicy open);

}  // namespace buoyancy
