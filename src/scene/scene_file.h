// Parses a scene file (TOML) into a plain description. Only this module uses toml++.
//
// Rules: an unknown key is an error that names the file, the line and the nearest known key; every number is
// checked against its range. Files of wave components are read here; meshes are not, see Scene.
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

#include "base/current.h"
#include "base/error.h"
#include "geometry/mesh_import.h"
#include "geometry/mesh_validation.h"
#include "geometry/mirroring.h"
#include "geometry/shapes.h"
#include "hydrodynamics/coefficients.h"
#include "hydrostatics/solver.h"
#include "hydrostatics/water_plane.h"
#include "scene/mesh_placement.h"
#include "waves/sea_description.h"

namespace buoyancy {

// Where the simulation of a body starts: see start_pose.h.
enum class StartKind { kPose, kEquilibrium };

// A change of a compartment or a tank during a run: section [[body.client.event]].
struct ConditionEvent {
  double time = 0.0;       // [s], > 0, from the start of the run
  bool is_tank = false;    // else a compartment
  std::int32_t index = 0;  // among the body's compartments or tanks, in the order of the file
  double value = 0.0;      // the share that is flooded, 0 to 1; or the volume of liquid [m^3]
};

// Dynamics of a body, which only a simulator needs: section [body.client]. At most one of mass and density is
// given; without either, the density is half the water's.
struct DynamicsSpec {
  bool given = false;                    // the section exists
  std::optional<double> mass;            // [kg], > 0
  std::optional<double> density;         // [kg/m^3], > 0: mass = density * enclosed volume
  std::optional<Vec3> center_of_mass_B;  // [m]; default: the volume's centroid
  std::optional<Mat3> inertia_B;         // [kg m^2], about the centre of mass, physically possible;
                                         // default: the enclosed volume's, scaled to the mass. In the file:
                                         // [Ixx, Iyy, Izz] or [Ixx, Iyy, Izz, Ixy, Ixz, Iyz]
  StartKind start = StartKind::kPose;    // kEquilibrium: without velocities
  Vec3 position = Vec3::Zero();          // initial position of B's origin [m], W
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // initial q_WB, normalised
  Vec3 linear_velocity = Vec3::Zero();                              // of B's origin [m/s], W
  Vec3 angular_velocity = Vec3::Zero();                             // [rad/s], W
  double linear_damping = 0.0;             // [N/(m/s)], >= 0: force -c v, v of the centre of mass
  double linear_damping_quadratic = 0.0;   // [N/(m/s)^2], >= 0: force -c |v| v
  double angular_damping = 0.0;            // [N m/(rad/s)], >= 0: torque -c w
  double angular_damping_quadratic = 0.0;  // [N m/(rad/s)^2], >= 0: torque -c |w| w
  std::vector<ConditionEvent> events;      // by time
};

// Sections [body.drag] and [body.added_mass]: coefficients.h, with a centre that may be left out.
struct DragDescription {
  Mat6 linear = Mat6::Zero();
  Mat6 quadratic = Mat6::Zero();
  std::optional<Vec3>
      center_B;  // [m]; default: the centre of mass if it is known, else the volume's centroid
  ImmersionScaling immersion = ImmersionScaling::kVolume;
};
struct AddedMassDescription {
  Mat6 matrix = Mat6::Zero();
  std::optional<Vec3> center_B;  // [m]; default: as for the drag
  ImmersionScaling immersion = ImmersionScaling::kVolume;
};

struct MeshFile {
  std::filesystem::path path;  // resolved against the scene file's directory
};

inline constexpr std::array<std::string_view, 2> kRepairPolicyNames{"automatic", "none"};

// Keys `repair`, `mirror`, `close_holes` and `freeboard`.
struct MeshRepair {
  RepairPolicy policy = RepairPolicy::kAutomatic;
  std::optional<Axis> mirror;
  ClosingOptions closing;  // its up_B is that of the body where it starts

