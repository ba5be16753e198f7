#include "python/exceptions.h"

#include <cstring>

#include <unistd.h>

namespace buoyancy::python {
namespace {

// Never destroyed: exceptions may be raised while the interpreter shuts down.
PyObject* error_type = nullptr;
PyObject* input_error_type = nullptr;
PyObject* service_error_type = nullptr;
PyObject* status_error_type = nullptr;

PyObject* define(py::module_& module, const char* name, const char* doc, const py::tuple& bases,
                 const py::object& attributes = py::none()) {
  const std::string full_name = std::string("buoyancy.") + name;
  PyObject* const type = PyErr_NewExceptionWithDoc(full_name.c_str(), doc, bases.ptr(),
                                                   attributes.is_none() ? nullptr : attributes.ptr());
  if (type == nullptr) throw py::error_already_set();
  module.attr(name) = py::handle(type);
  return type;
}

// Returns the text as a str. It may name a file whose name is not UTF-8.
py::object decoded(const char* text) {
  return py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(text, static_cast<Py_ssize_t>(std::strlen(text)), "backslashreplace"));
}

// Sets Python's error.
void set_error(PyObject* type, const char* text) {
  if (const py::object message = decoded(text)) PyErr_SetObject(type, message.ptr());
}

void set_error(const InputException& exception) {
  if (exception.report().empty()) return set_error(input_error_type, exception.what());
  const py::object message = decoded(exception.what());
  if (!message) return;
  const py::object error =
      py::reinterpret_steal<py::object>(PyObject_CallOneArg(input_error_type, message.ptr()));
  const py::object report = decoded(exception.report().c_str());
  if (!error || !report || PyObject_SetAttrString(error.ptr(), "report", report.ptr()) < 0) return;
  PyErr_SetObject(input_error_type, error.ptr());
}

void translate(std::exception_ptr pointer) {
  try {
    if (pointer) std::rethrow_exception(std::move(pointer));
  } catch (const InputException& exception) {
    set_error(exception);
  } catch (const ServiceException& exception) {
    set_error(service_error_type, exception.what());
  } catch (const StatusException& exception) {
    set_error(status_error_type, exception.what());
  }
}

}  // namespace

void define_exceptions(py::module_& module) {
  const auto with_base = [](PyObject* base) {
    return py::make_tuple(py::handle(error_type), py::handle(base));
  };
  error_type = define(module, "Error", "Base class of the exceptions of this module.",
                      py::make_tuple(py::handle(PyExc_Exception)));
  py::dict attributes;
  attributes["report"] = py::none();
  input_error_type = define(
      module, "InputError",
      R"(A mesh, a scene, a sea, a file or a number that cannot be used. The text says what was found, what is
expected, the likely cause and what to do.

report: str, the whole report of a mesh that is refused; None for other errors.)",
      with_base(PyExc_ValueError), attributes);
  service_error_type = define(module, "ServiceError",
                              "No response from buoyancyd, a failure of the network, or a closed client.",
                              with_base(PyExc_RuntimeError));
  status_error_type =
      define(module, "StatusError", "A pose that could not be evaluated. Raised by raise_for_status() only.",
             with_base(PyExc_ValueError));
  py::register_exception_translator(&translate);
}

void take_gil_again(PyThreadState* state) noexcept {
  try {
    PyEval_RestoreThread(state);
  } catch (...) {
    // This is no exception, but the C library's unwinding for pthread_exit(). It has no object: to catch it
    // by its type, abi::__forced_unwind, would bind a reference to nothing.
    while (true) pause();
  }
}

void set_python_error() noexcept {
  try {
    translate(std::current_exception());
  } catch (py::error_already_set& error) {
    error.restore();
  } catch (const py::builtin_exception& exception) {
    exception.set_error();
  } catch (const std::bad_alloc&) {
    PyErr_NoMemory();
  } catch (const std::exception& exception) {
    PyErr_SetString(PyExc_RuntimeError, exception.what());
  }
}

}  // namespace buoyancy::python
