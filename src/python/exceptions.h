// Errors of the libraries as Python exceptions: buoyancy.Error and its subclasses (docs/libraries.md).
#pragma once

#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include <pybind11/pybind11.h>

#include "base/error.h"
#include "base/floating_point_environment.h"

namespace buoyancy::python {

namespace py = pybind11;

// Thrown by bindings; becomes buoyancy.InputError, which is a ValueError too.
class InputException : public std::runtime_error {
 public:
  // report: of the mesh that is refused, which becomes the attribute of that name; empty for other errors.
  explicit InputException(const Error& error, std::string report = "")
      : std::runtime_error(error.message()), report_(std::move(report)) {}

  const std::string& report() const { return report_; }

 private:
  std::string report_;
};

// Becomes buoyancy.ServiceError, which is a RuntimeError too.
class ServiceException : public std::runtime_error {
 public:
  explicit ServiceException(const Error& error) : std::runtime_error(error.message()) {}
};

// Becomes buoyancy.StatusError, which is a ValueError too.
class StatusException : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Issues a UserWarning. Needs Python's lock; throws where warnings are errors.
inline void warn(const Warning& warning) {
  if (PyErr_WarnEx(PyExc_UserWarning, warning.message().c_str(), 1) < 0) throw py::error_already_set();
}

template <typename Exception = InputException, typename T>
T value_or_throw(Expected<T> expected) {
  if (!expected) throw Exception(expected.error());
  return *std::move(expected);
}

// Adds the exceptions to the module, and has pybind11 translate those above into them.
void define_exceptions(py::module_& module);

// Sets Python's error indicator from the exception that is being handled. For functions that Python calls
// without pybind11 in between.
void set_python_error() noexcept;

// The text as a str, also if it names a file whose name is not UTF-8: Python's file names have such bytes as
// lone surrogates.
inline py::str to_str(const std::string& text) {
  PyObject* const decoded =
      PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "surrogateescape");
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

// The name of a class without its module, for errors.
inline const char* short_name(const PyTypeObject* type) {
  const char* const dot = std::strrchr(type->tp_name, '.');
  return dot == nullptr ? type->tp_name : dot + 1;
}

// An object of a class of the module. Throws a TypeError for another object, and for one that was created
// without a call of __init__.
template <typename T>
T& instance_of(py::handle object) {
  static const py::detail::type_info* const info = py::detail::get_type_info(typeid(T));
  if (PyObject_TypeCheck(object.ptr(), info->type) == 0) {
    throw py::type_error(std::string("expected a ") + short_name(info->type) + ", got a " +
                         short_name(Py_TYPE(object.ptr())));
  }
  py::detail::value_and_holder holder =
      reinterpret_cast<py::detail::instance*>(object.ptr())->get_value_and_holder(info);
  if (!holder.holder_constructed()) {
    throw py::type_error(std::string("this ") + short_name(Py_TYPE(object.ptr())) +
                         " was never initialised: call its class, not __new__()");
  }
  return *static_cast<T*>(holder.value_ptr());
}

// Takes the global interpreter lock again, for the thread that released it. A thread that outlives the
// interpreter never gets it: Python ends such a thread by unwinding its stack, which would run destructors
// that need the lock. It waits here instead for the end of the process, as it does from Python 3.14 on.
void take_gil_again(PyThreadState* state) noexcept;

// Releases Python's global interpreter lock for the life of this object, and keeps the program's
// floating-point environment away from what is computed meanwhile.
class WithoutGil {
 public:
  WithoutGil() : state_(PyEval_SaveThread()) {}
  ~WithoutGil() { take_gil_again(state_); }
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

 private:
  PyThreadState* state_;
  DefaultFloatingPoint floating_point_;
};

}  // namespace buoyancy::python
