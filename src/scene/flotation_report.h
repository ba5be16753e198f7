// The part of the report of `buoyancyd --check` about where bodies float: see scene_report.h.
#pragma once

#include "base/facts.h"
#include "scene/body_flotation.h"

namespace buoyancy {

// Adds "flotation" and its lines to a body with [body.client]; no lines if it does not float.
void add_flotation(const FlotationOfBody& entry, const Body& body, const Water& water, Facts& facts);

}  // namespace buoyancy
