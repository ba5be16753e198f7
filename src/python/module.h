// The parts of the extension module buoyancy._core, each in a file of its own.
#pragma once

#include <string>

#include <pybind11/pybind11.h>

namespace buoyancy::python {

void define_mesh(pybind11::module_& module);    // mesh.cpp
void define_scene(pybind11::module_& module);   // scene.cpp
void define_client(pybind11::module_& module);  // client.cpp
void define_log(pybind11::module_& module);     // log.cpp

// The path that a str or os.PathLike stands for. Throws a TypeError for other objects, a ValueError for a
// path with a zero byte.
std::string to_path(pybind11::handle object);

}  // namespace buoyancy::python
