// The page of --html: one HTML file with the results, their plots, and the hull in the water, in the style of
// buoyancy-report and from the same parts (view/common, view/page).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "flotation/equilibrium.h"
#include "flotation/hydrostatic_table.h"
#include "service/hydrostatics/hydrostatics_output.h"
#include "service/hydrostatics/righting_results.h"

namespace buoyancy::service {

// Longer results are thinned evenly; --csv and --json have all of them.
inline constexpr std::size_t kMaxPageRows = 5'000;

struct PageSubject {
  std::string name;                    // as the title has it
  const FloatingBody* body = nullptr;  // its meshes of factor 1 are drawn
  const Water* water = nullptr;
  ShipAxes axes;
};

// Each returns the page. three: the text of three.js (page_assets.h). The page's script reads
//   "version", "name", "command"
//   "mass" [kg], "center_of_mass" [m], B, and "total_mass" with the liquids in the tanks
//   "model"        for the picture, as in scene_model.h: one body and one mesh. The weight is drawn unless
//                  mass and centre of mass are null
//   "columns"      [{"name", "title", "unit"}] and "values", base64 of float64, one column after the other
//   "rows", "all_rows", "group_rows": rows on the page, of the results, and per trim
//   "states"       base64 of float64, 19 numbers per row: the body's position [m] and its quaternion;
//                  W axes, relative to the position: buoyant force [N], centre of buoyancy, metacentre of the
//                  softer axis [m]; B: centre of mass with the liquids [m]. NaN where there is none
//   "rests"        of righting arms: {"heel", "trim" [degrees], "draft" [m], "state"} where the body rests
//   "results"      as --json prints them, without rows and points
//   "outcome_text" of equilibria that are not there and of the body fully submerged, else empty
// Complexity: O(triangles) and one query of hydrostatics per row.
std::string equilibria_page(const PageSubject& subject, const Equilibria& equilibria,
                            const SubmergedResult* submerged, std::string_view three);
std::string righting_page(const PageSubject& subject, const RightingResults& results,
                          const RightingArmOptions& options, std::string_view three);
// rows: those of each trim after the other, each with as many drafts.
std::string table_page(const PageSubject& subject, const HydrostaticTable& table, const TableRows& rows,
                       std::size_t drafts, std::string_view three);

}  // namespace buoyancy::service
