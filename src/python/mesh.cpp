// buoyancy.Mesh: a mesh, and queries of it.

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <pybind11/stl.h>

#include "base/format.h"
#include "python/call_arguments.h"
#include "python/module.h"
#include "python/number_array.h"
#include "python/pose_input.h"
#include "python/query_water.h"
#include "python/result_array.h"
#include "python/wrenches.h"
#include "query/query_mesh.h"
#include "scene/up_axis.h"

namespace buoyancy::python {
namespace {

// A mesh as Python holds it.
struct MeshObject {
  std::shared_ptr<const QueryMesh> mesh;
};

OpenPolicy to_open_policy(const std::string& name) {
  for (const auto& [known, policy] : kOpenPolicyNames) {
    if (name == known) return policy;
  }
  throw py::value_error("open = \"" + name + "\"; expected \"refuse\" or \"dry_boundary\"");
}

Method to_method(PyObject* object) {
  if (object == nullptr) return Method::kHierarchical;
  if (!PyUnicode_Check(object)) {
    throw py::type_error(std::string("method is a ") + Py_TYPE(object)->tp_name +
                         "; expected text, such as \"exact\"");
  }
  const auto name = py::reinterpret_borrow<py::object>(object).cast<std::string>();
  if (const std::optional<Method> method = method_from_name(name)) return *method;
  std::string names;
  for (const Method method : kAllMethods) {
    if (!names.empty()) names += ", ";
    names += to_string(method);
  }
  throw py::value_error("method = \"" + name + "\"; expected one of " + names);
}

// A mesh that is refused has a report.
std::shared_ptr<const QueryMesh> mesh_or_throw(Expected<std::shared_ptr<const QueryMesh>> mesh,
                                               const MeshReport& refused) {
  if (!mesh) throw InputException(mesh.error(), refused.name.empty() ? "" : to_text(refused));
  return *std::move(mesh);
}

std::shared_ptr<const QueryMesh> load(const std::string& path, const QueryMeshOptions& options) {
  const WithoutGil released;
  MeshReport refused;
  return mesh_or_throw(QueryMesh::load(path, options, &refused), refused);
}

// The index of a word among those that an argument may have.
template <std::size_t kCount>
std::size_t to_choice(const std::string& word, const std::array<std::string_view, kCount>& words,
                      const char* argument) {
  std::string expected;
  for (std::size_t i = 0; i < kCount; ++i) {
    if (word == words[i]) return i;
    expected += (i == 0 ? "\"" : "\", \"") + std::string(words[i]);
  }
  throw py::value_error(std::string(argument) + " = \"" + word + "\"; expected one of " + expected + "\"");
}

double to_positive(double number, const char* argument) {
  if (std::isfinite(number) && number > 0.0) return number;
  throw InputException({"Mesh()", argument + (" = " + format_shortest(number)), "a finite number above 0", "",
                        "Leave it out if nothing is to be done"});
}

MeshRepair to_repair(const std::string& repair, const std::optional<double>& close_holes,
                     const std::optional<std::string>& mirror, const std::optional<double>& freeboard) {
  MeshRepair result;
  if (to_choice(repair, kRepairPolicyNames, "repair") == 1) result.policy = RepairPolicy::kNone;
  if (mirror) result.mirror = static_cast<Axis>(to_choice(*mirror, kAxisNames, "mirror"));
  if (close_holes) {
    result.closing.holes = true;
    result.closing.max_change = to_positive(*close_holes, "close_holes");
  }
  if (freeboard) result.closing.freeboard = to_positive(*freeboard, "freeboard");
  return result;
}

// scale: a number above 0, or factors of x, y and z. up: None, or the name of an axis.
MeshPlacement to_placement(const py::object& scale, const py::object& up) {
  const NumberArray<double> factors(scale.ptr(), "scale");
  MeshPlacement placement;
  if (factors.dimensions() == 0) {
    const double factor = factors.values()[0];
    if (!(std::isfinite(factor) && factor > 0.0)) {
      throw InputException({"Mesh()", "scale = " + format_shortest(factor), "a finite number above 0", "",
                            factor < 0.0 ? "Mirror with a factor for each axis, such as scale=(-1, 1, 1)"
                                         : "For millimetres pass 0.001, for metres leave the scale out"});
    }
    placement.scale.setConstant(factor);
  } else if (factors.has_shape({3})) {
    placement.scale = {factors.values()[0], factors.values()[1], factors.values()[2]};
  } else {
    throw py::value_error("scale has shape " + shape_text(factors.shape()) + "; expected a number or (3,)");
  }
  if (up.is_none()) return placement;
  if (!py::isinstance<py::str>(up)) {
    throw py::type_error(std::string("up is a ") + Py_TYPE(up.ptr())->tp_name +
                         "; expected text, such as \"y\" or \"-x\"");
  }
  const auto name = up.cast<std::string>();
  const std::optional<Vec3> axis = axis_from_name(name);
  if (!axis) {
    throw py::value_error("up = \"" + name + "\"; expected one of x, y, z, -x, -y, -z, an axis of the mesh");
  }
  placement.orientation_B = orientation_with_up(*axis, placement.scale);
  return placement;
}

std::unique_ptr<MeshObject> make_mesh(const py::object& source, const py::object& faces,
                                      const py::object& scale, const std::string& open,
                                      bool count_intersections, const py::object& up,
                                      const std::string& repair, const std::optional<double>& close_holes,
                                      const std::optional<std::string>& mirror,
                                      const std::optional<double>& freeboard) {
  QueryMeshOptions options;
  options.repair = to_repair(repair, close_holes, mirror, freeboard);
  options.placement = to_placement(scale, up);
  options.open = to_open_policy(open);
  options.count_intersecting_pairs = count_intersections;
  if (py::isinstance<py::str>(source) || py::hasattr(source, "__fspath__")) {
    if (!faces.is_none()) {
      throw py::type_error("Mesh() got a path and faces; expected a path, or vertices and faces");
    }
    const std::string path = to_path(source);
    auto mesh = std::make_unique<MeshObject>(MeshObject{load(path, options)});
    if (std::optional<Warning> warning = up_axis_warning(mesh->mesh->report(), options.placement.scale,
                                                         Vec3::UnitZ(), UpRemedy::kArgument)) {
      warning->subject = path;
      warn(*warning);
    }
    return mesh;
  }
  if (faces.is_none()) {
    throw py::type_error(std::string("Mesh() got a ") + Py_TYPE(source.ptr())->tp_name +
                         " and no faces; expected a path, or vertices (N, 3) and faces (M, 3)");
  }
  const NumberArray<double> vertices(source.ptr(), "vertices");
  const NumberArray<std::int64_t> triangles(faces.ptr(), "faces");
  const auto check = [](const auto& array, const char* name, const char* rows) {
    if (array.dimensions() == 2 && array.extent(1) == 3) return;
    throw py::value_error(std::string(name) + " has shape " + shape_text(array.shape()) + "; expected (" +
                          rows + ", 3)");
  };
  check(vertices, "vertices", "N");
  check(triangles, "faces", "M");
  // Other threads may change the caller's arrays, but faces are checked and then used.
  const std::vector<double> vertex_copy(vertices.values().begin(), vertices.values().end());
  const std::vector<std::int64_t> face_copy(triangles.values().begin(), triangles.values().end());
  const WithoutGil released;
  MeshReport refused;
  return std::make_unique<MeshObject>(MeshObject{mesh_or_throw(
      QueryMesh::make(vertex_copy, face_copy, "Mesh(vertices, faces)", options, &refused), refused)});
}

std::shared_ptr<const Body> body_of(const QueryMesh& mesh, Method method, double tolerance, bool in_waves) {
  const WithoutGil released;  // the first query by a method prepares it
  return value_or_throw(mesh.body(method, tolerance, in_waves));
}

PyObject* query(PyObject* self, PyObject* const* arguments, Py_ssize_t count, PyObject* keywords) {
  static const Signature<12> signature("query", 2, 2,
                                       {"position", "quaternion", "level", "density", "gravity", "up",
                                        "method", "tolerance", "sea", "time", "threads", "out"});
  return guarded([&]() -> py::object {
    const auto [position, quaternion, level, density, gravity, up, method, tolerance, sea, time, threads,
                out] = signature.parse(arguments, count, keywords);
    const std::shared_ptr<const QueryMesh> mesh = instance_of<MeshObject>(self).mesh;
    const QueryWater water = to_query_water({level, density, gravity, up}, sea);
    const PoseInput poses({.position = position, .quaternion = quaternion, .time = time});
    const double bound = tolerance == nullptr ? 0.0 : to_double(tolerance, "tolerance");
    const std::shared_ptr<const Body> body = body_of(*mesh, to_method(method), bound, water.waves != nullptr);
    return evaluate(*body, water, poses, false, to_threads(threads), out);
  });
}

PyObject* hydrostatics(PyObject* self, PyObject* const* arguments, Py_ssize_t count, PyObject* keywords) {
  static const Signature<8> signature(
      "hydrostatics", 2, 2,
      {"position", "quaternion", "level", "density", "gravity", "up", "center_of_mass", "threads"});
  return guarded([&]() -> py::object {
    const auto [position, quaternion, level, density, gravity, up, center_of_mass, threads] =
        signature.parse(arguments, count, keywords);
    const std::shared_ptr<const QueryMesh> mesh = instance_of<MeshObject>(self).mesh;
    const Water water = to_water({level, density, gravity, up});
    const PoseInput poses({.position = position, .quaternion = quaternion});
    const std::shared_ptr<const Body> shared = body_of(*mesh, Method::kHierarchical, 0.0, false);
    if (!is_given(center_of_mass)) return evaluate_hydrostatics(*shared, water, poses, to_threads(threads));
    const NumberArray<double> center(center_of_mass, "center_of_mass");
    if (!center.has_shape({3})) {
      throw py::value_error("center_of_mass has shape " + shape_text(center.shape()) + "; expected (3,)");
    }
    Body body = *shared;
    body.center_of_mass_B = Vec3(center.values()[0], center.values()[1], center.values()[2]);
    if (!body.center_of_mass_B->allFinite()) {
      throw InputException(
          {"center_of_mass", format_vector(*body.center_of_mass_B), "three finite numbers (m)", "", ""});
    }
    return evaluate_hydrostatics(body, water, poses, to_threads(threads));
  });
}

constexpr const char* kQueryDoc =
    "query($self, position, quaternion, *, level=0.0, density=1025.0, gravity=9.80665, up=(0, 0, 1),\n"
    "      method='hierarchical', tolerance=0.0, sea=None, time=0.0, threads=0, out=None)\n--\n\n"
    "The wrench of the water on the mesh, at one pose or at K poses: a Wrenches.\n\n"
    "position: (3,) or (K, 3), metres, of the mesh's origin in the world. quaternion: (4,) or (K, 4), (w, x, "
    "y, z),\n"
    "rotates the mesh's axes to the world's; normalised if its norm is within 1e-3 of 1. One row is repeated "
    "for\n"
    "K rows of the other. float64 in C order is read in place, other numbers are converted.\n\n"
    "level: m, the surface is where up . x = level. density: kg/m^3. gravity: m/s^2. up: (3,), any length.\n"
    "method: 'hierarchical', 'exact', 'exact_surface', 'fast', 'fast_surface' or 'improved'. tolerance: 0 to "
    "1, relative\n"
    "to the weight of the full displacement; 'hierarchical' only. sea: a Sea, whose water is used; level, "
    "density,\n"
    "gravity and up are then left out. time: seconds, a number or (K,), for waves. threads: 0 for one per "
    "processor; a\n"
    "single pose stays on the caller's. out: the result of an earlier call with the same shapes, filled in "
    "place.\n\n"
    "A pose that is not finite, or a quaternion that is not unit, raises nothing: its status says so, and "
    "its\n"
    "numbers are 0. See Wrenches.ok and Wrenches.raise_for_status().\n\n"
    "Raises TypeError or ValueError for arguments of other types or shapes, and InputError (a ValueError "
    "too) for\n"
    "numbers out of range, and for methods and tolerances that waves exclude.";

constexpr const char* kHydrostaticsDoc =
    "hydrostatics($self, position, quaternion, *, level=0.0, density=1025.0, gravity=9.80665, up=(0, 0, 1),\n"
    "             center_of_mass=None, threads=0)\n--\n\n"
    "Waterplane, metacentres and stiffness at one pose or at K poses, in water at rest: a Hydrostatics.\n\n"
    "center_of_mass: (3,), metres, in the mesh's frame; metacentric_heights are NaN without it. Other "
    "arguments: see\n"
    "query().";

PyMethodDef query_method{"query", reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(&query)),
                         METH_FASTCALL | METH_KEYWORDS, kQueryDoc};
PyMethodDef hydrostatics_method{"hydrostatics",
                                reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(&hydrostatics)),
                                METH_FASTCALL | METH_KEYWORDS, kHydrostaticsDoc};

