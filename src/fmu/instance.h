// An instance of an FMU for co-simulation, without the two versions of the standard's functions around it
// (fmi2.cpp, fmi3.cpp): a scene, the values of its variables, and the phase of the standard's state machine.
//
// Outputs belong to the inputs and the time when they are read; doStep moves the time only. What is read
// twice is computed once. Use an instance from one thread at a time; several instances share nothing.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "engine/state_evaluation.h"
#include "fmu/variables.h"
#include "hydrodynamics/hydrodynamic_load.h"
#include "scene/scene.h"
#include "wave_loads/prepared_sea.h"

namespace buoyancy::fmu {

// The values are those of fmi2Status and fmi3Status.
enum class Status : int { kOk = 0, kWarning = 1, kDiscard = 2, kError = 3, kFatal = 4 };

enum class Phase : std::uint8_t { kInstantiated = 1, kInitialization = 2, kStep = 4, kTerminated = 8 };

class Instance {
 public:
  using Logger = std::function<void(Status status, const char* category, const std::string& message)>;

  // Loads the scene of an FMU's resources. Errors: those of read_scene_file() and Scene::prepare(); files
  // that are missing or belong to another instantiation token.
  static Expected<std::unique_ptr<Instance>> open(FmiVersion version, const std::filesystem::path& resources,
                                                  std::string_view token, Logger logger);
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  // Enables the categories; none listed: all of them. Returns kError, and changes nothing, for one that does
  // not exist.
  Status set_logging(bool on, std::span<const char* const> categories);
  // Logs a message if its category is enabled, and returns the status.
  Status report(Status status, const std::string& message) const;

  Phase phase() const { return phase_; }
  Status enter_initialization();
  Status exit_initialization();
  void terminate() { phase_ = Phase::kTerminated; }
  void reset();

  double time() const { return values_.front(); }
  Status set_time(double seconds);

  // Read and write the values of variables; in FMI 3.0 those of all elements one after the other. Number is
  // double, or std::int32_t for integer variables. They return kWarning if a body that they compute has no
  // wrench, unless that was reported before; kError, and change nothing, for a reference that does not exist,
  // has another type or may not be written in this phase, and for another number of values.
  template <typename Number>
  Status get(std::span<const std::uint32_t> references, std::span<Number> values);
  Status set(std::span<const std::uint32_t> references, std::span<const double> values);

  // Sets sensitivity to the derivatives of the unknowns in the direction `seed` of the knowns. unknowns: of
  // force and torque; knowns: inputs of pose and velocity of bodies with has_derivatives(), of velocity alone
  // for those with drag or added mass. Returns kError for all others.
  Status directional_derivative(std::span<const std::uint32_t> unknowns,
                                std::span<const std::uint32_t> knowns, std::span<const double> seed,
                                std::span<double> sensitivity);

  // States hold all values and the phase. A state that another instance saved, or that was freed, is an
  // error.
  void* save_state(void* replaced);
  Status restore_state(const void* state);
  bool free_state(const void* state);
  // The size of a serialised state [bytes]: the same for all states of an FMU.
  std::size_t serialized_size() const;
  Status serialize(const void* state, std::span<std::uint8_t> bytes);
  // Returns nullptr for bytes that are no state of this FMU.
  void* deserialize(std::span<const std::uint8_t> bytes);

 private:
  struct SavedState {
    std::vector<double> values;
    Phase phase;
  };
  // What is known of a body for the current inputs and time.
  struct BodyResult {
    bool has_wrench = false;
    bool has_stiffness = false;
    BodyStatus reported = BodyStatus::kOk;  // the last status
  };
  struct Values {
    const Variable* variable;
    std::size_t first, size;
  };

  Instance(FmiVersion version, SceneDescription description, Scene scene, Logger logger);

  void forget_results();
  std::optional<Values> find(std::uint32_t reference) const;
  // Returns the values that references mean, or an error if there is none or their number is another one.
  Expected<std::vector<Values>> resolve(std::span<const std::uint32_t> references, std::size_t count) const;
  // Sets water_ and sea_ to the parameters.
  Expected<void> set_water();
  const SeaAtTime* waves_now();
  Status compute(const Values& values);
  BodyState state_of(std::size_t body) const;
  // Returns nullptr if a value is out of range. Precondition: the body has a subdivision.
  const BodyCondition* condition_of(std::size_t body);
  Status compute_wrench(std::size_t body);
  BodyHydrostatics hydrostatics_of(std::size_t body);
  void store(std::size_t body, Quantity quantity, std::span<const double> values);
  // Returns the change of force and torque of a body for the changes of the known inputs.
  Expected<Vec6> derivative(std::size_t body, std::span<const Values> knowns, std::span<const double> seed);

  FmiVersion version_;
  SceneDescription description_;
  Scene scene_;
  VariableTable table_;
  Logger logger_;
  std::array<bool, kLogCategories.size()> logged_{};
  Phase phase_ = Phase::kInstantiated;
  std::vector<double> values_;  // see VariableTable
  std::vector<BodyResult> results_;
  std::vector<BodyCondition> conditions_;  // by body
  std::vector<std::unique_ptr<SavedState>> states_;

  bool is_water_set_ = false;  // the following are those of the parameters
  Water water_;
  Current current_;
  std::shared_ptr<const PreparedSea> sea_;
  std::optional<SeaAtTime> waves_;  // of sea_, at time()
};

}  // namespace buoyancy::fmu
