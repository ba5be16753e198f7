// The report of `buoyancyd --check`: the water, the sea, the bodies and the report of each mesh, as text and
// as JSON.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "scene/scene.h"

namespace buoyancy {

// Returns lines for a terminal, with a final newline.
std::string scene_report_text(const Scene& scene);

// Returns one JSON object, with a final newline: "scene", "water", "sea", "bodies" (in the order of the file;
// "mesh" is an index into "meshes"; mass and density are those that the simulator uses, null if an open mesh
// leaves them unknown) and "meshes" (the fields of MeshReport by name, and "bodies": the ids of its bodies).
// Non-finite numbers are null.
//
// "sea" is null if the water is at rest, and {"received": true} if waves are received. Else it holds "depth"
// (null: deep), "wave_pressure", "time_origin" and "ramp" as in the scene file; "significant_wave_height" of
// all systems together, "shortest_wavelength", "extreme_steepness" (Sea::extreme_steepness()); "systems" (the
// fields of WaveSystemReport by name, those of its peak as "peak_period", "peak_wavelength" and "steepness");
// and "components", all systems' one after the other, with the keys of the scene file. Every number parses to
// the double that is used.
std::string scene_report_json(const Scene& scene);

// Warnings about a scene that can be used: a sea that is too steep for linear theory.
std::vector<Warning> scene_warnings(const Scene& scene);

}  // namespace buoyancy