  bool operator==(const MeshRepair&) const = default;
};

// A mesh in the frame of a body.
struct MeshDescription {
  std::variant<MeshFile, Shape> source;
  MeshPlacement placement;  // of a shape without a scale
  MeshRepair repair;        // of a file
};

// Sections [[body.part]], [[body.compartment]] and [[body.tank]]: meshes that make up a body, or lie in it.
struct PartDescription {
  std::string name;  // default: "part 0", the number among the parts of the body; likewise below
  MeshDescription mesh;
  std::string source_location;
};
struct CompartmentDescription {
  std::string name;
  MeshDescription mesh;
  double permeability = 1.0;  // above 0, at most 1: the share of its volume that water can fill
  double flooded = 1.0;       // 0 to 1, at the start: the share of that which is open to the sea
  std::string source_location;
};
struct TankDescription {
  std::string name;
  MeshDescription mesh;
  double density = 0.0;                 // [kg/m^3], of the liquid; default: the water's
  std::optional<double> fill;           // 0 to 1, at the start: of the tank's volume; or
  std::optional<double> liquid_volume;  // [m^3], >= 0
  std::optional<Vec3> piston_axis_B;    // unit: of a tank without a free surface, see Tank
  std::string source_location;
};

struct BodyDescription {
  std::int32_t id = 0;
  std::string name;            // default: "body <id>"
  MeshDescription mesh;        // unused where the body consists of its parts alone
  bool is_parts_only = false;  // has no mesh beside its parts
  std::vector<PartDescription> parts;
  std::vector<CompartmentDescription> compartments;
  std::vector<TankDescription> tanks;
  Method method = Method::kHierarchical;
  // 0 to 1, relative to the weight of the full displacement; default: 0, in waves kDefaultWaveTolerance
  std::optional<double> tolerance;
  OpenPolicy open = OpenPolicy::kRefuse;
  Vec3 reference_B = Vec3::Zero();  // torque reference point [m]
  std::optional<Vec3> up_B;   // the axis of B that is up where heel and trim are 0; default: the world's
  bool hydrostatics = false;  // requested by `outputs`, in addition to the wrench
  bool loads = false;         // requested by `outputs`
  std::optional<DragDescription> drag;
  std::optional<AddedMassDescription> added_mass;
  DynamicsSpec dynamics;        // section [body.client]
  std::string source_location;  // "scene.toml:12", for errors; empty without a scene file
};

// Calls visit(mesh, section, name, source_location) for every mesh of a body, or in it. section: "part",
// "compartment" or "tank"; empty for the body's own mesh.
template <typename AnyBodyDescription, typename Visit>
void for_each_mesh(AnyBodyDescription& body, const Visit& visit) {
  if (!body.is_parts_only) visit(body.mesh, std::string_view(), body.name, body.source_location);
  const auto visit_all = [&visit](auto& sections, std::string_view section) {
    for (auto& one : sections) visit(one.mesh, section, one.name, one.source_location);
  };
  visit_all(body.parts, "part");
  visit_all(body.compartments, "compartment");
  visit_all(body.tanks, "tank");
}

// The names in the scene file's `open` and buoyancy-replay's --open.
inline constexpr std::array<std::pair<std::string_view, OpenPolicy>, 2> kOpenPolicyNames{
    std::pair{std::string_view("refuse"), OpenPolicy::kRefuse},
    std::pair{std::string_view("dry_boundary"), OpenPolicy::kDryBoundary}};

struct SceneDescription {
  std::string name;  // the file's name as given, or the name of the text
  Water water;
  SeaDescription sea;              // without wave systems: water at rest, or with a current
  CurrentProfile current_profile;  // sea.current_W is its velocity at the level; empty: there is none
  SeaMessages sea_messages = SeaMessages::kNone;  // those that the sea comes in; `sea` has the current alone
  // A hash of what the text states besides [body.client], names of files and comments; 0 without a text.
  std::uint64_t text_fingerprint = 0;
  std::string water_location;  // of [water]: "scene.toml:3", for errors; empty without it
  ImportLimits limits;
  std::vector<BodyDescription> bodies;  // at least one; ids unique
};

// Errors: no such file; invalid TOML (with line and column); unknown or missing keys; wrong types or ranges;
// duplicate ids; a body with both mesh and shape, or without mesh, shape and parts; an invalid file of wave
// components.
Expected<SceneDescription> read_scene_file(const std::filesystem::path& path);

// Parses a scene from text. name: identifies the text in errors; directory: resolves relative paths.
Expected<SceneDescription> parse_scene(std::string_view text, const std::string& name,
                                       const std::filesystem::path& directory);

// Parses a text that may only have the sections [world] and [water] of a scene. Returns a description without
// bodies.
Expected<SceneDescription> parse_water(std::string_view text, const std::string& name,
                                       const std::filesystem::path& directory);

// Returns the scene of programs with --mesh: one body with id 1 and its origin as reference point; level 0 m,
// up +z, density 1025 kg/m^3, gravity 9.80665 m/s^2.
SceneDescription single_mesh_scene(const std::filesystem::path& mesh, Method method, double tolerance,
                                   OpenPolicy open, const MeshPlacement& placement = {});

}  // namespace buoyancy
