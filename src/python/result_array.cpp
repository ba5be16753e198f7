#include "python/result_array.h"

#include <memory>
#include <utility>

#include <pybind11/numpy.h>

#include "python/number_array.h"

namespace buoyancy::python {
namespace {

PyObject* status_type = nullptr;  // never destroyed

// Exports the memory of an owner by the buffer protocol, for memoryviews.
struct ArrayView {
  ElementType type;
  std::vector<Py_ssize_t> shape, strides;
  void* data;
  py::object owner;
};

struct OwnedNumbers {
  std::vector<double> values;
};

}  // namespace

py::object make_array(ElementType type, std::vector<Py_ssize_t> shape, std::vector<Py_ssize_t> strides,
                      void* data, py::handle owner) {
  if (has_numpy()) {
    static const py::handle double_type = py::dtype::of<double>().release();
    static const py::handle int32_type = py::dtype::of<std::int32_t>().release();
    static const py::handle int64_type = py::dtype::of<std::int64_t>().release();
    const py::handle dtype = type == ElementType::kDouble  ? double_type
                             : type == ElementType::kInt32 ? int32_type
                                                           : int64_type;
    return py::array(py::reinterpret_borrow<py::dtype>(dtype), std::move(shape), std::move(strides), data,
                     owner);
  }
  const py::object view = py::cast(std::make_unique<ArrayView>(ArrayView{
      type, std::move(shape), std::move(strides), data, py::reinterpret_borrow<py::object>(owner)}));
  PyObject* const memory = PyMemoryView_FromObject(view.ptr());
  if (memory == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(memory);
}

py::object make_owned_array(std::vector<Py_ssize_t> shape, std::vector<double> values) {
  auto owned = std::make_unique<OwnedNumbers>(OwnedNumbers{std::move(values)});
  double* const data = owned->values.data();
  return make_array(std::move(shape), data, py::cast(std::move(owned)));
}

void define_array_view(py::module_& module) {
  py::class_<ArrayView>(module, "_ArrayView", py::buffer_protocol()).def_buffer([](ArrayView& view) {
    const bool is_double = view.type == ElementType::kDouble;
    const bool is_int32 = view.type == ElementType::kInt32;
    return py::buffer_info(view.data, is_int32 ? 4 : 8,
                           is_double  ? "d"
                           : is_int32 ? "i"
                                      : "q",
                           static_cast<Py_ssize_t>(view.shape.size()), view.shape, view.strides);
  });
  py::class_<OwnedNumbers>(module, "_OwnedNumbers");
}

void define_status(py::module_& module) {
  py::dict members;
  for (int i = 0; i < kBodyStatusCount; ++i) members[to_string(static_cast<BodyStatus>(i))] = i;
  const py::object type =
      py::module_::import("enum").attr("IntEnum")("Status", members, py::arg("module") = "buoyancy");
  type.attr("__doc__") = "Why a body could not be evaluated: the constants of body_wrench_t, and 0 for OK.";
  module.attr("Status") = type;
  status_type = type.inc_ref().ptr();
}

py::object status_object(BodyStatus status) {
  return py::handle(status_type)(static_cast<std::int32_t>(status));
}

const char* explain(BodyStatus status) {
  switch (status) {
    case BodyStatus::kOk:
      return "the wrench is valid";
    case BodyStatus::kUnknownBody:
      return "the service's scene has no body with this id; check that both use the same scene";
    case BodyStatus::kNonFinitePose:
      return "position or quaternion is not finite; the simulation has probably diverged";
    case BodyStatus::kBadQuaternion:
      return "the norm of the quaternion differs from 1 by more than 1e-3; pass (w, x, y, z), normalised";
    case BodyStatus::kNonFiniteTwist:
      return "a velocity that the result depends on is not finite";
    case BodyStatus::kBadLeadTime:
      return "lead_time is not finite";
    case BodyStatus::kOpenEdgeWet:
      return "the mesh is open and its boundary is under water; close the mesh";
    case BodyStatus::kOutOfRange:
      return "the pose or the result is beyond the range of a double";
    case BodyStatus::kNoSea:
      return "the scene's waves come in messages, and none is known here; pass sea=";
    case BodyStatus::kBadCondition:
      return "a message has set a compartment or tank to a value that cannot be used";
    case BodyStatus::kNotCertified:
      return "in waves, the bound on the force's error is above the weight of the body's displacement; the "
             "sea bed falls dry there, or the waves are far shorter than the body";
  }
  return "a status that this version does not know";
}

}  // namespace buoyancy::python
