// buoyancy.Scene: the bodies of a scene file, and queries of them.

#include <functional>
#include <memory>
#include <string>
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
#include "python/scene_object.h"
#include "python/wrenches.h"
#include "scene/mesh_warnings.h"

namespace buoyancy::python {
namespace {

// A body of a scene, which this object keeps alive.
struct BodyObject {
  std::shared_ptr<const Scene> scene;
  const Body* body;
};

// Reads and prepares a scene without the interpreter's lock, and warns of its meshes.
template <typename Read>
std::shared_ptr<const Scene> prepare(const Read& read) {
  std::shared_ptr<const Scene> scene;
  {
    const WithoutGil released;
    scene = std::make_shared<const Scene>(value_or_throw(Scene::prepare(value_or_throw(read()))));
  }
  for (const Warning& warning : mesh_warnings(*scene)) warn(warning);
  return scene;
}

std::unique_ptr<SceneObject> parse(const std::string& text, const py::object& directory) {
  const std::string folder = directory.is_none() ? std::string() : to_path(directory);
  return std::make_unique<SceneObject>(
      SceneObject{prepare([&] { return parse_scene(text, "Scene.from_text()", folder); })});
}

constexpr Parameters<9> kQueryParameters{
    "body_id", "position", "quaternion", "linear_velocity", "angular_velocity", "time",
    "threads", "out",      "sea"};

py::object query(PyObject* self, const Arguments<9>& arguments) {
  const auto& [body_id, position, quaternion, linear, angular, time, threads, out, sea] = arguments;
  const std::shared_ptr<const Scene> scene = instance_of<SceneObject>(self).scene;
  const Body& body = find_body(*scene, body_id);
  QueryWater water = water_of(*scene);
  if (is_given(sea)) {
    water = water_of(instance_of<SeaObject>(sea).sea);
    if (water.current != scene->current()) {
      throw InputException({"sea", "a current of [" + format_vector(water.current.velocity_W) + "] m/s",
                            "the scene's, [" + format_vector(scene->current_W()) + "] m/s", "",
                            "Give both the same velocity or profile below [water.current]"});
    }
    if (water.waves != nullptr && !body.prepared_mesh->wave_mesh) {
      throw InputException({"sea", "waves, with a scene in water at rest",
                            "a scene that is prepared for waves", "",
                            "Write waves = \"received\" below [water] of the scene"});
    }
  }
  const PoseInput poses({position, quaternion, linear, angular, time});
  return evaluate(body, water, poses, body.loads, to_threads(threads), out);
}

constexpr Parameters<4> kHydrostaticsParameters{"body_id", "position", "quaternion", "threads"};

py::object hydrostatics(PyObject* self, const Arguments<4>& arguments) {
  const auto& [body_id, position, quaternion, threads] = arguments;
  const std::shared_ptr<const Scene> scene = instance_of<SceneObject>(self).scene;
  const Body& body = find_body(*scene, body_id);
  if (!body.solver.mesh().tree) {
    throw InputException({"body " + std::to_string(body.id), "no hydrostatics",
                          "a body that is prepared for them", "its method needs no tree of moments",
                          "Add \"hydrostatics\" to its outputs in the scene"});
  }
  const PoseInput poses({.position = position, .quaternion = quaternion});
  return evaluate_hydrostatics(body, scene->water(), poses, to_threads(threads));
}

constexpr const char* kQueryDoc =
    R"(query($self, body_id, position, quaternion, *, linear_velocity=None, angular_velocity=None, time=0.0,
      threads=0, out=None, sea=None)
--

The wrench on a body of the scene, at one pose or at K poses, in the scene's water: a Wrenches.

body_id: int, or the body's name. position, quaternion, time, threads, out: see Mesh.query().
linear_velocity, angular_velocity: (3,) or (K, 3), m/s of the body's origin and rad/s, world frame; None:
at rest. Only bodies with drag or added mass depend on them. sea: a Sea instead of the scene's water; a
scene with waves = "received" needs it, since all poses have the status NO_SEA otherwise.

The wrench has the bits of the service's response to the same pose, with method, tolerance and reference
point of the scene. result.loads holds drag and added mass apart, if "loads" is among the body's outputs.

Raises KeyError for a body that the scene does not have, else as Mesh.query().)";

constexpr const char* kHydrostaticsDoc =
    R"(hydrostatics($self, body_id, position, quaternion, *, threads=0)
--

Waterplane, metacentres and stiffness of a body, in the scene's water at rest: a Hydrostatics.

Metacentric heights belong to the centre of mass of [body.client]. Arguments: see query().)";

constexpr const char* kSceneDoc =
    R"(The water and the bodies of a scene file, prepared for queries (docs/scene_file.md).

Scene(path) reads a file; Scene.from_text(text, directory=None) takes its text. One scene may be queried
by several threads at once.

Raises InputError with the file, the line and the key at fault.)";

