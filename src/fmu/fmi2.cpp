// The functions of FMI 2.0 for co-simulation, as the tables of the standard declare them (fmi-standard.org).
// A function that this FMU does not have takes its first arguments only, which C's calling convention allows.
#include <cstddef>
#include <cstdint>

#include "fmu/fmi_call.h"
#include "fmu/resource_uri.h"

using buoyancy::fmu::array_of;
using buoyancy::fmu::call_instance;
using buoyancy::fmu::in;
using buoyancy::fmu::Instance;
using buoyancy::fmu::Phase;
using buoyancy::fmu::Status;

// NOLINTBEGIN(readability-identifier-naming): the names are the standard's
extern "C" {

struct fmi2CallbackFunctions {
  void (*logger)(void* environment, const char* instance_name, Status status, const char* category,
                 const char* message, ...);
  void* (*allocateMemory)(std::size_t count, std::size_t size);
  void (*freeMemory)(void* memory);
  void (*stepFinished)(void* environment, Status status);
  void* componentEnvironment;
};

const char* fmi2GetTypesPlatform() {
  return "default";
}
const char* fmi2GetVersion() {
  return "2.0";
}

void* fmi2Instantiate(const char* instance_name, int kind, const char* guid, const char* resources,
                      const fmi2CallbackFunctions* callbacks, int /*visible*/, int logging) {
  const std::string name = instance_name == nullptr ? "" : instance_name;
  const auto log = callbacks == nullptr ? nullptr : callbacks->logger;
  void* const environment = callbacks == nullptr ? nullptr : callbacks->componentEnvironment;
  const auto logger = [log, environment, name](Status status, const char* category,
                                               const std::string& message) {
    // The message is a format, in which '#' begins the reference of a variable.
    std::string format;
    for (const char c : message) format.append(c == '%' || c == '#' ? 2 : 1, c);
    if (log != nullptr) log(environment, name.c_str(), status, category, format.c_str());
  };
  constexpr int kCoSimulation = 1;
  const auto folder = buoyancy::fmu::path_of_uri(resources == nullptr ? "" : resources);
  if (kind != kCoSimulation || instance_name == nullptr || !folder) {
    logger(Status::kError, buoyancy::fmu::kLogCategories.back(),
           "fmi2Instantiate: co-simulation, a name, and the resources as a file URI are expected");
    return nullptr;
  }
  return buoyancy::fmu::open_instance(buoyancy::fmu::FmiVersion::k2, *folder, guid, logging != 0, logger);
}

void fmi2FreeInstance(void* instance) {
  buoyancy::fmu::free_instance(instance);
}

Status fmi2SetDebugLogging(void* instance, int on, std::size_t count, const char* const* categories) {
  return buoyancy::fmu::set_debug_logging(instance, "fmi2SetDebugLogging", on != 0, count, categories);
}

Status fmi2SetupExperiment(void* instance, int /*tolerance_defined*/, double /*tolerance*/, double start_time,
                           int /*stop_time_defined*/, double /*stop_time*/) {
  return call_instance(instance, "fmi2SetupExperiment", in(Phase::kInstantiated),
                       [&](Instance& self) { return self.set_time(start_time); });
}

Status fmi2EnterInitializationMode(void* instance) {
  return call_instance(instance, "fmi2EnterInitializationMode", in(Phase::kInstantiated),
                       [](Instance& self) { return self.enter_initialization(); });
}

Status fmi2ExitInitializationMode(void* instance) {
  return call_instance(instance, "fmi2ExitInitializationMode", in(Phase::kInitialization),
                       [](Instance& self) { return self.exit_initialization(); });
}

Status fmi2Terminate(void* instance) {
  return call_instance(instance, "fmi2Terminate", in(Phase::kStep), [](Instance& self) {
    self.terminate();
    return Status::kOk;
  });
}

Status fmi2Reset(void* instance) {
  return call_instance(instance, "fmi2Reset", buoyancy::fmu::kAnyPhase, [](Instance& self) {
    self.reset();
    return Status::kOk;
  });
}

Status fmi2GetReal(void* instance, const std::uint32_t* references, std::size_t count, double* values) {
  return call_instance(instance, "fmi2GetReal", buoyancy::fmu::kInitialised, [&](Instance& self) {
    return self.get(array_of(references, count), array_of(values, count));
  });
}

Status fmi2GetInteger(void* instance, const std::uint32_t* references, std::size_t count,
                      std::int32_t* values) {
  return call_instance(instance, "fmi2GetInteger", buoyancy::fmu::kInitialised, [&](Instance& self) {
    return self.get(array_of(references, count), array_of(values, count));
  });
}

Status fmi2SetReal(void* instance, const std::uint32_t* references, std::size_t count, const double* values) {
  return call_instance(instance, "fmi2SetReal", buoyancy::fmu::kSettable, [&](Instance& self) {
    return self.set(array_of(references, count), array_of(values, count));
  });
}

Status fmi2GetFMUstate(void* instance, void** state) {
  return buoyancy::fmu::save_state(instance, "fmi2GetFMUstate", state);
}
Status fmi2SetFMUstate(void* instance, void* state) {
  return buoyancy::fmu::restore_state(instance, "fmi2SetFMUstate", state);
}
Status fmi2FreeFMUstate(void* instance, void** state) {
  return buoyancy::fmu::free_state(instance, "fmi2FreeFMUstate", state);
}
Status fmi2SerializedFMUstateSize(void* instance, void* state, std::size_t* size) {
  return buoyancy::fmu::serialized_size(instance, "fmi2SerializedFMUstateSize", state, size);
}
Status fmi2SerializeFMUstate(void* instance, void* state, std::uint8_t* bytes, std::size_t size) {
  return buoyancy::fmu::serialize(instance, "fmi2SerializeFMUstate", state, bytes, size);
}
Status fmi2DeSerializeFMUstate(void* instance, const std::uint8_t* bytes, std::size_t size, void** state) {
  return buoyancy::fmu::deserialize(instance, "fmi2DeSerializeFMUstate", bytes, size, state);
}

Status fmi2GetDirectionalDerivative(void* instance, const std::uint32_t* unknowns, std::size_t unknown_count,
                                    const std::uint32_t* knowns, std::size_t known_count, const double* seed,
                                    double* sensitivity) {
  return call_instance(
      instance, "fmi2GetDirectionalDerivative", buoyancy::fmu::kInitialised, [&](Instance& self) {
        return self.directional_derivative(array_of(unknowns, unknown_count), array_of(knowns, known_count),
                                           array_of(seed, known_count), array_of(sensitivity, unknown_count));
      });
}

Status fmi2DoStep(void* instance, double time, double step, int /*no_earlier_state*/) {
  return call_instance(instance, "fmi2DoStep", in(Phase::kStep),
                       [&](Instance& self) { return self.set_time(time + step); });
}

Status fmi2GetRealStatus(void* instance, int kind, double* value) {
  constexpr int kLastSuccessfulTime = 2;
  return call_instance(instance, "fmi2GetRealStatus", in(Phase::kStep), [&](Instance& self) {
    if (kind != kLastSuccessfulTime || value == nullptr) {
      return self.report(Status::kError, "fmi2GetRealStatus: only the last successful time is known");
    }
    *value = self.time();
    return Status::kOk;
  });
}

// Variables of other types: there are none.
#define BUOYANCY_NO_VARIABLES(function)                                                     \
  Status function(void* instance, const std::uint32_t* /*references*/, std::size_t count) { \
    return buoyancy::fmu::not_supported(instance, #function, count);                        \
  }
BUOYANCY_NO_VARIABLES(fmi2GetBoolean)
BUOYANCY_NO_VARIABLES(fmi2GetString)
BUOYANCY_NO_VARIABLES(fmi2SetInteger)
BUOYANCY_NO_VARIABLES(fmi2SetBoolean)
BUOYANCY_NO_VARIABLES(fmi2SetString)
BUOYANCY_NO_VARIABLES(fmi2SetRealInputDerivatives)
BUOYANCY_NO_VARIABLES(fmi2GetRealOutputDerivatives)

// What the model description denies: steps are never pending.
#define BUOYANCY_NOT_SUPPORTED(function)                      \
  Status function(void* instance) {                           \
    return buoyancy::fmu::not_supported(instance, #function); \
  }
BUOYANCY_NOT_SUPPORTED(fmi2CancelStep)
BUOYANCY_NOT_SUPPORTED(fmi2GetStatus)
BUOYANCY_NOT_SUPPORTED(fmi2GetIntegerStatus)
BUOYANCY_NOT_SUPPORTED(fmi2GetBooleanStatus)
BUOYANCY_NOT_SUPPORTED(fmi2GetStringStatus)

}  // extern "C"
// NOLINTEND(readability-identifier-naming)
