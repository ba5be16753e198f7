// Parses a list of bodies given on the command line: ids and ranges of ids, "1-50,900".
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/scene.h"

namespace buoyancy::view {

// The bodies in the list as indices into scene.bodies(), ascending, without duplicates. A range may contain
// ids that the scene does not have. Errors: invalid syntax, an id or a range without a body, more bodies than
// a page can show.
Expected<std::vector<std::size_t>> body_list(const std::string& list, const Scene& scene);

}  // namespace buoyancy::view