constexpr const char* kMeshDoc =
    "A triangle mesh, validated and prepared for queries.\n\n"
    "Mesh(path, *, scale=1.0, open='refuse', up=None) reads a file: OBJ, STL, PLY, OFF, DAE, glTF/GLB, FBX, "
    "3DS, "
    "WAMIT .gdf, Nemoh .dat.\n"
    "Coordinates are those of the file, as scale and up place them; if the file's up axis is then not z, a "
    "UserWarning says so.\n"
    "Mesh(vertices, faces, *, scale=1.0, open='refuse', up=None) takes arrays: vertices (N, 3) in metres, "
    "and faces "
    "(M, 3), integers\n"
    "that count vertices from 0, anticlockwise seen from outside.\n\n"
    "scale: factor on the coordinates, above 0, or three for x, y and z, of which negative ones mirror. up: "
    "'x', 'y', 'z',\n"
    "'-x', '-y' or '-z' turns the mesh so that this axis of the file or the arrays becomes z, whatever the "
    "scale; the\n"
    "mesh's frame is then the turned one. open: 'dry_boundary' accepts an open mesh; poses that put "
    "its boundary\n"
    "under water get the status OPEN_EDGE_WET. count_intersections: see intersecting_pairs; takes time.\n\n"
    "repair: 'none' leaves out the automatic repair. close_holes: above 0; closes all holes if hemispheres "
    "over them hold\n"
    "at most this share of the volume. mirror: 'x', 'y' or 'z' first adds the mirror image in this plane of "
    "the file or\n"
    "the arrays, for half a body. freeboard: m, above 0; raises rims that face up (z) by this height and "
    "closes them.\n\n"
    "The attributes are the report of the validation; report is its text. One mesh may be queried by "
    "several\n"
    "threads at once.\n\n"
    "Raises InputError if the file or the mesh cannot be used, for example an open one; its report is then "
    "the\n"
    "exception's attribute of that name. TypeError and ValueError for arguments of other types or shapes.";

