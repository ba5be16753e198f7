// The report of `buoyancyd --check`: the water, the sea, the bodies and the report of each mesh, as text and
// as JSON.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "scene/body_flotation.h"
#include "scene/scene.h"

namespace buoyancy {

struct SceneReportOptions {
  // Report how the bodies with [body.client] move, see body_motions.h. This takes seconds for 10,000 large
  // bodies that all differ.
  bool motions = false;
  // The attitudes at which the scene's bodies float, from scene_flotation(); nullptr: they are not
  // reported.
  const std::vector<FlotationOfBody>* flotation = nullptr;
  // [m], over the lowest point of each body along its up, at which to report the upright hull.
  std::vector<double> drafts{};
};

// Returns lines for a terminal, with a final newline.
std::string scene_report_text(const Scene& scene, const SceneReportOptions& options = {});

// Returns one JSON object, with a final newline: "scene", "water", "sea", "bodies" (in the order of the file;
// "mesh" is an index into "meshes"; mass and density are those that the simulator uses, null if an open mesh
// leaves them unknown) and "meshes" (the fields of MeshReport by name, and "bodies": the ids of its bodies).
// Non-finite numbers are null.
//
// "sea" is null if the water is at rest, and {"received": true} if waves are received. Else it holds "depth"
// (null: deep), "wave_pressure", "time_origin" and "ramp" as in the scene file; "significant_wave_height" of
// all systems together, "shortest_wavelength", "extreme_steepness" (Sea::extreme_steepness()); "systems" (the
// fields of WaveSystemReport by name, those of its peak as "peak_period", "peak_wavelength" and "steepness",
// "breaking_ratio", of the height over that at which such waves break, and "repeat_time" [s], null if it is
// infinite, see repeat_time()); "together", the same of report_components(), which repeats when the last
// system does; and "components", all systems' one after the other, with the keys of the scene file. Every
// number parses to the double that is used.
//
// Only where the scene has them, "water" has "current" [m/s], and a body "drag" and "added_mass", with the
// keys of the scene file. With options.motions a body with [body.client] has "motions", null where they are
// unknown. Else it holds the fields of BodyMotions by name, with "heave", "roll" and "pitch" as objects, null
// where nothing restores the motion: "period" and, by name, the other fields of NaturalMotion. Infinite
// numbers are null.
//
// With options.flotation a body with [body.client] has "flotation", null where it is unknown or left out:
// "outcome" ("floats", "sinks", "neutrally_buoyant", "takes_in_water", "out_of_range"), "start" ("pose" or
// "equilibrium"), "mass" [kg] with the liquids in its tanks, "attitudes", "truncated", "turn" [degrees]
// (null: it reaches none) and "starts_unstable". An attitude has "reached" (the body turns to it from its
// `orientation`), "position" and "quaternion_wxyz" (at the place and heading of [body.client]), "draft",
// "heel" and "trim" [degrees], "metacentric_heights", "energy" [J] and "family", see equilibrium.h.
//
// With options.drafts every body has "upright": for each draft "draft" [m], "volume" [m^3] and "mass" [kg] of
// the displaced water, "kb", "bm_t", "bm_l" and "lcf" [m], as in hydrostatic_table.h; null where there is no
// result.
//
// A mesh's "source" has "polygons" only where the file has faces of four or more corners: their "count",
// "non_planar", "largest_distance" [m] and "split_volume" [m^3], see PolygonSplit.
//
// "parts", "compartments" and "tanks" of a body, and "sections" of a mesh, which lists those that use it,
// exist only where the scene has them.
std::string scene_report_json(const Scene& scene, const SceneReportOptions& options = {});

// Return the reports of refused meshes as lines, and as one JSON object, with a final newline: "refused" is
// an array of the fields of MeshReport with "error", a text; there is only "error" for an unreadable file.
std::string refused_meshes_text(const std::vector<RefusedMesh>& meshes);
std::string refused_meshes_json(const std::vector<RefusedMesh>& meshes);

// Warns about a scene that can be used: as sea_warnings() does; about a full quadratic drag matrix that can
// drive the body (find_driving_twist(), for the first kMaxSearchedMatrices that differ); drag or added mass
// of a body whose method has no error bound in waves; a centre farther from the mesh's box than the mesh's
// diagonal; coefficients that are too large for the mesh; parts, compartments and tanks that overlap, and
// compartments and tanks that stick out of their hull (subdivision_warnings.h); meshes that lie on their side
// or are in another unit (mesh_warnings.h). A warning about equal bodies appears once.
std::vector<Warning> scene_warnings(const Scene& scene);

}  // namespace buoyancy
