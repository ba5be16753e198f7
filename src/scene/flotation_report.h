// The parts of the report of `buoyancyd --check` about where bodies float: see scene_report.h.
#pragma once

#include <vector>

#include "base/facts.h"
#include "scene/body_flotation.h"
#include "scene/body_key.h"

namespace buoyancy {

// Adds "flotation" and its lines to a body with [body.client]; no lines if it does not float.
void add_flotation(const FlotationOfBody& entry, const Body& body, const Water& water, Facts& facts);

// Adds "upright" and its lines: the hull at these drafts [m], which needs no mass.
void add_upright(const Body& body, const Water& water, const std::vector<double>& drafts,
                 MeshesWithTrees& meshes, Facts& facts);

}  // namespace buoyancy