const MeshReport& report_of(py::handle self) {
  return instance_of<MeshObject>(self).mesh->report();
}

template <typename Value>
void add_report(py::class_<MeshObject>& type, const char* name, Value MeshReport::*member, const char* doc) {
  type.def_property_readonly(
      name,
      [member](py::handle self) {
        if constexpr (std::is_same_v<Value, std::string>) {
          return to_str(report_of(self).*member);
        } else {
          return report_of(self).*member;
        }
      },
      doc);
}

py::object vector(const Vec3& value) {
  return make_owned_array({3}, {value.x(), value.y(), value.z()});
}

}  // namespace

void define_mesh(py::module_& module) {
  py::class_<MeshObject> type(module, "Mesh", kMeshDoc);
  type.def(py::init(&make_mesh), py::arg("source"), py::arg("faces") = py::none(), py::kw_only(),
           py::arg("scale") = 1.0, py::arg("open") = "refuse", py::arg("count_intersections") = false,
           py::arg("up") = py::none(), py::arg("repair") = "automatic", py::arg("close_holes") = py::none(),
           py::arg("mirror") = py::none(), py::arg("freeboard") = py::none());
  add_method(type, query_method);
  add_method(type, hydrostatics_method);
  add_report(type, "name", &MeshReport::name, "str: the file, or 'Mesh(vertices, faces)'.");
  add_report(type, "volume", &MeshReport::volume, "float, m^3: enclosed; of no meaning for an open mesh.");
  add_report(type, "area", &MeshReport::area, "float, m^2.");
  add_report(type, "triangles", &MeshReport::triangles, "int.");
  add_report(type, "boundary_edges", &MeshReport::boundary_edges,
             "int: edges of one face; 0 for a closed mesh.");
  add_report(type, "non_manifold_edges", &MeshReport::non_manifold_edges,
             "int: edges of three or more faces.");
  add_report(type, "misoriented_edges", &MeshReport::misoriented_edges,
             "int: edges between faces of opposite winding.");
  add_report(type, "degenerate_faces", &MeshReport::degenerate_faces, "int: faces without area, kept.");
  add_report(type, "dropped_faces", &MeshReport::dropped_faces, "int: faces that use a vertex twice.");
  add_report(type, "duplicate_faces", &MeshReport::duplicate_faces, "int.");
  add_report(type, "intersecting_pairs", &MeshReport::intersecting_pairs,
             "int, or None without count_intersections=True: pairs of faces that intersect.");
  add_report(type, "flipped", &MeshReport::flipped, "bool: was the mesh inside out, and turned?");
  type.def_property_readonly(
      "vertices", [](py::handle self) { return report_of(self).vertices_welded; }, "int: after welding.");
  type.def_property_readonly(
      "closed", [](py::handle self) { return report_of(self).closed(); }, "bool: has the mesh no boundary?");
  type.def_property_readonly(
      "components", [](py::handle self) { return report_of(self).components.size(); },
      "int: connected parts.");
  type.def_property_readonly(
      "format", [](py::handle self) { return report_of(self).source.format; }, "str: of the file.");
  type.def_property_readonly(
      "report", [](py::handle self) { return to_str(to_text(report_of(self))); },
      "str: the whole report, several lines.");
  type.def_property_readonly(
      "bounding_box",
      [](py::handle self) {
        const BoundingBox& box = report_of(self).box;
        return py::make_tuple(vector(box.min_B), vector(box.max_B));
      },
      "Two (3,), m: the least and the greatest coordinates, in the mesh's frame.");
  type.def_property_readonly(
      "center_of_mass",
      [](py::handle self) {
        return vector(instance_of<MeshObject>(self).mesh->mass_properties().centroid_B);
      },
      "(3,), m, in the mesh's frame: of a solid of uniform density.");
  type.def_property_readonly(
      "inertia",
      [](py::handle self) {
        const Mat3& inertia = instance_of<MeshObject>(self).mesh->mass_properties().inertia_B;
        return make_owned_array({3, 3}, std::vector<double>(inertia.data(), inertia.data() + 9));
      },
      "(3, 3), m^5, about center_of_mass, in the mesh's axes: times the density of a solid it is kg m^2.");
  type.def("__repr__", [](py::handle self) {
    const MeshReport& report = report_of(self);
    return to_str("<buoyancy.Mesh " + report.name + ": " +
                  pluralize(report.triangles, "triangle", "triangles") + ", " +
                  format_number(report.volume, 6) + " m^3>");
  });
}

}  // namespace buoyancy::python
