// What the functions of both versions of the standard share: they look up their instance in a registry, so
// that one that was freed is an error, check the phase, and let no exception and no floating-point setting
// pass in either direction.
#pragma once

#include <exception>
#include <memory>
#include <string>

#include "base/floating_point_environment.h"
#include "fmu/instance.h"

namespace buoyancy::fmu {

// The phases in which a function may be called, as a sum of their values.
using Phases = unsigned;
inline constexpr Phases in(Phase phase) {
  return static_cast<Phases>(phase);
}
inline constexpr Phases kInitialised = in(Phase::kInitialization) | in(Phase::kStep) | in(Phase::kTerminated);
inline constexpr Phases kSettable = in(Phase::kInstantiated) | in(Phase::kInitialization) | in(Phase::kStep);
inline constexpr Phases kAnyPhase = kInitialised | in(Phase::kInstantiated);

// Takes the instance over and returns the handle that the host gets.
void* add_instance(std::unique_ptr<Instance> instance);
// Returns nullptr if there is no instance with this handle.
Instance* find_instance(const void* handle);
void free_instance(const void* handle);

// Opens an instance of an FMU for co-simulation; nullptr, after a log message, if that fails.
void* open_instance(FmiVersion version, const std::filesystem::path& resources, const char* token,
                    bool logging, const Instance::Logger& logger);

// Calls call(instance) and returns its status; kError if there is no such instance, if it is in another
// phase, and for an exception.
template <typename Call>
Status call_instance(const void* handle, const char* function, Phases phases, const Call& call) noexcept {
  const DefaultFloatingPoint floating_point;
  try {
    Instance* const instance = find_instance(handle);
    if (instance == nullptr) return Status::kError;
    if ((in(instance->phase()) & phases) == 0) {
      return instance->report(Status::kError, std::string(function) + ": it may not be called in this phase");
    }
    try {
      return call(*instance);
    } catch (const std::exception& exception) {  // no memory
      return instance->report(Status::kError, std::string(function) + ": " + exception.what());
    }
  } catch (...) {
    return Status::kError;
  }
}

// Returns the array of a caller, and an empty one for nullptr.
template <typename Element>
std::span<Element> array_of(Element* first, std::size_t count) {
  return first == nullptr ? std::span<Element>() : std::span(first, count);
}

// The functions that are the same in both versions; those for states differ in nothing but their names.
Status set_debug_logging(const void* handle, const char* function, bool on, std::size_t count,
                         const char* const* categories);
Status save_state(const void* handle, const char* function, void** state);
Status restore_state(const void* handle, const char* function, const void* state);
Status free_state(const void* handle, const char* function, void** state);
Status serialized_size(const void* handle, const char* function, const void* state, std::size_t* size);
Status serialize(const void* handle, const char* function, const void* state, std::uint8_t* bytes,
                 std::size_t size);
Status deserialize(const void* handle, const char* function, const std::uint8_t* bytes, std::size_t size,
                   void** state);
// A function that the FMU does not have: succeeds for no variables, and is an error otherwise.
Status not_supported(const void* handle, const char* function, std::size_t variables = 1);

}  // namespace buoyancy::fmu
