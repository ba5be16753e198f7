// The part of the report of `buoyancyd --check` about where bodies float: see scene_report.h.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "scene/body_flotation.h"

namespace buoyancy {

// Lines of a body's section; empty for a body without [body.client], and for one that does not float.
std::string flotation_text(const FlotationOfBody& entry, const Body& body);
nlohmann::ordered_json to_json(const BodyFlotation& flotation, const Body& body, const Water& water);

}  // namespace buoyancy
