// Returns the facts of a mesh's report, as text and as JSON.
#pragma once

#include "base/facts.h"
#include "geometry/mesh_report.h"

namespace buoyancy {

// The text is that of to_text(). The object has the fields of MeshReport by name; `flipped` is "turned" and
// `max_move` "largest_move". "closing" is null unless the mesh is refused for its edges and could be closed;
// "advice" is closing_advice().
Facts mesh_report_facts(const MeshReport& report);
// Returns what a repair did, as two lines or more with the label "repair"; no line if it did nothing.
Facts repair_facts(const RepairReport& report);

}  // namespace buoyancy
