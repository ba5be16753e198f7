// The page of buoyancy-mesh repair --html, in a real browser.
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/child_process.h"
#include "tests/support/contains.h"
#include "tests/support/temp_dir.h"
#include "tests/view/page_test.h"

namespace buoyancy::view {
namespace {

// A barge of 10 x 4 x 2 m without a deck.
const std::string kBarge =
    "v 0 -2 0\nv 10 -2 0\nv 10 2 0\nv 0 2 0\nv 0 -2 2\nv 10 -2 2\nv 10 2 2\nv 0 2 2\n"
    "f 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

class MeshPage : public PageTest {
 protected:
  static int open(std::vector<std::string> options) {
    const TempDir directory;
    const std::string page = directory.path("page.html");
    options.insert(options.begin(), {"repair", directory.write("barge <b>.obj", kBarge),
                                     directory.path("barge.ply"), "--html", page});
    const int exit_code = run_program("buoyancy-mesh", std::move(options)).exit_code.value_or(-1);
    browser().open_file(page);
    browser().wait_until("window.buoyancy_mesh !== undefined");
    return exit_code;
  }

  // Whether a picture has pixels of about this colour.
  static bool shows(const std::string& canvas, const std::string& condition) {
    return browser()
        .run("const canvas = document.getElementById('" + canvas +
             "'); const p = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;"
             "let count = 0; for (let i = 0; i < p.length; i += 4) { const [r, g, b, a] = p.slice(i, i + 4);"
             "if (a > 200 && (" +
             condition + ")) ++count; } return count > 50")
        .get<bool>();
  }
  static constexpr const char* kRed = "r > 180 && g < 40 && b < 80";
  static constexpr const char* kOrange = "r > 100 && g > 0.4 * r && g < 0.7 * r && b < 0.2 * r";
  static constexpr const char* kBlue = "b > 60 && b > 1.5 * r";
};

TEST_F(MeshPage, ShowsOpenEdgesBeforeAndCapsAfter) {
  EXPECT_EQ(open({"--rims"}), 0);
  EXPECT_EQ(browser().run("return performance.getEntriesByType('resource').length"), 0);
  EXPECT_EQ(browser().run("return document.getElementById('title').textContent"), "barge <b>.obj");
  EXPECT_TRUE(contains(text_of("#report"), "1 hole closed"));
  EXPECT_TRUE(shows("before", kRed));
  EXPECT_TRUE(shows("before", kBlue));
  EXPECT_FALSE(shows("after", kRed));
  EXPECT_TRUE(shows("after", kOrange));
  const auto azimuth = browser().run("return buoyancy_mesh.view.azimuth").get<double>();
  browser().run("document.getElementById('after').focus()");
  browser().press("ArrowLeft");
  EXPECT_GT(browser().run("return buoyancy_mesh.view.azimuth").get<double>(), azimuth);
}

TEST_F(MeshPage, ShowsAMeshThatCannotBeUsed) {
  EXPECT_EQ(open({}), 1);
  EXPECT_TRUE(shows("before", kRed));
  EXPECT_EQ(browser().run("return document.getElementById('after_figure').hidden"), true);
  EXPECT_TRUE(contains(text_of("#report"), "1: 4 edges"));
}

}  // namespace
}  // namespace buoyancy::view
