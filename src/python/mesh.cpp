// buoyancy.Mesh: a mesh, and queries of it.

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "base/format.h"
#include "python/arrays.h"
#include "python/call_arguments.h"
#include "python/module.h"
#include "python/pose_input.h"
#include "python/query_water.h"
#include "python/wrenches.h"
#include "query/query_mesh.h"
#include "scene/up_axis.h"

namespace buoyancy::python {
namespace {

// A mesh as Python holds it.
struct MeshObject {
  std::shared_ptr<const QueryMesh> mesh;
};

// example: a value of the argument, for the error.
std::string to_word(py::handle object, const char* argument, const char* example) {
  if (py::isinstance<py::str>(object)) return object.cast<std::string>();
  throw py::type_error(std::string(argument) + " is a " + Py_TYPE(object.ptr())->tp_name +
                       "; expected text, such as " + example);
}

Method to_method(PyObject* object) {
  if (object == nullptr) return Method::kHierarchical;
  const std::string name = to_word(object, "method", "\"exact\"");
  if (const std::optional<Method> method = method_from_name(name)) return *method;
  std::string names;
  for (const Method method : kAllMethods) {
    if (!names.empty()) names += ", ";
    names += to_string(method);
  }
  throw py::value_error("method = \"" + name + "\"; expected one of " + names);
}

// Calls make(&report) without the interpreter's lock and returns its mesh. Throws an InputException, with the
// report of a mesh that is refused.
template <typename Make>
std::unique_ptr<MeshObject> prepare(const Make& make) {
  const WithoutGil released;
  MeshReport refused;
  Expected<std::shared_ptr<const QueryMesh>> mesh = make(&refused);
  if (!mesh) throw InputException(mesh.error(), refused.name.empty() ? "" : to_text(refused));
  return std::make_unique<MeshObject>(MeshObject{*std::move(mesh)});
}

// Returns the index of a word among those that an argument may have.
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

double to_positive(double number, const char* argument,
                   const char* hint = "Leave it out if nothing is to be done") {
  if (std::isfinite(number) && number > 0.0) return number;
  throw InputException(
      {"Mesh()", argument + (" = " + format_shortest(number)), "a finite number above 0", "", hint});
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
  const Numbers<double> factors = to_numbers<double>(scale.ptr(), "scale");
  MeshPlacement placement;
  if (factors.ndim() == 0) {
    const double factor = *factors.data();
    const char* const hint = factor < 0.0 ? "Mirror with a factor for each axis, such as scale=(-1, 1, 1)"
                                          : "For millimetres pass 0.001, for metres leave the scale out";
    placement.scale.setConstant(to_positive(factor, "scale", hint));
  } else {
    placement.scale = to_vector(scale.ptr(), "scale", "a number or (3,)");
  }
  if (up.is_none()) return placement;
  const std::string name = to_word(up, "up", "\"y\" or \"-x\"");
  const std::optional<Vec3> axis = axis_from_name(name);
  if (!axis) {
    throw py::value_error("up = \"" + name + "\"; expected one of x, y, z, -x, -y, -z, an axis of the mesh");
  }
  placement.orientation_B = orientation_with_up(*axis, placement.scale);
  return placement;
}

// Returns the numbers of an array of rows of three as a copy: another thread might change the caller's array
// between the check of the faces and their use.
template <typename Number>
std::vector<Number> rows_of(const py::object& object, const char* name, const char* expected) {
  const Numbers<Number> array = to_numbers<Number>(object.ptr(), name);
  if (array.ndim() != 2 || array.shape(1) != 3) {
    throw py::value_error(std::string(name) + " has shape " + shape_text(array) + "; expected " + expected);
  }
  return {array.data(), array.data() + array.size()};
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
  constexpr std::array kOpen{kOpenPolicyNames[0].first, kOpenPolicyNames[1].first};
  options.open = kOpenPolicyNames[to_choice(open, kOpen, "open")].second;
  options.count_intersecting_pairs = count_intersections;
  if (py::isinstance<py::str>(source) || py::hasattr(source, "__fspath__")) {
    if (!faces.is_none()) {
      throw py::type_error("Mesh() got a path and faces; expected a path, or vertices and faces");
    }
    const std::string path = to_path(source);
    auto mesh = prepare([&](MeshReport* refused) { return QueryMesh::load(path, options, refused); });
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
  const auto vertices = rows_of<double>(source, "vertices", "(N, 3)");
  const auto triangles = rows_of<std::int64_t>(faces, "faces", "(M, 3)");
  return prepare([&](MeshReport* refused) {
    return QueryMesh::make(vertices, triangles, "Mesh(vertices, faces)", options, refused);
  });
}

std::shared_ptr<const Body> body_of(const QueryMesh& mesh, Method method, double tolerance, bool in_waves) {
  const WithoutGil released;  // the first query by a method prepares it
  return value_or_throw(mesh.body(method, tolerance, in_waves));
}

constexpr Parameters<12> kQueryParameters{"position", "quaternion", "level", "density", "gravity", "up",
                                          "method",   "tolerance",  "sea",   "time",    "threads", "out"};

py::object query(PyObject* self, const Arguments<12>& arguments) {
  const auto& [position, quaternion, level, density, gravity, up, method, tolerance, sea, time, threads,
               out] = arguments;
  const std::shared_ptr<const QueryMesh> mesh = instance_of<MeshObject>(self).mesh;
  const QueryWater water = to_query_water({level, density, gravity, up}, sea);
  const PoseInput poses({.position = position, .quaternion = quaternion, .time = time});
  const double bound = tolerance == nullptr ? 0.0 : to_number<double>(tolerance, "tolerance");
  const std::shared_ptr<const Body> body = body_of(*mesh, to_method(method), bound, water.waves != nullptr);
  return evaluate(*body, water, poses, false, to_threads(threads), out);
}

constexpr Parameters<8> kHydrostaticsParameters{"position", "quaternion", "level",          "density",
                                                "gravity",  "up",         "center_of_mass", "threads"};

py::object hydrostatics(PyObject* self, const Arguments<8>& arguments) {
  const auto& [position, quaternion, level, density, gravity, up, center_of_mass, threads] = arguments;
  const std::shared_ptr<const QueryMesh> mesh = instance_of<MeshObject>(self).mesh;
  const Water water = to_water({level, density, gravity, up});
  const PoseInput poses({.position = position, .quaternion = quaternion});
  const std::shared_ptr<const Body> shared = body_of(*mesh, Method::kHierarchical, 0.0, false);
  if (!is_given(center_of_mass)) return evaluate_hydrostatics(*shared, water, poses, to_threads(threads));
  Body body = *shared;
  body.center_of_mass_B = to_vector(center_of_mass, "center_of_mass", "(3,)");
  if (!body.center_of_mass_B->allFinite()) {
    throw InputException(
        {"center_of_mass", format_vector(*body.center_of_mass_B), "three finite numbers (m)", "", ""});
  }
  return evaluate_hydrostatics(body, water, poses, to_threads(threads));
}

constexpr const char* kQueryDoc =
    R"(query($self, position, quaternion, *, level=0.0, density=1025.0, gravity=9.80665, up=(0, 0, 1),
      method='hierarchical', tolerance=0.0, sea=None, time=0.0, threads=0, out=None)
--

The wrench of the water on the mesh, at one pose or at K poses: a Wrenches.

position: (3,) or (K, 3), metres, of the mesh's origin in the world. quaternion: (4,) or (K, 4), (w, x, y,
z), rotates the mesh's axes to the world's; normalised if its norm is within 1e-3 of 1. One row is
repeated for K rows of the other. float64 in C order is read in place, other numbers are converted.

level: m, the surface is where up . x = level. density: kg/m^3. gravity: m/s^2. up: (3,), any length.
method: 'hierarchical', 'exact', 'exact_surface', 'fast', 'fast_surface' or 'improved'. tolerance: 0 to 1,
relative to the weight of the full displacement; 'hierarchical' only. sea: a Sea, whose water is used;
level, density, gravity and up are then left out. time: seconds, a number or (K,), for waves. threads: 0
for one per processor; a single pose stays on the caller's. out: the result of an earlier call with the
same shapes, filled in place.

A pose that is not finite, or a quaternion that is not unit, raises nothing: its status says so, and its
numbers are 0. See Wrenches.ok and Wrenches.raise_for_status().

Raises TypeError or ValueError for arguments of other types or shapes, and InputError (a ValueError too)
for numbers out of range, and for methods and tolerances that waves exclude.)";

