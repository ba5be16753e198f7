#include "python/wrenches.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <utility>

#include <pybind11/stl.h>

#include "base/format.h"
#include "messages/wire_layout.h"
#include "python/call_arguments.h"
#include "python/slices.h"
#include "python/status.h"

namespace buoyancy::python {
namespace {

constexpr std::size_t kDoublesPerPose = 12;

// Arrays of the loads of a result, which this object keeps alive.
struct LoadsView {
  py::object result;
  std::span<BodyLoads> loads;
  bool single;
};

struct HydrostaticsTable {
  std::vector<BodyHydrostatics> rows;
  bool single;
};

std::size_t wrenches_failed(const Wrenches& wrenches) {
  return static_cast<std::size_t>(
      std::ranges::count_if(wrenches.arrays().statuses, [](std::int32_t status) { return status != 0; }));
}

// A view of a part of the result with this many numbers per pose; a number of one pose is a float.
py::object part_of(py::handle self, std::span<double> WrenchArrays::*part, py::ssize_t width) {
  auto& wrenches = instance_of<Wrenches>(self);
  double* const data = (wrenches.arrays().*part).data();
  if (wrenches.single() && width == 1) return py::float_(*data);
  std::vector<py::ssize_t> shape;
  if (!wrenches.single()) shape.push_back(static_cast<py::ssize_t>(wrenches.size()));
  if (width > 1) shape.push_back(width);
  return py::array_t<double>(std::move(shape), data, self);
}

py::object statuses(py::handle self) {
  auto& wrenches = instance_of<Wrenches>(self);
  if (wrenches.single()) return status_object(static_cast<BodyStatus>(wrenches.arrays().statuses[0]));
  const std::span<std::int32_t> all = wrenches.arrays().statuses;
  return py::array_t<std::int32_t>(static_cast<py::ssize_t>(all.size()), all.data(), self);
}

// "pose 3: BAD_QUATERNION: the norm ..."
std::string failure_text(const Wrenches& wrenches, std::size_t i) {
  const auto status = static_cast<BodyStatus>(wrenches.arrays().statuses[i]);
  const std::string pose = wrenches.single() ? "the pose" : "pose " + std::to_string(i);
  const std::string which = wrenches.body_ids.empty() ? pose : "body " + std::to_string(wrenches.body_ids[i]);
  return format_text("{}: {}: {}", which, to_string(status), explain(status));
}

void raise_for_status(py::handle self) {
  auto& wrenches = instance_of<Wrenches>(self);
  const std::span<std::int32_t> known = wrenches.arrays().statuses;
  const auto failed = std::ranges::find_if(known, [](std::int32_t status) { return status != 0; });
  if (failed == known.end()) return;
  std::string text = failure_text(wrenches, static_cast<std::size_t>(failed - known.begin()));
  const std::size_t others = wrenches_failed(wrenches) - 1;
  if (others > 0)
    text += " (and " + std::to_string(others) + " more of " + std::to_string(known.size()) + ")";
  throw StatusException(text);
}

std::string describe(py::handle self) {
  auto& wrenches = instance_of<Wrenches>(self);
  std::map<std::int32_t, std::size_t> counts;
  for (const std::int32_t status : wrenches.arrays().statuses) ++counts[status];
  std::string text = "<buoyancy.Wrenches of " + std::to_string(wrenches.size()) +
                     (wrenches.size() == 1 ? " pose" : " poses");
  const char* separator = ": ";
  for (const auto& [status, count] : counts) {
    text += separator;
    text += std::to_string(count) + " " + to_string(static_cast<BodyStatus>(status));
    separator = ", ";
  }
  return text + ">";
}

// "(K, 3), N: about the body's reference point."
template <typename Member>
std::string doc_of(const Field& field) {
  const py::tuple shape = py::dtype::of<Member>().attr("shape");
  std::string doc = shape.empty() ? "(K," : "(K";
  for (const py::handle size : shape) doc += ", " + std::string(py::str(size));
  doc += ")";
  if (!field.unit.empty()) (doc += ", ") += field.unit;
  if (!field.note.empty()) (doc += ": ") += field.note;
  return doc + ".";
}

// Adds a property for each field of the records but id and status. records_of: returns the records of a View,
// as a span, and the object that keeps them alive.
template <typename Record, typename View, typename RecordsOf>
void add_fields(py::class_<View>& type, RecordsOf records_of) {
  Record first;
  visit_named_fields(first, [&]<typename Member>(const Field& field, Member& member) {
    if (field.name == "body_id" || field.name == "status") return;
    const std::ptrdiff_t offset =
        reinterpret_cast<std::byte*>(&member) - reinterpret_cast<std::byte*>(&first);
    const auto get = [=](py::handle self) {
      const auto [records, owner] = records_of(self);
      const bool single = instance_of<View>(self).single;
      return record_field(records, single, owner, [offset](Record& record) -> Member& {
        return *reinterpret_cast<Member*>(reinterpret_cast<std::byte*>(&record) + offset);
      });
    };
    const std::string name(field.name == "submerged_volume" ? "volume" : field.name);
    type.def_property_readonly(name.c_str(), get, doc_of<Member>(field).c_str());
  });
}

void define_loads(py::module_& module) {
  py::class_<LoadsView> type(
      module, "Loads",
      R"(Buoyancy, drag and added mass apart: result.loads of a body with outputs = ["wrench", "loads"].

Arrays are views of the result, (K, ...), or (...) of one pose. Torques are about the body's reference
point, all in the world frame. The fields are those of body_loads_t (docs/messages.md).)");
  add_fields<BodyLoads>(type, [](py::handle self) {
    auto& view = instance_of<LoadsView>(self);
    return std::pair<std::span<BodyLoads>, py::handle>(view.loads, view.result);
  });
}

void define_hydrostatics(py::module_& module) {
  py::class_<HydrostaticsTable> type(module, "Hydrostatics",
                                     R"(Waterplane, metacentres and stiffness of each pose, in water at rest.

Arrays have the shape (K, ...), or (...) of one pose. Points are relative to the position, in world axes.
A value that does not exist is NaN, such as the metacentre of a dry body. The fields are those of
body_hydrostatics_t (docs/messages.md).)");
  type.def_property_readonly(
      "status",
      [](py::handle self) -> py::object {
        auto& table = instance_of<HydrostaticsTable>(self);
        if (table.single) return status_object(table.rows.front().status);
        return record_field(std::span(table.rows), false, self,
                            [](BodyHydrostatics& row) -> BodyStatus& { return row.status; });
      },
      "(K,) int32: see Status; rows that are not OK hold zeros.");
  type.def("__len__", [](py::handle self) { return instance_of<HydrostaticsTable>(self).rows.size(); });
  add_fields<BodyHydrostatics>(type, [](py::handle self) {
    return std::pair<std::span<BodyHydrostatics>, py::handle>(instance_of<HydrostaticsTable>(self).rows,
                                                              self);
  });
}

}  // namespace

Wrenches::Wrenches(std::size_t poses, bool single)
    : single_(single),
      memory_(std::make_unique_for_overwrite<std::byte[]>(
          poses * (kDoublesPerPose * sizeof(double) + sizeof(std::int32_t)) + 1)) {
  auto* next = reinterpret_cast<double*>(memory_.get());
  const auto take = [&](std::size_t width) {
    return std::span(std::exchange(next, next + width * poses), width * poses);
  };
  arrays_.forces = take(3);
  arrays_.torques = take(3);
  arrays_.centers_of_buoyancy = take(3);
  arrays_.volumes = take(1);
  arrays_.force_error_bounds = take(1);
  arrays_.torque_error_bounds = take(1);
  arrays_.statuses = {reinterpret_cast<std::int32_t*>(next), poses};
}

void Wrenches::set(std::size_t i, const BodyWrench& wrench) {
  const auto copy = [i](const std::array<double, 3>& from, std::span<double> to) {
    std::ranges::copy(from, to.begin() + static_cast<std::ptrdiff_t>(3 * i));
  };
  arrays_.statuses[i] = static_cast<std::int32_t>(wrench.status);
  copy(wrench.force, arrays_.forces);
  copy(wrench.torque, arrays_.torques);
  copy(wrench.center_of_buoyancy, arrays_.centers_of_buoyancy);
  arrays_.volumes[i] = wrench.submerged_volume;
  arrays_.force_error_bounds[i] = wrench.force_error_bound;
  arrays_.torque_error_bounds[i] = wrench.torque_error_bound;
}

py::object wrenches_for(PyObject* out, std::size_t poses, bool single) {
  if (!is_given(out)) return py::cast(std::make_unique<Wrenches>(poses, single));
  const auto& given = instance_of<Wrenches>(out);
  if (given.size() != poses || given.single() != single) {
    const auto describe_shape = [](std::size_t count, bool one) {
      return one ? std::string("one pose, (3,)") : "(" + std::to_string(count) + ", 3)";
    };
    throw py::value_error("out is a result for " + describe_shape(given.size(), given.single()) +
                          ", but the poses are " + describe_shape(poses, single) +
                          "; expected a result of a call with the same shapes");
  }
  return py::reinterpret_borrow<py::object>(out);
}

unsigned to_threads(PyObject* threads) {
  if (threads == nullptr) return 0;
  const long count = PyLong_Check(threads) && !PyBool_Check(threads) ? PyLong_AsLong(threads) : -1;
  constexpr long kMaxThreads = 1024;
  if (count >= 0 && count <= kMaxThreads) return static_cast<unsigned>(count);
  PyErr_Clear();
  throw py::value_error("threads is " + std::string(py::repr(threads)) +
                        "; expected a whole number from 0 (one per processor) to 1024");
}

py::object evaluate(const Body& body, const QueryWater& water, const PoseInput& poses, bool with_loads,
                    unsigned threads, PyObject* out) {
  py::object result = wrenches_for(out, poses.size(), poses.single());
  auto& wrenches = instance_of<Wrenches>(result);
  wrenches.has_loads = with_loads;
  // The loads of poses that cannot be evaluated remain zeros.
  if (with_loads || !wrenches.loads.empty())
    wrenches.loads.assign(with_loads ? poses.size() : 0, BodyLoads{});
  const PoseArrays of_poses = poses.arrays();
  const WrenchArrays arrays = wrenches.arrays();
  const std::span<BodyLoads> loads = wrenches.loads;
  run_in_slices(poses.size(), [&](std::size_t begin, std::size_t end) {
    evaluate_poses(body, water, of_poses.part(begin, end), arrays.part(begin, end),
                   loads.empty() ? loads : loads.subspan(begin, end - begin), threads);
  });
  return result;
}

py::object evaluate_hydrostatics(const Body& body, const Water& water, const PoseInput& poses,
                                 unsigned threads) {
  auto table = std::make_unique<HydrostaticsTable>();
  table->rows.resize(poses.size());
  table->single = poses.single();
  const PoseArrays of_poses = poses.arrays();
  const std::span<BodyHydrostatics> rows = table->rows;
  run_in_slices(poses.size(), [&](std::size_t begin, std::size_t end) {
    buoyancy::evaluate_hydrostatics(body, water, of_poses.part(begin, end), rows.subspan(begin, end - begin),
                                    threads);
  });
  return py::cast(std::move(table));
}

void define_wrenches(py::module_& module) {
  py::class_<Wrenches> type(module, "Wrenches",
                            R"(The force and torque on a body, of each pose of a query.

Arrays are views of this object's memory: of K poses (K, ...), of one pose (3,) and numbers. They keep it
alive, and change when it is passed as out= again. Poses with a status other than OK have zeros.)");
  const auto add = [&type](const char* name, std::span<double> WrenchArrays::*part, py::ssize_t width,
                           const char* doc) {
    type.def_property_readonly(
        name, [=](py::handle self) { return part_of(self, part, width); }, doc);
  };
  add("force", &WrenchArrays::forces, 3, "(K, 3), N, world frame.");
  add("torque", &WrenchArrays::torques, 3,
      "(K, 3), N m, world frame, about the body's reference point (a mesh: its origin).");
  add("volume", &WrenchArrays::volumes, 1, "(K,), m^3: the displaced water.");
  add("center_of_buoyancy", &WrenchArrays::centers_of_buoyancy, 3,
      "(K, 3), m, world axes, relative to the position.");
  add("force_error_bound", &WrenchArrays::force_error_bounds, 1,
      "(K,), N: the error of the force is no larger.");
  add("torque_error_bound", &WrenchArrays::torque_error_bounds, 1,
      "(K,), N m: the error of the torque is no larger.");
  type.def_property_readonly("status", &statuses, "(K,) int32: 0 for OK, see Status; of one pose a Status.");
  add_property(
      type, "ok", [](const Wrenches& wrenches) { return wrenches_failed(wrenches) == 0; },
      "bool: is every status OK?");
  type.def_property_readonly(
      "loads",
      [](const py::object& self) -> py::object {
        auto& wrenches = instance_of<Wrenches>(self);
        if (!wrenches.has_loads) return py::none();
        return py::cast(std::make_unique<LoadsView>(LoadsView{self, wrenches.loads, wrenches.single()}));
      },
      "Loads of a body with this output, else None.");
  type.def_property_readonly(
      "body_ids",
      [](py::handle self) -> py::object {
        auto& wrenches = instance_of<Wrenches>(self);
        if (!wrenches.utime) return py::none();
        const auto count = static_cast<py::ssize_t>(wrenches.body_ids.size());
        return py::array_t<std::int32_t>(count, wrenches.body_ids.data(), self);
      },
      "(K,) int32 of a response from the service, else None.");
  add_property(type, "utime", &Wrenches::utime,
               "int, microseconds, of the request that a response from the service belongs to, else None.");
  type.def("raise_for_status", &raise_for_status,
           R"(raise_for_status($self)
--

Raise a StatusError that names the first pose that is not OK, and why.)");
  type.def("__len__", [](py::handle self) { return instance_of<Wrenches>(self).size(); });
  type.def("__repr__", &describe);
  define_loads(module);
  define_hydrostatics(module);
}

}  // namespace buoyancy::python
