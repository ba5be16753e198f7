// Names and meanings of BodyStatus, from which the pages display the status of a body.
#pragma once

#include <nlohmann/json.hpp>

namespace buoyancy::view {

// An array indexed by BodyStatus of [name, meaning], such as ["OK", ""] for BodyStatus::kOk.
nlohmann::ordered_json body_statuses();

}  // namespace buoyancy::view
