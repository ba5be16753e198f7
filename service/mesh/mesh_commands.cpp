#include "service/mesh/mesh_commands.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/format.h"
#include "geometry/mass_properties.h"
#include "geometry/mesh_import.h"
#include "geometry/surface_distance.h"
#include "geometry/volume_difference.h"
#include "geometry/welding.h"
#include "hydrostatics/load_difference.h"
#include "scene/mesh_report_json.h"
#include "service/mesh/mesh_wrap.h"

namespace buoyancy::service {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json json_of(const CheckedMesh& mesh) {
  Json json = mesh.report ? mesh_report_json(*mesh.report) : Json{{"name", mesh.name}};
  json["usable"] = mesh.mesh.has_value();
  json["error"] = mesh.error ? Json(mesh.error->message()) : Json(nullptr);
  return json;
}

std::string line_of(const CheckedMesh& mesh) {
  std::string line = mesh.name;
  if (!mesh.mesh) return line + ": not usable: " + (mesh.error ? mesh.error->message() : "");
  line += ": usable, " + format_number(mesh.report->volume, 6) + " m^3";
  const RepairReport& repair = mesh.report->repair;
  if (!repair.steps.empty()) {
    line += "; repaired: ";
    for (const RepairStep& step : repair.steps) {
      if (&step != &repair.steps.front()) line += ", ";
      line += std::string(to_string(step.kind)) + " " + std::to_string(step.count);
    }
  }
  return line;
}

std::size_t count_usable(const std::vector<CheckedMesh>& meshes) {
  return static_cast<std::size_t>(std::count_if(
      meshes.begin(), meshes.end(), [](const CheckedMesh& mesh) { return mesh.mesh.has_value(); }));
}

std::string single_report_text(const CheckedMesh& mesh) {
  std::string text = mesh.report ? to_text(*mesh.report) + "\n" : "";
  text += mesh.mesh ? "usable\n" : "not usable: " + mesh.error->message() + "\n";
  return text;
}

struct ComparedMesh {
  std::string name;
  ValidatedMesh mesh;
  MassProperties properties;  // of density 1 kg/m^3
};

Expected<ComparedMesh> read_closed(const std::filesystem::path& path, const MeshPreparation& preparation) {
  CheckedMesh checked = check_mesh(path, preparation);
  if (!checked.mesh) {
    if (checked.report && checked.report->closing) {
      checked.error->hint =
          "compare needs two closed meshes; what closing changes is in the report of buoyancy-mesh repair";
    }
    return make_error(*std::move(checked.error));
  }
  const MassProperties properties = mass_properties(*checked.mesh);
  return ComparedMesh{std::move(checked.name), {*std::move(checked.mesh), {}}, properties};
}

struct Difference {
  VolumeDifference volume;
  double from_a = 0.0, from_b = 0.0;  // [m], of a's surface from b's, and the other way
  LoadDifference loads;
};

Json json_of(const ComparedMesh& mesh) {
  const auto vector = [](const Vec3& v) { return Json{v.x(), v.y(), v.z()}; };
  const Mat3& inertia = mesh.properties.inertia_B;
  return {{"name", mesh.name},
          {"triangles", mesh.mesh.mesh.triangles.size()},
          {"volume", mesh.properties.volume},
          {"centroid", vector(mesh.properties.centroid_B)},
          {"inertia", {vector(inertia.row(0)), vector(inertia.row(1)), vector(inertia.row(2))}}};
}

std::string line_of(const ComparedMesh& mesh) {
  const Mat3& inertia = mesh.properties.inertia_B;
  return mesh.name + "\n  volume        " + format_number(mesh.properties.volume) + " m^3\n  centroid      " +
         format_vector(mesh.properties.centroid_B) + " m\n  inertia       Ixx, Iyy, Izz " +
         format_vector(inertia.diagonal(), 6) + "; Ixy, Ixz, Iyz " +
         format_vector({inertia(0, 1), inertia(0, 2), inertia(1, 2)}, 6) +
         " m^5, about the centroid, of density 1\n";
}

std::string text_of(const ComparedMesh& a, const ComparedMesh& b, const Difference& difference,
                    const MeshOptions& options) {
  const double weight = options.density * options.gravity;
  std::string text = line_of(a) + line_of(b) + "difference\n";
  const auto line = [&text](const std::string& label, const std::string& value) {
    text += "  " + label + std::string(label.size() < 14 ? 14 - label.size() : 1, ' ') + value + "\n";
  };
  const double change = b.properties.volume - a.properties.volume;
  line("volume",
       format_number(change, 6) + " m^3, " + format_number(100.0 * change / a.properties.volume, 4) + " %");
  line("centroid", format_vector(b.properties.centroid_B - a.properties.centroid_B, 6) + " m");
  line("between", format_number(difference.volume.value, 6) + " m^3 in one of them alone, +- " +
                      format_number(difference.volume.error, 3) + " m^3");
  line("distance", format_number(difference.from_a, 6) + " m from the first to the second, " +
                       format_number(difference.from_b, 6) + " m back");
  line("force", "up to " + format_number(difference.loads.force, 6) + " N over " +
                    std::to_string(options.poses) + " poses; never more than " +
                    format_number(weight * (difference.volume.value + difference.volume.error), 6) +
                    " N in water at rest");
  line("torque", "up to " + format_number(difference.loads.torque, 6) + " N m about the origin");
  return text;
}

}  // namespace

