// The functions of FMI 3.0 for co-simulation, as the tables of the standard declare them (fmi-standard.org).
// A function that this FMU does not have takes its first arguments only, which C's calling convention allows.
#include <cstddef>
#include <cstdint>

#include "fmu/fmi_call.h"

using buoyancy::fmu::array_of;
using buoyancy::fmu::call_instance;
using buoyancy::fmu::in;
using buoyancy::fmu::Instance;
using buoyancy::fmu::Phase;
using buoyancy::fmu::Status;

using LogMessage = void (*)(void* environment, Status status, const char* category, const char* message);

// NOLINTBEGIN(readability-identifier-naming): the names are the standard's
extern "C" {

const char* fmi3GetVersion() {
  return "3.0";
}

void* fmi3InstantiateCoSimulation(const char* instance_name, const char* token, const char* resources,
                                  bool /*visible*/, bool logging, bool event_mode_used,
                                  bool /*early_return_allowed*/, const std::uint32_t* /*intermediate*/,
                                  std::size_t /*intermediate_count*/, void* environment, LogMessage log,
                                  const void* /*intermediate_update*/) {
  const auto logger = [environment, log](Status status, const char* category, const std::string& message) {
    if (log != nullptr) log(environment, status, category, message.c_str());
  };
  if (instance_name == nullptr || resources == nullptr || event_mode_used) {
    logger(Status::kError, buoyancy::fmu::kLogCategories.back(),
           "fmi3InstantiateCoSimulation: a name and a path of the resources are expected, and no event mode");
    return nullptr;
  }
  return buoyancy::fmu::open_instance(buoyancy::fmu::FmiVersion::k3, resources, token, logging, logger);
}

void* fmi3InstantiateModelExchange() {
  return nullptr;
}
void* fmi3InstantiateScheduledExecution() {
  return nullptr;
}

void fmi3FreeInstance(void* instance) {
  buoyancy::fmu::free_instance(instance);
}

Status fmi3SetDebugLogging(void* instance, bool on, std::size_t count, const char* const* categories) {
  return buoyancy::fmu::set_debug_logging(instance, "fmi3SetDebugLogging", on, count, categories);
}

Status fmi3EnterInitializationMode(void* instance, bool /*tolerance_defined*/, double /*tolerance*/,
                                   double start_time, bool /*stop_time_defined*/, double /*stop_time*/) {
  return call_instance(instance, "fmi3EnterInitializationMode", in(Phase::kInstantiated),
                       [&](Instance& self) {
                         const Status status = self.set_time(start_time);
                         return status == Status::kOk ? self.enter_initialization() : status;
                       });
}

Status fmi3ExitInitializationMode(void* instance) {
  return call_instance(instance, "fmi3ExitInitializationMode", in(Phase::kInitialization),
                       [](Instance& self) { return self.exit_initialization(); });
}

Status fmi3Terminate(void* instance) {
  return call_instance(instance, "fmi3Terminate", in(Phase::kStep), [](Instance& self) {
    self.terminate();
    return Status::kOk;
  });
}

Status fmi3Reset(void* instance) {
  return call_instance(instance, "fmi3Reset", buoyancy::fmu::kAnyPhase, [](Instance& self) {
    self.reset();
    return Status::kOk;
  });
}

Status fmi3GetFloat64(void* instance, const std::uint32_t* references, std::size_t count, double* values,
                      std::size_t value_count) {
  return call_instance(instance, "fmi3GetFloat64", buoyancy::fmu::kInitialised, [&](Instance& self) {
    return self.get(array_of(references, count), array_of(values, value_count));
  });
}

Status fmi3GetInt32(void* instance, const std::uint32_t* references, std::size_t count, std::int32_t* values,
                    std::size_t value_count) {
  return call_instance(instance, "fmi3GetInt32", buoyancy::fmu::kInitialised, [&](Instance& self) {
    return self.get(array_of(references, count), array_of(values, value_count));
  });
}

Status fmi3SetFloat64(void* instance, const std::uint32_t* references, std::size_t count,
                      const double* values, std::size_t value_count) {
  return call_instance(instance, "fmi3SetFloat64", buoyancy::fmu::kSettable, [&](Instance& self) {
    return self.set(array_of(references, count), array_of(values, value_count));
  });
}

Status fmi3GetFMUState(void* instance, void** state) {
  return buoyancy::fmu::save_state(instance, "fmi3GetFMUState", state);
}
Status fmi3SetFMUState(void* instance, void* state) {
  return buoyancy::fmu::restore_state(instance, "fmi3SetFMUState", state);
}
Status fmi3FreeFMUState(void* instance, void** state) {
  return buoyancy::fmu::free_state(instance, "fmi3FreeFMUState", state);
}
Status fmi3SerializedFMUStateSize(void* instance, void* state, std::size_t* size) {
  return buoyancy::fmu::serialized_size(instance, "fmi3SerializedFMUStateSize", state, size);
}
Status fmi3SerializeFMUState(void* instance, void* state, std::uint8_t* bytes, std::size_t size) {
  return buoyancy::fmu::serialize(instance, "fmi3SerializeFMUState", state, bytes, size);
}
Status fmi3DeserializeFMUState(void* instance, const std::uint8_t* bytes, std::size_t size, void** state) {
  return buoyancy::fmu::deserialize(instance, "fmi3DeserializeFMUState", bytes, size, state);
}

Status fmi3GetDirectionalDerivative(void* instance, const std::uint32_t* unknowns, std::size_t unknown_count,
                                    const std::uint32_t* knowns, std::size_t known_count, const double* seed,
                                    std::size_t seed_count, double* sensitivity,
                                    std::size_t sensitivity_count) {
  return call_instance(
      instance, "fmi3GetDirectionalDerivative", buoyancy::fmu::kInitialised, [&](Instance& self) {
        return self.directional_derivative(array_of(unknowns, unknown_count), array_of(knowns, known_count),
                                           array_of(seed, seed_count),
                                           array_of(sensitivity, sensitivity_count));
      });
}

Status fmi3DoStep(void* instance, double time, double step, bool /*no_earlier_state*/, bool* event_needed,
                  bool* terminate, bool* early_return, double* last_time) {
  return call_instance(instance, "fmi3DoStep", in(Phase::kStep), [&](Instance& self) {
    if (event_needed == nullptr || terminate == nullptr || early_return == nullptr || last_time == nullptr) {
      return self.report(Status::kError, "fmi3DoStep: an output is null");
    }
    *event_needed = *terminate = *early_return = false;
    const Status status = self.set_time(time + step);
    *last_time = self.time();
    return status;
  });
}

// Variables of other types: there are none.
#define BUOYANCY_NO_VARIABLES(function)                                                     \
  Status function(void* instance, const std::uint32_t* /*references*/, std::size_t count) { \
    return buoyancy::fmu::not_supported(instance, #function, count);                        \
  }
BUOYANCY_NO_VARIABLES(fmi3GetFloat32)
BUOYANCY_NO_VARIABLES(fmi3GetInt8)
BUOYANCY_NO_VARIABLES(fmi3GetUInt8)
BUOYANCY_NO_VARIABLES(fmi3GetInt16)
BUOYANCY_NO_VARIABLES(fmi3GetUInt16)
BUOYANCY_NO_VARIABLES(fmi3GetUInt32)
BUOYANCY_NO_VARIABLES(fmi3GetInt64)
BUOYANCY_NO_VARIABLES(fmi3GetUInt64)
BUOYANCY_NO_VARIABLES(fmi3GetBoolean)
BUOYANCY_NO_VARIABLES(fmi3GetString)
BUOYANCY_NO_VARIABLES(fmi3GetBinary)
BUOYANCY_NO_VARIABLES(fmi3GetClock)
BUOYANCY_NO_VARIABLES(fmi3SetFloat32)
BUOYANCY_NO_VARIABLES(fmi3SetInt8)
BUOYANCY_NO_VARIABLES(fmi3SetUInt8)
BUOYANCY_NO_VARIABLES(fmi3SetInt16)
BUOYANCY_NO_VARIABLES(fmi3SetUInt16)
BUOYANCY_NO_VARIABLES(fmi3SetInt32)
BUOYANCY_NO_VARIABLES(fmi3SetUInt32)
BUOYANCY_NO_VARIABLES(fmi3SetInt64)
BUOYANCY_NO_VARIABLES(fmi3SetUInt64)
BUOYANCY_NO_VARIABLES(fmi3SetBoolean)
BUOYANCY_NO_VARIABLES(fmi3SetString)
BUOYANCY_NO_VARIABLES(fmi3SetBinary)
BUOYANCY_NO_VARIABLES(fmi3SetClock)
BUOYANCY_NO_VARIABLES(fmi3GetIntervalDecimal)
BUOYANCY_NO_VARIABLES(fmi3GetIntervalFraction)
BUOYANCY_NO_VARIABLES(fmi3GetShiftDecimal)
BUOYANCY_NO_VARIABLES(fmi3GetShiftFraction)
BUOYANCY_NO_VARIABLES(fmi3SetIntervalDecimal)
BUOYANCY_NO_VARIABLES(fmi3SetIntervalFraction)
BUOYANCY_NO_VARIABLES(fmi3SetShiftDecimal)
BUOYANCY_NO_VARIABLES(fmi3SetShiftFraction)
BUOYANCY_NO_VARIABLES(fmi3GetOutputDerivatives)

// The optional capabilities that the model description denies, and the functions of other kinds of FMU.
#define BUOYANCY_NOT_SUPPORTED(function)                      \
  Status function(void* instance) {                           \
    return buoyancy::fmu::not_supported(instance, #function); \
  }
BUOYANCY_NOT_SUPPORTED(fmi3EnterEventMode)
BUOYANCY_NOT_SUPPORTED(fmi3EnterStepMode)
BUOYANCY_NOT_SUPPORTED(fmi3EnterConfigurationMode)
BUOYANCY_NOT_SUPPORTED(fmi3ExitConfigurationMode)
BUOYANCY_NOT_SUPPORTED(fmi3GetNumberOfVariableDependencies)
BUOYANCY_NOT_SUPPORTED(fmi3GetVariableDependencies)
BUOYANCY_NOT_SUPPORTED(fmi3GetAdjointDerivative)
BUOYANCY_NOT_SUPPORTED(fmi3EvaluateDiscreteStates)
BUOYANCY_NOT_SUPPORTED(fmi3UpdateDiscreteStates)
BUOYANCY_NOT_SUPPORTED(fmi3EnterContinuousTimeMode)
BUOYANCY_NOT_SUPPORTED(fmi3CompletedIntegratorStep)
BUOYANCY_NOT_SUPPORTED(fmi3SetTime)
BUOYANCY_NOT_SUPPORTED(fmi3SetContinuousStates)
BUOYANCY_NOT_SUPPORTED(fmi3GetContinuousStateDerivatives)
BUOYANCY_NOT_SUPPORTED(fmi3GetEventIndicators)
BUOYANCY_NOT_SUPPORTED(fmi3GetContinuousStates)
BUOYANCY_NOT_SUPPORTED(fmi3GetNominalsOfContinuousStates)
BUOYANCY_NOT_SUPPORTED(fmi3GetNumberOfEventIndicators)
BUOYANCY_NOT_SUPPORTED(fmi3GetNumberOfContinuousStates)
BUOYANCY_NOT_SUPPORTED(fmi3ActivateModelPartition)

}  // extern "C"
// NOLINTEND(readability-identifier-naming)
