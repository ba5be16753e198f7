// The results of the command ballast, as a person, JSON and CSV have them.
#pragma once

#include <optional>
#include <string>

#include "base/error.h"
#include "base/json.h"
#include "flotation/ballast.h"

namespace buoyancy::service {

// The text ends with the section [body.client] of the ballasted body, ready for a scene file.
std::string ballast_text(const Ballast& ballast);
Json ballast_json(const Ballast& ballast);  // one object; its names are in docs/hydrostatics.md
std::string ballast_csv(const Ballast& ballast);

// Places outside of the hull's box; nullopt: none.
std::optional<Warning> outside_warning(const Ballast& ballast);
// Why the target, which is in balance, is not an attitude of rest; nullopt: it is stable.
std::optional<Error> instability(const Ballast& ballast);

}  // namespace buoyancy::service
