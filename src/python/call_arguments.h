// Adds properties and methods to classes. Python calls these methods by its fastest convention
// (METH_FASTCALL): pybind11 takes 1 to 2 us for a dozen keyword arguments, more than a query of a dry body.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>

#include <pybind11/pybind11.h>

#include "python/exceptions.h"

namespace buoyancy::python {

template <std::size_t kCount>
using Parameters = std::array<const char*, kCount>;

// One object per parameter, borrowed from the caller; nullptr where it was left out.
template <std::size_t kCount>
using Arguments = std::array<PyObject*, kCount>;

// The names of a method's parameters in their order. Created once, never destroyed.
template <std::size_t kCount>
class Signature {
 public:
  // The first `positional` parameters must be passed, and may be by position; all others are keywords.
  Signature(const char* method, std::size_t positional, const Parameters<kCount>& names)
      : method_(method), positional_(positional), text_(names) {
    for (std::size_t i = 0; i < kCount; ++i) names_[i] = PyUnicode_InternFromString(names[i]);
  }

  // Throws a TypeError as Python's own functions do.
  Arguments<kCount> parse(PyObject* const* arguments, Py_ssize_t count, PyObject* keywords) const {
    Arguments<kCount> values{};
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
    for (std::size_t i = 0; i < positional_; ++i) {
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
  std::size_t positional_;
  Parameters<kCount> text_;
  std::array<PyObject*, kCount> names_{};
};

// Adds kMethod to a class: a function of self and of the arguments, which returns a py::object and may throw.
// positional: see Signature.
template <auto kMethod, std::size_t kCount>
void add_method(py::handle type, const char* name, std::size_t positional,
                const Parameters<kCount>& parameters, const char* doc) {
  static const Signature<kCount> signature(name, positional, parameters);
  using Caller = PyObject* (*)(PyObject*, PyObject* const*, Py_ssize_t, PyObject*);
  const Caller call = [](PyObject* self, PyObject* const* arguments, Py_ssize_t count,
                         PyObject* keywords) noexcept -> PyObject* {
    const DefaultFloatingPoint floating_point;
    try {
      return kMethod(self, signature.parse(arguments, count, keywords)).release().ptr();
    } catch (...) {
      set_python_error();
      return nullptr;
    }
  };
  static PyMethodDef definition{name, reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(call)),
                                METH_FASTCALL | METH_KEYWORDS, doc};
  PyObject* const method = PyDescr_NewMethod(reinterpret_cast<PyTypeObject*>(type.ptr()), &definition);
  if (method == nullptr) throw py::error_already_set();
  type.attr(name) = py::reinterpret_steal<py::object>(method);
}

// Adds a read-only property. value: a member of the object, or a function of it.
template <typename T, typename Value>
void add_property(py::class_<T>& type, const char* name, Value value, const char* doc) {
  type.def_property_readonly(
      name, [value](py::handle self) { return std::invoke(value, instance_of<T>(self)); }, doc);
}

// Returns whether the caller gave the argument. One that was left out, or is None, has its default.
inline bool is_given(PyObject* argument) {
  return argument != nullptr && argument != Py_None;
}

}  // namespace buoyancy::python
