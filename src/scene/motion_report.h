// The parts of the report of `buoyancyd --check` about drag, added mass and motions: see scene_report.h.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "scene/body_motions.h"

namespace buoyancy {

// Lines of a body's section; empty for a body without these tables. A matrix appears as its diagonal.
std::string coefficients_text(const Body& body);
// Where there are no motions, the line says why; empty for a body to which they do not apply.
std::string motions_text(const MotionsOfBody& entry, const Body& body, const Water& water);

nlohmann::ordered_json to_json(const DragCoefficients& drag);
nlohmann::ordered_json to_json(const AddedMassCoefficients& added_mass);
nlohmann::ordered_json to_json(const BodyMotions& motions);

}  // namespace buoyancy
