// What is told to a person whose input could not be used.
//
// Everything that can fail on somebody's input returns tl::expected<T, Error>. An Error holds what that
// person needs to mend it: the thing looked at, what was found, what was expected, the likely cause and what
// to do. What only a bug of ours can break is an assert, never an Error.
#pragma once

#include <string>

#include <tl/expected.hpp>

namespace buoyancy {

struct Error {
  std::string subject;   // what was looked at: "duck.dae", "scene.toml:12: body 3, key 'mass'"
  std::string actual;    // the value found: "is a directory", "mass = -1"
  std::string expected;  // "a mesh file", "a number above 0 (kg)"
  std::string cause;     // the likely cause; may be empty
  std::string hint;      // what to do; may be empty

  // One line: "<subject>: <actual>; expected <expected>. Likely cause: <cause>. <hint>."
  std::string message() const;
};

template <typename T>
using Expected = tl::expected<T, Error>;

// For `return make_error({...});` in functions that return Expected<T>.
inline tl::unexpected<Error> make_error(Error error) {
  return tl::unexpected<Error>(std::move(error));
}

}  // namespace buoyancy
