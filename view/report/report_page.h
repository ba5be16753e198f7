// A run as one HTML file that needs no other: three.js, shapes, rows and all.
#pragma once

#include <string>

#include "scene/scene.h"
#include "view/report/run.h"

namespace buoyancy {

struct ReportOptions {
  std::string file;  // the run's, as shown
  std::string version;
  bool selected = false;  // somebody chose the bodies that are shown
};

// The data that the page's script reads (view/page/report.js). Of bodies that ask for hydrostatics the
// metacentres are computed for every row that is left. O(rows * a query).
std::string report_data(const Scene& scene, const RecordedRun& run, const ReportOptions& options);

std::string report_page(const std::string& data, std::string_view three);

}  // namespace buoyancy