CheckedMesh check_mesh(const std::filesystem::path& path, const MeshPreparation& preparation) {
  CheckedMesh checked;
  checked.name = path.string();
  Expected<ImportedMesh> imported = import_mesh(path);
  if (!imported) {
    checked.error = std::move(imported.error());
    return checked;
  }
  MeshValidation validation = validate_mesh(*std::move(imported), checked.name, preparation);
  checked.report = std::move(validation.report);
  checked.error = std::move(validation.refusal);
  if (validation.mesh) checked.mesh = std::move(validation.mesh->mesh);
  return checked;
}

Expected<CheckedMesh> wrapped(const CheckedMesh& mesh, const MeshPlan& plan, double gap) {
  TriangleMesh given;
  if (mesh.mesh) {
    given = *mesh.mesh;
  } else {
    Expected<ImportedMesh> imported = import_mesh(plan.inputs.front());
    if (!imported) return make_error(std::move(imported.error()));
    if (plan.preparation.mirror) {
      const Expected<RepairStep> step = add_mirror_image(imported->mesh, *plan.preparation.mirror, mesh.name);
      if (!step) return make_error(step.error());
    }
    place(imported->mesh, plan.preparation.placement);
    given = weld(imported->mesh).mesh;
  }
  Expected<TriangleMesh> wrap = wrap_mesh(given, gap);
  if (!wrap) return make_error(std::move(wrap.error()));
  MeshValidation validation = validate_mesh({*std::move(wrap), {}}, mesh.name, plan.preparation.validation);
  CheckedMesh result;
  result.name = mesh.name;
  if (mesh.report) validation.report.source = mesh.report->source;
  result.report = std::move(validation.report);
  result.error = std::move(validation.refusal);
  if (!validation.mesh) return result;
  result.mesh = std::move(validation.mesh->mesh);
  result.wrap = WrapReport{gap, largest_distance(given, *result.mesh), largest_distance(*result.mesh, given)};
  return result;
}

std::string report_text(const std::vector<CheckedMesh>& meshes) {
  if (meshes.size() == 1) return single_report_text(meshes.front());
  std::string text;
  for (const CheckedMesh& mesh : meshes) text += line_of(mesh) + "\n";
  const std::size_t usable = count_usable(meshes);
  return text + std::to_string(meshes.size()) + " meshes: " + std::to_string(usable) + " usable, " +
         std::to_string(meshes.size() - usable) + " not\n";
}

std::string report_json(const std::vector<CheckedMesh>& meshes) {
  Json list = Json::array();
  for (const CheckedMesh& mesh : meshes) list.push_back(json_of(mesh));
  return text_of({{"meshes", std::move(list)}, {"usable", count_usable(meshes)}});
}

