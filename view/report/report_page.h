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
// rows, "without_velocities"}.
std::string report_data(const Scene& scene, const RecordedRun& run, const ReportOptions& options);

// loads: whether a body has loads, so that the page contains the script that plots them.
std::string report_page(const std::string& data, std::string_view three, bool loads = false);

}  // namespace buoyancy::view
