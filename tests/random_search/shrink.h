// Shrinks a failing case, by collapsing edges and shortening numbers while it still fails, and formats it as
// a test to paste.
#pragma once

#include <functional>
#include <string>

#include "tests/random_search/search.h"

namespace buoyancy {

using StillFails = std::function<bool(const TriangleMesh&, const SearchPose&)>;

// True if validation accepts the mesh and a result of `evaluate` violates a rule.
bool fails(const TriangleMesh& mesh, const SearchPose& requested, const EvaluateAll& evaluate);

SearchCase shrunk(SearchCase failing, const StillFails& still_fails);

// Formats the case as a GoogleTest test, with numbers in hexadecimal.
std::string as_test(const SearchCase& failing, std::uint64_t seed, std::int64_t number);

}  // namespace buoyancy