Expected<CheckedMesh> as_written(CheckedMesh mesh, const std::string& output) {
  constexpr int kMaxPasses = 6;
  constexpr double kMaxChange = 1e-5;  // of the volume
  const double volume = mesh.report->volume;
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    MeshValidation validation = validate_mesh({as_imported(*mesh.mesh), {}}, mesh.name, ValidationOptions{});
    if (!validation.mesh || !(std::abs(validation.report.volume - volume) <= kMaxChange * volume)) break;
    if (validation.report.repair.steps.empty() && validation.mesh->mesh.triangles == mesh.mesh->triangles)
      return mesh;
    mesh.mesh = std::move(validation.mesh->mesh);
    append(validation.report.repair, mesh.report->repair);
    RepairReport repair = std::move(mesh.report->repair);
    MeshSource source = std::move(mesh.report->source);
    mesh.report = std::move(validation.report);
    mesh.report->repair = std::move(repair);
    mesh.report->source = std::move(source);
  }
  return make_error({output, "the mesh is damaged where it is read in single precision",
                     "details larger than 1e-7 of the distance from the origin",
                     "the mesh lies far from its origin, or has details that are tiny against its size",
                     "Move the mesh to its origin, or leave out the detail"});
}

std::string repair_text(const CheckedMesh& repaired, const std::string& output) {
  std::string text = to_text(*repaired.report) + "\n";
  if (repaired.wrap) {
    text += "  wrap          gaps up to " + format_number(repaired.wrap->gap, 6) + " m; up to " +
            format_number(repaired.wrap->from_mesh, 4) + " m from the mesh to the wrap, " +
            format_number(repaired.wrap->from_wrap, 4) + " m back\n";
  }
  return text + "written to " + output + ": " +
         pluralize(repaired.report->triangles, "triangle", "triangles") + "\n";
}

std::string repair_json(const CheckedMesh& repaired, const std::string& output) {
  Json json = json_of(repaired);
  json["output"] = output;
  json["wrap"] = nullptr;
  if (repaired.wrap) {
    json["wrap"] = {{"gap", repaired.wrap->gap},
                    {"distance_from_mesh", repaired.wrap->from_mesh},
                    {"distance_from_wrap", repaired.wrap->from_wrap}};
  }
  return text_of(json);
}

Expected<std::string> compare_meshes(const MeshPlan& plan, const MeshOptions& options) {
  const Expected<ComparedMesh> a = read_closed(plan.inputs[0], plan.preparation);
  if (!a) return make_error(a.error());
  const Expected<ComparedMesh> b = read_closed(plan.inputs[1], plan.preparation);
  if (!b) return make_error(b.error());
  Difference difference;
  difference.volume = symmetric_difference(a->mesh.mesh, b->mesh.mesh);
  difference.from_a = largest_distance(a->mesh.mesh, b->mesh.mesh);
  difference.from_b = largest_distance(b->mesh.mesh, a->mesh.mesh);
  difference.loads = largest_load_difference(make_hydrostatic_mesh(a->mesh, WithTree::kYes),
                                             make_hydrostatic_mesh(b->mesh, WithTree::kYes), options.density,
                                             options.gravity, options.poses);
  if (!options.json) return text_of(*a, *b, difference, options);
  const double weight = options.density * options.gravity;
  return text_of({{"a", json_of(*a)},
                  {"b", json_of(*b)},
                  {"volume_between", difference.volume.value},
                  {"volume_between_error", difference.volume.error},
                  {"distance_from_a", difference.from_a},
                  {"distance_from_b", difference.from_b},
                  {"density", options.density},
                  {"gravity", options.gravity},
                  {"poses", options.poses},
                  {"force_difference", difference.loads.force},
                  {"torque_difference", difference.loads.torque},
                  {"force_bound", weight * (difference.volume.value + difference.volume.error)}});
}

}  // namespace buoyancy::service