constexpr const char* kHydrostaticsDoc =
    R"(hydrostatics($self, position, quaternion, *, level=0.0, density=1025.0, gravity=9.80665, up=(0, 0, 1),
             center_of_mass=None, threads=0)
--

Waterplane, metacentres and stiffness at one pose or at K poses, in water at rest: a Hydrostatics.

center_of_mass: (3,), metres, in the mesh's frame; metacentric_heights are NaN without it. Other
arguments: see query().)";

constexpr const char* kMeshDoc =
    R"(A triangle mesh, validated and prepared for queries.

Mesh(path, *, scale=1.0, open='refuse', up=None) reads a file: OBJ, STL, PLY, OFF, DAE, glTF/GLB, FBX,
3DS, WAMIT .gdf, Nemoh .dat. Coordinates are those of the file, as scale and up place them; if the file's
up axis is then not z, a UserWarning says so.
Mesh(vertices, faces, *, scale=1.0, open='refuse', up=None) takes arrays: vertices (N, 3) in metres, and
faces (M, 3), integers that count vertices from 0, anticlockwise seen from outside.

scale: factor on the coordinates, above 0, or three for x, y and z, of which negative ones mirror. up:
'x', 'y', 'z', '-x', '-y' or '-z' turns the mesh so that this axis of the file or the arrays becomes z,
whatever the scale; the mesh's frame is then the turned one. open: 'dry_boundary' accepts an open mesh;
poses that put its boundary under water get the status OPEN_EDGE_WET. count_intersections: see
intersecting_pairs; takes time.

