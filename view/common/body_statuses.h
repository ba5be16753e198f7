// Names and meanings of BodyStatus, from which the pages display the status of a body.
#pragma once

#include "base/json.h"
namespace buoyancy::view {

// An array indexed by BodyStatus of [name, meaning], such as ["OK", ""] for BodyStatus::kOk.
Json body_statuses();

}  // namespace buoyancy::view
