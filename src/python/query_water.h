// The water of a query of a mesh: numbers, or a sea.
#pragma once

#include <memory>
#include <string>

#include <pybind11/pybind11.h>

#include "query/pose_evaluation.h"
#include "query/query_sea.h"

namespace buoyancy::python {

namespace py = pybind11;

// A sea as Python holds it.
struct SeaObject {
  QuerySea sea;
};

// Borrowed from the caller; nullptr where an argument was left out.
struct WaterObjects {
  PyObject* level = nullptr;
  PyObject* density = nullptr;
  PyObject* gravity = nullptr;
  PyObject* up = nullptr;
};

// The water at rest of these numbers, with the ranges and the defaults of the scene file. Throws an
// InputException or a TypeError.
Water to_water(const WaterObjects& objects);

// The water of `sea`, or of the numbers where there is none. Throws a ValueError if both are given and
// differ.
QueryWater to_query_water(const WaterObjects& objects, PyObject* sea);

void define_sea(py::module_& module);

}  // namespace buoyancy::python
