// Python values as TOML, so that a Sea takes the keys, the ranges and the errors of the scene file.
#pragma once

#include <string>

#include <pybind11/pybind11.h>

namespace buoyancy::python {

// A dict becomes an inline table, a list, a tuple or a numpy array an array; numbers keep every bit. Throws a
// TypeError for a value that TOML does not have. name: of the key, for errors.
std::string to_toml(pybind11::handle value, const std::string& name);

// "key = value\n"
std::string toml_line(pybind11::handle key, pybind11::handle value);

}  // namespace buoyancy::python
