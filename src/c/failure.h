// The boundary of the C interface: what a call returns, and the text that buoyancy_last_error() gives for it.
#pragma once

#include <optional>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "c/buoyancy.h"

namespace buoyancy {

// Why a call fails.
struct Failure {
  buoyancy_error code = BUOYANCY_ERROR_INTERNAL;
  Error error;
};

// nullopt: the call succeeds.
using CallResult = std::optional<Failure>;

inline CallResult failure(buoyancy_error code, Error error) {
  return Failure{code, std::move(error)};
}

using CallBody = CallResult (*)(void* context);
buoyancy_error run_call(CallBody call, void* context) noexcept;

// Makes the call and returns its code. A failure becomes this thread's last error, and so does an exception.
// It takes no std::function, since making one may throw outside of the code that catches exceptions.
template <typename Call>
buoyancy_error run_call(Call&& call) noexcept {
  return run_call([](void* context) { return (*static_cast<std::remove_reference_t<Call>*>(context))(); },
                  &call);
}

}  // namespace buoyancy