repair: 'none' leaves out the automatic repair. close_holes: above 0; closes all holes if hemispheres over
them hold at most this share of the volume. mirror: 'x', 'y' or 'z' first adds the mirror image in this
plane of the file or the arrays, for half a body. freeboard: m, above 0; raises rims that face up (z) by
this height and closes them.

The attributes are the report of the validation; report is its text. One mesh may be queried by several
threads at once.

Raises InputError if the file or the mesh cannot be used, for example an open one; its report is then the
exception's attribute of that name. TypeError and ValueError for arguments of other types or shapes.)";

const MeshReport& report_of(const MeshObject& object) {
  return object.mesh->report();
}

}  // namespace

void define_mesh(py::module_& module) {
  py::class_<MeshObject> type(module, "Mesh", kMeshDoc);
  type.def(py::init(&make_mesh), py::arg("source"), py::arg("faces") = py::none(), py::kw_only(),
           py::arg("scale") = 1.0, py::arg("open") = "refuse", py::arg("count_intersections") = false,
           py::arg("up") = py::none(), py::arg("repair") = "automatic", py::arg("close_holes") = py::none(),
           py::arg("mirror") = py::none(), py::arg("freeboard") = py::none());
  add_method<&query>(type, "query", 2, kQueryParameters, kQueryDoc);
  add_method<&hydrostatics>(type, "hydrostatics", 2, kHydrostaticsParameters, kHydrostaticsDoc);
  const auto add = [&type](const char* name, auto value, const char* doc) {
    add_property(
        type, name, [value](const MeshObject& object) { return std::invoke(value, report_of(object)); }, doc);
  };
  using Report = MeshReport;
  add(
      "name", [](const Report& report) { return to_str(report.name); },
      "str: the file, or 'Mesh(vertices, faces)'.");
  add("volume", &Report::volume, "float, m^3: enclosed; of no meaning for an open mesh.");
  add("area", &Report::area, "float, m^2.");
  add("triangles", &Report::triangles, "int.");
  add("boundary_edges", &Report::boundary_edges, "int: edges of one face; 0 for a closed mesh.");
  add("non_manifold_edges", &Report::non_manifold_edges, "int: edges of three or more faces.");
  add("misoriented_edges", &Report::misoriented_edges, "int: edges between faces of opposite winding.");
  add("degenerate_faces", &Report::degenerate_faces, "int: faces without area, kept.");
  add("dropped_faces", &Report::dropped_faces, "int: faces that use a vertex twice.");
  add("duplicate_faces", &Report::duplicate_faces, "int.");
  add("intersecting_pairs", &Report::intersecting_pairs,
      "int, or None without count_intersections=True: pairs of faces that intersect.");
  add("flipped", &Report::flipped, "bool: was the mesh inside out, and turned?");
  add("vertices", &Report::vertices_welded, "int: after welding.");
  add("closed", &Report::closed, "bool: has the mesh no boundary?");
  add(
      "components", [](const Report& report) { return report.components.size(); }, "int: connected parts.");
  add(
      "format", [](const Report& report) { return report.source.format; }, "str: of the file.");
  add(
      "report", [](const Report& report) { return to_str(to_text(report)); },
      "str: the whole report, several lines.");
  add(
      "bounding_box", [](const Report& report) { return py::make_tuple(report.box.min_B, report.box.max_B); },
      "Two (3,), m: the least and the greatest coordinates, in the mesh's frame.");
  add_property(
      type, "center_of_mass",
      [](const MeshObject& object) { return object.mesh->mass_properties().centroid_B; },
      "(3,), m, in the mesh's frame: of a solid of uniform density.");
  add_property(
      type, "inertia", [](const MeshObject& object) { return object.mesh->mass_properties().inertia_B; },
      "(3, 3), m^5, about center_of_mass, in the mesh's axes: times the density of a solid it is kg m^2.");
  type.def("__repr__", [](py::handle self) {
    const MeshReport& report = report_of(instance_of<MeshObject>(self));
    return to_str("<buoyancy.Mesh " + report.name + ": " +
                  pluralize(report.triangles, "triangle", "triangles") + ", " +
                  format_number(report.volume, 6) + " m^3>");
  });
}

}  // namespace buoyancy::python
