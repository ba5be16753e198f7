// The parts of the report of `buoyancyd --check` about drag, added mass and motions: see scene_report.h.
#pragma once

#include "base/facts.h"
#include "scene/body_motions.h"

namespace buoyancy {

// Adds "drag" and "added_mass" of a body that has them. In the text a matrix appears as its diagonal.
void add_coefficients(const Body& body, Facts& facts);
// Adds "motions" to a body with [body.client], and lines to one that might be expected to have them: where
// they are unknown, the line says why.
void add_motions(const MotionsOfBody& entry, const Body& body, const Water& water, Facts& facts);

}  // namespace buoyancy
