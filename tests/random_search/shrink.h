// A failing case made small: edges collapsed while the case still fails, numbers made short; and as a test to
// paste.
#pragma once

#include <functional>
#include <string>

#include "tests/random_search/search.h"

namespace buoyancy {

using StillFails = std::function<bool(const TriangleMesh&, const SearchPose&)>;

// The case as validation accepts it and a result that `answering` gives breaks a law.
bool fails(const TriangleMesh& mesh, const SearchPose& asked, const EvaluateAll& answering);

SearchCase shrunk(SearchCase failing, const StillFails& still_fails);

// A GoogleTest test of the case, numbers in hexadecimal.
std::string as_test(const SearchCase& failing, std::uint64_t seed, std::int64_t number);

}  // namespace buoyancy
