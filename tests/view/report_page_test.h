// Base class of tests of the page of buoyancy-report.
#pragma once

#include <array>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/child_process.h"
#include "tests/support/temp_dir.h"
#include "tests/view/page_test.h"

namespace buoyancy::view {

class ReportPageTest : public PageTest {
 protected:
  // Writes the page of a run, whose program ends with this exit code, and opens it.
  void open_run(const std::string& scene, const std::string& run, int exit_code = 0) {
    const FinishedProcess made =
        run_program("buoyancy-report", {"--scene", scene, run, directory_.path("run.html")});
    ASSERT_EQ(made.exit_code, exit_code) << made.standard_error;
    open_page(directory_.path("run.html"));
  }
  static void open_page(const std::string& page) {
    browser().open_file(page);
    browser().wait_until("window.buoyancy_report !== undefined");
  }

  // The pixel of a screenshot at which a point in W is drawn.
  static std::array<int, 2> pixel_of(double x, double y, double z) {
    const nlohmann::json at = browser().run(
        "const box = document.getElementById('canvas').getBoundingClientRect();"
        "const [x, y] = buoyancy_report.scene.project(arguments[0]); return [x + box.left, y + box.top];",
        std::array{x, y, z});
    return {static_cast<int>(at[0].get<double>()), static_cast<int>(at[1].get<double>())};
  }
  // Whether a pixel of the waterline is drawn within 3 pixels of a point in W.
  static bool waterline_at(const Image& image, double x, double y, double z) {
    const std::array<int, 2> at = pixel_of(x, y, z);
    for (int dy = -3; dy <= 3; ++dy) {
      if (is_near({255, 255, 255}, 45)(image.pixel(at[0], at[1] + dy))) return true;
    }
    return false;
  }

  TempDir directory_;
};

}  // namespace buoyancy::view
