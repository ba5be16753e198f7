// User-facing error: what was wrong with the input and how to fix it.
//
// Contract: every function that can fail on a user's input returns tl::expected<T, Error>. An Error holds
// what the user needs to fix the input: its subject, the actual and the expected value, the likely cause and
// a hint. A condition that only a bug can violate is an assert, never an Error.
#pragma once

#include <string>

#include <tl/expected.hpp>

namespace buoyancy {

struct Error {
  std::string subject;   // the input at fault: "duck.dae", "scene.toml:12: body 3, key 'mass'"
  std::string actual;    // the actual value: "is a directory", "mass = -1"
  std::string expected;  // "a mesh file", "a number above 0 (kg)"
  std::string cause;     // the likely cause; may be empty
  std::string hint;      // what to do; may be empty

  // One line: "<subject>: <actual>; expected <expected>. Likely cause: <cause>. <hint>."
  std::string message() const;
};

// A warning has the same parts as an error, but the operation goes on.
using Warning = Error;

template <typename T>
using Expected = tl::expected<T, Error>;

// Creates the error value for `return make_error({...});` in functions that return Expected<T>.
inline tl::unexpected<Error> make_error(Error error) {
  return tl::unexpected<Error>(std::move(error));
}

}  // namespace buoyancy
