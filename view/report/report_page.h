// Writes a run as one HTML file that contains everything it needs: three.js, meshes and rows.
#pragma once

#include <string>

#include "scene/scene.h"
#include "view/report/run.h"

namespace buoyancy::view {

struct ReportOptions {
  std::string file;  // name of the run's file, as displayed
  std::string version;
  bool selected = false;  // the bodies that are shown were selected by the user
};

// The JSON data that the page's script reads (view/page/report.js). For bodies with the output "hydrostatics"
// the metacentres of every kept row are computed. O(rows * cost of a query). Only bodies with loads have
// "loads": {"data": base64 of float32, the columns of LoadRow one after the other, "recorded", "computed":
// rows, "without_velocities"}. Only bodies with BodyRun::conditions have "conditions": {"list": these, each
// {"flooded": [], "liquid_volumes": []} or null, "rows": base64 of uint32, the index of each row into the
// list}.
std::string report_data(const Scene& scene, const RecordedRun& run, const ReportOptions& options);

// The parts of a page that only some runs need.
struct PageParts {
  bool loads = false;        // a body has loads, which the page plots
  bool subdivision = false;  // a body has compartments or tanks, which the page draws
};

std::string report_page(const std::string& data, std::string_view three, const PageParts& parts = {});

}  // namespace buoyancy::view
