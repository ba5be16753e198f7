#include "fmu/variables.h"

#include <algorithm>
#include <set>

#include "base/format.h"

namespace buoyancy::fmu {
namespace {

struct Row {
  Quantity quantity;
  std::string_view name;
  Causality causality;
  std::size_t rows, columns;  // 1 and 1: a scalar; columns 1: a vector
  std::string_view unit;
  std::string_view description;
};

// In the order of Quantity.
constexpr std::array<Row, kQuantityCount> kRows{{
    {Quantity::kTime, "time", Causality::kIndependent, 1, 1, "s", "Time: that of the waves"},
    {Quantity::kLevel, "water.level", Causality::kParameter, 1, 1, "m",
     "Height of the water at rest along up"},
    {Quantity::kDensity, "water.density", Causality::kParameter, 1, 1, "kg/m3", "Density of the water"},
    {Quantity::kGravity, "water.gravity", Causality::kParameter, 1, 1, "m/s2", "Gravity"},
    {Quantity::kCurrent, "water.current", Causality::kParameter, 3, 1, "m/s",
     "Velocity of the water beside the waves, world frame"},
    {Quantity::kPosition, "position", Causality::kInput, 3, 1, "m",
     "Position of the origin of the body frame, world frame"},
    {Quantity::kQuaternion, "quaternion", Causality::kInput, 4, 1, "1",
     "Orientation (w, x, y, z): turns the body frame into the world frame; unit"},
    {Quantity::kLinearVelocity, "linear_velocity", Causality::kInput, 3, 1, "m/s",
     "Velocity of the origin of the body frame, world frame"},
    {Quantity::kAngularVelocity, "angular_velocity", Causality::kInput, 3, 1, "rad/s",
     "Angular velocity, world frame"},
    {Quantity::kFlooded, "flooded", Causality::kInput, 1, 1, "1",
     "Share that is open to the sea, 0 to 1, of compartment "},
    {Quantity::kLiquidVolume, "liquid_volume", Causality::kInput, 1, 1, "m3", "Volume of liquid in tank "},
    {Quantity::kStatus, "status", Causality::kOutput, 1, 1, "",
     "0: OK; otherwise all outputs of the body are 0, see STATUS in docs/fmu.md"},
    {Quantity::kForce, "force", Causality::kOutput, 3, 1, "N",
     "Force of the water on the body, world frame, without the weight of the body"},
    {Quantity::kTorque, "torque", Causality::kOutput, 3, 1, "N.m",
     "Torque of the water about the reference point of the body, world frame"},
    {Quantity::kSubmergedVolume, "submerged_volume", Causality::kOutput, 1, 1, "m3", "Displaced volume"},
    {Quantity::kCenterOfBuoyancy, "center_of_buoyancy", Causality::kOutput, 3, 1, "m",
     "Centre of the displaced volume relative to position, world axes"},
    {Quantity::kForceErrorBound, "force_error_bound", Causality::kOutput, 1, 1, "N",
     "Bound on the norm of the error of force"},
    {Quantity::kTorqueErrorBound, "torque_error_bound", Causality::kOutput, 1, 1, "N.m",
     "Bound on the norm of the error of torque"},
    {Quantity::kAddedMass, "added_mass", Causality::kOutput, 6, 6, "",
     "Added mass about the reference point, world axes; kg, kg.m, kg.m2; its force on an accelerating body "
     "is "
     "not part of force"},
    {Quantity::kDamping, "damping", Causality::kOutput, 6, 6, "",
     "-d(force, torque)/d(velocity of the reference point, angular velocity), world axes; N.s/m to "
     "N.m.s/rad"},
    {Quantity::kStiffness, "stiffness", Causality::kOutput, 6, 6, "",
     "-d(force, torque)/d(position of the reference point, rotation), world axes; N/m to N.m/rad"},
}};

// Returns the name of every body as an identifier, each once.
std::vector<std::string> body_names(const Scene& scene) {
  std::set<std::string> taken{"water", "time"};
  std::vector<std::string> names;
  for (const Body& body : scene.bodies()) {
    std::string name = to_identifier(body.name);
    while (!taken.insert(name).second) name = format_text("{}_{}", name, std::int64_t{body.id});
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace

VariableTable::VariableTable(const Scene& scene) : bodies_(scene.bodies().size()) {
  const Water& water = scene.water();
  add(Quantity::kTime, "", "");
  add(Quantity::kLevel, "", "").start = {water.level};
  if (water.layers.empty()) add(Quantity::kDensity, "", "").start = {water.density};
  add(Quantity::kGravity, "", "").start = {water.gravity};
  if (scene.current().profile.empty()) {
    const Vec3& current_W = scene.current_W();
    add(Quantity::kCurrent, "", "").start = {current_W.x(), current_W.y(), current_W.z()};
  }
  const std::vector<std::string> names = body_names(scene);
  for (std::size_t i = 0; i < names.size(); ++i) add_body(scene, i, names[i]);
}

Variable& VariableTable::add(Quantity quantity, const std::string& prefix, const std::string& of) {
  const Row& row = kRows[static_cast<std::size_t>(quantity)];
  Variable variable{.name = prefix + std::string(row.name),
                    .quantity = quantity,
                    .causality = row.causality,
                    .shape = {},
                    .unit = row.unit,
                    .description = std::string(row.description) + of,
                    .start = {},
                    .body = 0,
                    .first = owners_.size(),
                    .size = row.rows * row.columns,
                    .depends_on = {}};
  if (row.rows > 1) variable.shape.push_back(row.rows);
  if (row.columns > 1) variable.shape.push_back(row.columns);
  owners_.insert(owners_.end(), variable.size, variables_.size());
  return variables_.emplace_back(std::move(variable));
}

void VariableTable::add_body(const Scene& scene, std::size_t index, const std::string& name) {
  const Body& body = scene.bodies()[index];
  const std::string prefix = name + ".";
  std::vector<std::size_t> inputs;
  const auto add_variable = [&](Quantity quantity, const std::string& within = {},
                                const std::string& of = {}) -> Variable& {
    Variable& variable = add(quantity, prefix + within, of);
    variable.body = index;
    std::optional<std::size_t>& place = bodies_[index][static_cast<std::size_t>(quantity)];
    if (!place) place = variable.first;
    if (variable.causality == Causality::kOutput) variable.depends_on = inputs;
    return variable;
  };
  const auto add_input = [&](Quantity quantity, std::vector<double> start, bool matters,
                             const std::string& within = {}, const std::string& of = {}) {
    if (matters) inputs.push_back(variables_.size());
    add_variable(quantity, within, of).start = std::move(start);
  };
  if (scene.sea() != nullptr) inputs.push_back(0);
  const bool has_motion = body.hydrodynamics != nullptr;
  add_input(Quantity::kPosition, {0.0, 0.0, 0.0}, true);
  add_input(Quantity::kQuaternion, {1.0, 0.0, 0.0, 0.0}, true);
  add_input(Quantity::kLinearVelocity, {0.0, 0.0, 0.0}, has_motion);
  add_input(Quantity::kAngularVelocity, {0.0, 0.0, 0.0}, has_motion);
  if (body.subdivision != nullptr) {
    const auto within = [](const char* section, std::size_t i) {
      return format_text("{}[{}].", section, i + 1);
    };
    const auto& compartments = body.subdivision->compartments;
    for (std::size_t i = 0; i < compartments.size(); ++i) {
      add_input(Quantity::kFlooded, {compartments[i].flooded}, true, within("compartment", i),
                "'" + compartments[i].name + "'");
    }
    const auto& tanks = body.subdivision->tanks;
    for (std::size_t i = 0; i < tanks.size(); ++i) {
      add_input(Quantity::kLiquidVolume, {tanks[i].liquid_volume}, true, within("tank", i),
                "'" + tanks[i].name + "'");
    }
  }
  for (const Quantity quantity :
       {Quantity::kStatus, Quantity::kForce, Quantity::kTorque, Quantity::kSubmergedVolume,
        Quantity::kCenterOfBuoyancy, Quantity::kForceErrorBound, Quantity::kTorqueErrorBound}) {
    add_variable(quantity);
  }
  if (has_motion) {
    add_variable(Quantity::kAddedMass);
    add_variable(Quantity::kDamping);
  }
  if (body.hydrostatics) add_variable(Quantity::kStiffness);
}

std::vector<double> VariableTable::start_values() const {
  std::vector<double> values(value_count(), 0.0);
  for (const Variable& variable : variables_) {
    std::ranges::copy(variable.start, values.begin() + static_cast<std::ptrdiff_t>(variable.first));
  }
  return values;
}

bool has_derivatives(const Scene& scene, const Body& body) {
  return scene.sea() == nullptr && is_exact(body.solver.method()) && body.solver.mesh().tree.has_value();
}

std::string to_identifier(std::string_view text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  std::string name(text);
  for (char& c : name) {
    if (!is_digit(c) && !(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z')) c = '_';
  }
  if (name.empty() || is_digit(name.front())) name.insert(0, 1, '_');
  return name;
}

}  // namespace buoyancy::fmu
