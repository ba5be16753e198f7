// A list of bodies as somebody types it: ids and ranges of ids, "1-50,900".
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/scene.h"

namespace buoyancy {

// The bodies named, as indices into scene.bodies(), ascending, each once. A range may name ids that the scene
// does not have. Errors: not such a list, an id or a range without a body, more bodies than a page shows.
Expected<std::vector<std::size_t>> body_list(const std::string& list, const Scene& scene);

}  // namespace buoyancy
