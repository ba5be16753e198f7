// Infers from how the responses differ why they do: another density, level, mesh, reference point and so on.
//
// Each cause is a sentence for the user. It names a number only where all samples agree about it; otherwise
// it says which differences remain possible.
#pragma once

#include <string>
#include <vector>

#include "client/ping/response_checks.h"
#include "scene/scene.h"

namespace buoyancy::ping {

// Causes of differing wrenches and loads, the most specific first; none if nothing differs or if the
// differences have no pattern.
std::vector<std::string> causes_of_differences(const Scene& scene, const ResponseChecks& checks);

}  // namespace buoyancy::ping
