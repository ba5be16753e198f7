#include "python/status.h"

#include <cstdint>

namespace buoyancy::python {
namespace {

PyObject* status_type = nullptr;  // never destroyed

}  // namespace

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
