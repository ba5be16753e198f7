#include "service/mesh/mesh_commands.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/facts.h"
#include "geometry/mass_properties.h"
#include "geometry/mesh_import.h"
#include "geometry/mesh_report_facts.h"
#include "geometry/surface_distance.h"
#include "geometry/volume_difference.h"
#include "geometry/welding.h"
#include "hydrostatics/load_difference.h"
#include "service/mesh/mesh_wrap.h"

namespace buoyancy::service {
namespace {

Json json_of(const CheckedMesh& mesh) {
  Json json = mesh.report ? mesh_report_facts(*mesh.report).json() : Json{{"name", mesh.name}};
  json["usable"] = mesh.mesh.has_value();
  json["error"] = mesh.error ? std::optional(mesh.error->message()) : std::nullopt;
  return json;
}

std::string line_of(const CheckedMesh& mesh) {
  std::string line = mesh.name;
  if (!mesh.mesh) return line + ": not usable: " + (mesh.error ? mesh.error->message() : "");
  line += format_text(": usable, {:6} m^3", mesh.report->volume);
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

Facts facts_of(const ComparedMesh& mesh) {
  const Mat3& inertia = mesh.properties.inertia_B;
  Facts facts;
  facts.heading("{}", mesh.name).add("name", mesh.name);
  facts.add("triangles", mesh.mesh.mesh.triangles.size());
  facts.line("volume").add("volume", mesh.properties.volume, "{} m^3");
  facts.line("centroid").add("centroid", mesh.properties.centroid_B, "{} m");
  facts.line("inertia").say("Ixx, Iyy, Izz {:6}; Ixy, Ixz, Iyz {:6} m^5, about the centroid, of density 1",
                            Vec3(inertia.diagonal()), Vec3(inertia(0, 1), inertia(0, 2), inertia(1, 2)));
  facts.add("inertia", Json{Vec3(inertia.row(0)), Vec3(inertia.row(1)), Vec3(inertia.row(2))});
  return facts;
}

Facts facts_of(const ComparedMesh& a, const ComparedMesh& b, const Difference& difference,
               const MeshOptions& options) {
  const double change = b.properties.volume - a.properties.volume;
  const double force_bound =
      options.density * options.gravity * (difference.volume.value + difference.volume.error);
  Facts facts;
  facts.include("a", facts_of(a)).include("b", facts_of(b)).heading("difference");
  facts.line("volume").say("{:6} m^3", change).say("{:4} %", 100.0 * change / a.properties.volume);
  facts.line("centroid").say("{:6} m", Vec3(b.properties.centroid_B - a.properties.centroid_B));
  facts.line("between").add("volume_between", difference.volume.value, "{:6} m^3 in one of them alone");
  facts.add("volume_between_error", difference.volume.error, "+- {:3} m^3");
  facts.line("distance").add("distance_from_a", difference.from_a, "{:6} m from the first to the second");
  facts.add("distance_from_b", difference.from_b, "{:6} m back");
  facts.add("density", options.density).add("gravity", options.gravity).add("poses", options.poses);
  facts.line("force").add("force_difference", difference.loads.force, "up to {:6} N");
  facts.say(" over {} poses; never more than {:6} N in water at rest", options.poses, force_bound);
  facts.line("torque").add("torque_difference", difference.loads.torque, "up to {:6} N m about the origin");
  facts.add("force_bound", force_bound);
  return facts;
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
  return json_lines({{"meshes", std::move(list)}, {"usable", count_usable(meshes)}});
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
    text += format_text(
        "  wrap          gaps up to {:6} m; up to {:4} m from the mesh to the wrap, {:4} m back\n",
        repaired.wrap->gap, repaired.wrap->from_mesh, repaired.wrap->from_wrap);
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
  return json_lines(json);
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
  Facts facts = facts_of(*a, *b, difference, options);
  return options.json ? json_lines(facts.json()) : facts.text() + "\n";
}

}  // namespace buoyancy::service
