// Why a pose could not be evaluated: buoyancy.Status, an IntEnum.
#pragma once

#include <pybind11/pybind11.h>

#include "messages/request.h"

namespace buoyancy::python {

namespace py = pybind11;

void define_status(py::module_& module);
py::object status_object(BodyStatus status);

// What a status means and what to do, as a phrase.
const char* explain(BodyStatus status);

}  // namespace buoyancy::python
