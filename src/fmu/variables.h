// The variables of an FMU, each described once: both model descriptions, value references, getters, setters
// and dependencies follow from this table. docs/fmu.md explains them to users.
//
// The values of all variables are one array of doubles. A value reference is the index of a variable's first
// value, so that FMI 3.0, which has arrays, and FMI 2.0, which has an element in each reference, share it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace buoyancy::fmu {

enum class FmiVersion { k2, k3 };

// The files in the resources of an FMU besides those that the scene names.
inline constexpr const char* kSceneFile = "scene.toml";
// The instantiation token in the first line, then the id of each body that the FMU has.
inline constexpr const char* kInstantiationFile = "instantiation.txt";

// The categories of log messages.
inline constexpr std::array<const char*, 3> kLogCategories{"logAll", "logStatusWarning", "logStatusError"};

enum class Causality { kIndependent, kParameter, kInput, kOutput };

enum class Quantity {
  kTime,
  kLevel,
  kDensity,
  kGravity,
  kCurrent,
  kPosition,
  kQuaternion,
  kLinearVelocity,
  kAngularVelocity,
  kFlooded,
  kLiquidVolume,
  kStatus,
  kForce,
  kTorque,
  kSubmergedVolume,
  kCenterOfBuoyancy,
  kForceErrorBound,
  kTorqueErrorBound,
  kAddedMass,
  kDamping,
  kStiffness,
};
inline constexpr std::size_t kQuantityCount = 21;

// A unit as exponents of the SI's base units, and of the radian.
struct Unit {
  std::string_view name;
  int kg, m, s, rad;
};
inline constexpr std::array<Unit, 10> kUnits{{{"s", 0, 0, 1, 0},
                                              {"m", 0, 1, 0, 0},
                                              {"m/s", 0, 1, -1, 0},
                                              {"m/s2", 0, 1, -2, 0},
                                              {"m3", 0, 3, 0, 0},
                                              {"rad/s", 0, 0, -1, 1},
                                              {"kg/m3", 1, -3, 0, 0},
                                              {"N", 1, 1, -2, 0},
                                              {"N.m", 1, 2, -2, 0},
                                              {"1", 0, 0, 0, 0}}};

struct Variable {
  std::string name;  // "duck.position"
  Quantity quantity = Quantity::kTime;
  Causality causality = Causality::kOutput;
  std::vector<std::size_t> shape;  // {3}, {6, 6}; empty: a scalar
  std::string_view unit;           // of kUnits; empty: the description says it
  std::string description;
  std::vector<double> start;            // of parameters and inputs
  std::size_t body = 0;                 // index into the scene's, of a variable that belongs to one
  std::size_t first = 0;                // value reference: index of its first value
  std::size_t size = 1;                 // number of values
  std::vector<std::size_t> depends_on;  // of outputs: indices of inputs, and of time, in the table

  bool is_integer() const { return quantity == Quantity::kStatus; }
};

class VariableTable {
 public:
  // scene: it does not receive its waves.
  explicit VariableTable(const Scene& scene);

  const std::vector<Variable>& variables() const { return variables_; }
  std::size_t value_count() const { return owners_.size(); }
  // The variable that has a value; nullptr: there is no such value.
  const Variable* owner(std::size_t value) const {
    return value < owners_.size() ? &variables_[owners_[value]] : nullptr;
  }
  // The first value of a body's quantity; nullopt if it has none. O(1).
  std::optional<std::size_t> place(std::size_t body, Quantity quantity) const {
    return bodies_[body][static_cast<std::size_t>(quantity)];
  }
  std::vector<double> start_values() const;

 private:
  Variable& add(Quantity quantity, const std::string& prefix, const std::string& of);
  void add_body(const Scene& scene, std::size_t index, const std::string& name);

  std::vector<Variable> variables_;
  std::vector<std::size_t> owners_;  // by value
  std::vector<std::array<std::optional<std::size_t>, kQuantityCount>> bodies_;
};

// Returns whether an FMU has directional derivatives of a body's force and torque: its water is at rest and
// its stiffness exact.
bool has_derivatives(const Scene& scene, const Body& body);

// Returns the text with '_' in place of what an identifier of C cannot have.
std::string to_identifier(std::string_view text);

}  // namespace buoyancy::fmu