void define_body(py::module_& module) {
  py::class_<BodyObject> type(module, "Body", "A body of a scene.");
  const auto add = [&type](const char* name, auto value, const char* doc) {
    add_property(
        type, name, [value](const BodyObject& object) { return std::invoke(value, *object.body); }, doc);
  };
  add("id", &Body::id, "int.");
  add(
      "name", [](const Body& body) { return to_str(body.name); }, "str.");
  add(
      "method", [](const Body& body) { return std::string(to_string(body.solver.method())); }, "str.");
  add(
      "tolerance", [](const Body& body) { return body.solver.tolerance(); }, "float.");
  add(
      "volume", [](const Body& body) { return body.prepared_mesh->report.volume; }, "float, m^3: enclosed.");
  add(
      "triangles", [](const Body& body) { return body.prepared_mesh->report.triangles; }, "int.");
  add(
      "report", [](const Body& body) { return to_str(to_text(body.prepared_mesh->report)); },
      "str: the report of its mesh.");
  add("reference_point", &Body::reference_B, "(3,), m, body frame: torques are about it.");
  add("center_of_mass", &Body::center_of_mass_B, "(3,), m, body frame, from [body.client], else None.");
  add(
      "outputs",
      [](const Body& body) {
        std::vector<std::string> outputs{"wrench"};
        if (body.hydrostatics) outputs.emplace_back("hydrostatics");
        if (body.loads) outputs.emplace_back("loads");
        return py::tuple(py::cast(outputs));
      },
      "tuple of str, as in the scene file.");
  add(
      "position", [](const Body& body) { return body.dynamics.position; },
      "(3,), m: where [body.client] places it.");
  add(
      "quaternion",
      [](const Body& body) {
        const Eigen::Quaterniond& q = body.dynamics.orientation;
        return Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
      },
      "(4,), (w, x, y, z): the orientation of [body.client].");
  type.def("__repr__", [](py::handle self) {
    const Body& body = *instance_of<BodyObject>(self).body;
    return to_str("<buoyancy.Body " + std::to_string(body.id) + " \"" + body.name + "\">");
  });
}

}  // namespace

std::shared_ptr<const Scene> load_scene(py::handle file) {
  const std::string path = to_path(file);
  return prepare([&] { return read_scene_file(path); });
}

const Body& find_body(const Scene& scene, py::handle id) {
  std::string ids;
  if (PyUnicode_Check(id.ptr())) {
    const auto name = id.cast<std::string>();
    for (const Body& body : scene.bodies()) {
      if (body.name == name) return body;
    }
  } else {
    const auto value = to_number<std::int64_t>(id.ptr(), "body_id");
    const Body* const body =
        value == static_cast<std::int32_t>(value) ? scene.find(static_cast<std::int32_t>(value)) : nullptr;
    if (body != nullptr) return *body;
  }
  constexpr std::size_t kMaxListed = 20;
  for (std::size_t i = 0; i < scene.bodies().size() && i < kMaxListed; ++i) {
    const Body& body = scene.bodies()[i];
    ids += (i == 0 ? "" : ", ") + std::to_string(body.id);
    ids += " (" + body.name + ")";
  }
  if (scene.bodies().size() > kMaxListed) ids += ", ...";
  throw py::key_error("the scene has no body " + std::string(py::repr(id)) + "; it has " + ids);
}

void define_scene(py::module_& module) {
  define_body(module);
  py::class_<SceneObject> type(module, "Scene", kSceneDoc);
  type.def(
      py::init([](py::handle path) { return std::make_unique<SceneObject>(SceneObject{load_scene(path)}); }),
      py::arg("path"));
  type.def_static("from_text", &parse, py::arg("text"), py::arg("directory") = py::none(),
                  R"(from_text(text, directory=None)
--

A scene from the text of a scene file. directory: where its relative paths begin.)");
  add_method<&query>(type, "query", 3, kQueryParameters, kQueryDoc);
  add_method<&hydrostatics>(type, "hydrostatics", 3, kHydrostaticsParameters, kHydrostaticsDoc);
  add_property(
      type, "bodies",
      [](const SceneObject& object) {
        const std::shared_ptr<const Scene>& scene = object.scene;
        py::tuple bodies(scene->bodies().size());
        for (std::size_t i = 0; i < scene->bodies().size(); ++i) {
          bodies[i] = py::cast(std::make_unique<BodyObject>(BodyObject{scene, &scene->bodies()[i]}));
        }
        return bodies;
      },
      "tuple of Body, in the order of the file.");
  add_property(
      type, "name", [](const SceneObject& object) { return object.scene->name(); }, "str: the file.");
  add_property(
      type, "has_waves",
      [](const SceneObject& object) {
        return object.scene->sea() != nullptr || object.scene->receives_sea();
      },
      "bool: are there waves, here or in messages?");
  add_water_properties(type, [](const SceneObject& object) { return object.scene->water(); });
  type.def("__repr__", [](py::handle self) {
    const Scene& scene = *instance_of<SceneObject>(self).scene;
    return to_str("<buoyancy.Scene " + scene.name() + ": " +
                  pluralize(static_cast<std::int64_t>(scene.bodies().size()), "body", "bodies") + ">");
  });
}

}  // namespace buoyancy::python
