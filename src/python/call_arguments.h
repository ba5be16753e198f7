// The arguments of methods that Python calls by its fastest convention (METH_FASTCALL). pybind11 takes one to
// two microseconds for a dozen keyword arguments, more than a query of a dry body.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include <pybind11/pybind11.h>

#include "python/exceptions.h"

namespace buoyancy::python {

// The names of a method's parameters in their order. Created once, never destroyed.
template <std::size_t kCount>
class Signature {
 public:
  // positional: how many parameters may be passed by position; required: how many must be passed.
  Signature(const char* method, std::size_t positional, std::size_t required,
            const std::array<const char*, kCount>& names)
      : method_(method), positional_(positional), required_(required), text_(names) {
    for (std::size_t i = 0; i < kCount; ++i) names_[i] = PyUnicode_InternFromString(names[i]);
  }

  // One object per parameter, borrowed from the caller; nullptr where it was left out. Throws a TypeError as
  // Python's own functions do.
  std::array<PyObject*, kCount> parse(PyObject* const* arguments, Py_ssize_t count,
                                      PyObject* keywords) const {
    std::array<PyObject*, kCount> values{};
    const auto by_position = static_cast<std::size_t>(count);
    if (by_position > positional_) {
      fail("takes at most " + std::to_string(positional_) + " positional arguments, got " +
           std::to_string(count));
    }
    for (std::size_t i = 0; i < by_position; ++i) values[i] = arguments[i];
    const Py_ssize_t by_name = keywords == nullptr ? 0 : PyTuple_GET_SIZE(keywords);
    for (Py_ssize_t k = 0; k < by_name; ++k) {
      PyObject* const name = PyTuple_GET_ITEM(keywords, k);
      const std::size_t i = find(name);
      if (i == kCount)
        fail("got an unexpected keyword argument '" + std::string(py::str(py::handle(name))) + "'");
      if (values[i] != nullptr) fail(std::string("got multiple values for argument '") + text_[i] + "'");
      values[i] = arguments[count + k];
    }
    for (std::size_t i = 0; i < required_; ++i) {
      if (values[i] == nullptr) fail(std::string("is missing the argument '") + text_[i] + "'");
    }
    return values;
  }

 private:
  std::size_t find(PyObject* name) const {
    for (std::size_t i = 0; i < kCount; ++i) {
      if (name == names_[i]) return i;
    }
    for (std::size_t i = 0; i < kCount; ++i) {
      if (PyUnicode_CompareWithASCIIString(name, text_[i]) == 0) return i;
    }
    return kCount;
  }
  [[noreturn]] void fail(const std::string& reason) const {
    throw py::type_error(std::string(method_) + "() " + reason);
  }

  const char* method_;
  std::size_t positional_, required_;
  std::array<const char*, kCount> text_;
  std::array<PyObject*, kCount> names_{};
};

// Calls a function that returns a py::object and may throw, and returns a new reference or nullptr with
// Python's error indicator set.
template <typename Function>
PyObject* guarded(Function function) noexcept {
  const DefaultFloatingPoint floating_point;
  try {
    return function().release().ptr();
  } catch (...) {
    set_python_error();
    return nullptr;
  }
}

// Adds such a method to a class.
inline void add_method(py::handle type, PyMethodDef& definition) {
  PyObject* const method = PyDescr_NewMethod(reinterpret_cast<PyTypeObject*>(type.ptr()), &definition);
  if (method == nullptr) throw py::error_already_set();
  type.attr(definition.ml_name) = py::reinterpret_steal<py::object>(method);
}

// Borrowed arguments that were left out, or None, have their default.
inline bool is_given(PyObject* argument) {
  return argument != nullptr && argument != Py_None;
}

}  // namespace buoyancy::python
