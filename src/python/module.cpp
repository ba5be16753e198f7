// The extension module buoyancy._core. The package buoyancy (buoyancy/__init__.py) exports its names.

#include "python/module.h"

#include "python/exceptions.h"
#include "python/query_water.h"
#include "python/status.h"
#include "python/wrenches.h"

namespace buoyancy::python {

std::string to_path(py::handle object) {
  PyObject* encoded = nullptr;
  if (PyUnicode_FSConverter(object.ptr(), &encoded) == 0) throw py::error_already_set();
  return std::string(py::reinterpret_steal<py::bytes>(encoded));
}

}  // namespace buoyancy::python

PYBIND11_MODULE(_core, module) {
  using namespace buoyancy::python;
  py::options options;
  options.disable_function_signatures();
  define_exceptions(module);
  define_status(module);
  define_wrenches(module);
  define_sea(module);
  define_mesh(module);
  define_scene(module);
  define_client(module);
  define_log(module);
}
