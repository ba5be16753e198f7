#include "c/failure.h"

#include <exception>
#include <new>
#include <stdexcept>
#include <string>

#include "base/floating_point_environment.h"

namespace buoyancy {
namespace {

// The text is either a string or, where there is no memory for one, a literal.
thread_local std::string last_message;
thread_local const char* last_literal = "";  // nullptr: last_message holds the text
constexpr const char* kOutOfMemory =
    "buoyancy: the memory does not suffice for the call; expected less data. Pass fewer poses, or a smaller "
    "mesh.";
constexpr const char* kUnexpected = "buoyancy: an unexpected exception; expected none. Please report it.";

buoyancy_error record_literal(buoyancy_error code, const char* text) noexcept {
  last_literal = text;
  return code;
}

buoyancy_error record(buoyancy_error code, const std::string& message) noexcept {
  try {
    last_message = message;
    last_literal = nullptr;
    return code;
  } catch (...) {
    return record_literal(BUOYANCY_ERROR_MEMORY, kOutOfMemory);
  }
}

}  // namespace

buoyancy_error run_call(CallBody call, void* context) noexcept {
  const DefaultFloatingPoint floating_point;
  try {
    const CallResult result = call(context);
    return result ? record(result->code, result->error.message()) : BUOYANCY_OK;
  } catch (const std::bad_alloc&) {
    return record_literal(BUOYANCY_ERROR_MEMORY, kOutOfMemory);
  } catch (const std::length_error&) {  // of a container that would exceed the address space
    return record_literal(BUOYANCY_ERROR_MEMORY, kOutOfMemory);
  } catch (const std::exception& exception) {
    try {
      const Error error{"buoyancy", exception.what(), "no exception", "a mistake of the library",
                        "Please report it with the call that caused it"};
      return record(BUOYANCY_ERROR_INTERNAL, error.message());
    } catch (...) {
      return record_literal(BUOYANCY_ERROR_INTERNAL, kUnexpected);
    }
  } catch (...) {
    return record_literal(BUOYANCY_ERROR_INTERNAL,
                          "an unexpected exception; expected none. Please report it");
  }
}

}  // namespace buoyancy

extern "C" const char* buoyancy_last_error(void) {
  return buoyancy::last_literal != nullptr ? buoyancy::last_literal : buoyancy::last_message.c_str();
}
