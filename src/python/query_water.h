// The water of a query of a mesh: numbers, or a sea.
#pragma once

#include <pybind11/eigen.h>

#include "python/call_arguments.h"
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

// Adds the properties of the water that a function of the object returns.
template <typename T, typename WaterOf>
void add_water_properties(py::class_<T>& type, WaterOf water) {
  const auto add = [&](const char* name, auto Water::*member, const char* doc) {
    add_property(
        type, name, [=](const T& object) { return water(object).*member; }, doc);
  };
  add("level", &Water::level, "float, m: the surface at rest is where up . x = level.");
  add("density", &Water::density, "float, kg/m^3.");
  add("gravity", &Water::gravity, "float, m/s^2.");
  add("up", &Water::up_W, "(3,): unit vector, world frame.");
}

void define_sea(py::module_& module);

}  // namespace buoyancy::python
