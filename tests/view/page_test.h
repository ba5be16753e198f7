// Base class of page test fixtures: one browser for all tests of a program, a desktop screen at the start of
// each test, and a screenshot if a test fails.
#pragma once

#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/build_paths.h"
#include "tests/view/browser.h"

namespace buoyancy::view {

class PageTest : public testing::Test {
 protected:
  static Browser& browser() { return *browser_; }
  static std::string text_of(const std::string& selector) {
    return browser()
        .run("return document.querySelector(arguments[0]).textContent", selector)
        .get<std::string>();
  }

  // Not in SetUpTestSuite(): if that fails, GoogleTest reports [  SKIPPED ], which CTest accepts.
  void SetUp() override {
    if (!browser_) {
      browser_ = std::make_unique<Browser>();
    } else {
      browser_->resize(kDesktop);
    }
  }

  void TearDown() override {
    if (!browser_) return;
    if (!HasFailure() && !may_report_errors_) {
      EXPECT_EQ(browser_->console_errors(), std::vector<std::string>{});
    }
    if (!HasFailure()) {
      // A page that stays open reports that its server is gone, perhaps to the next test.
      browser_->open("about:blank");
      return;
    }
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    const std::string path =
        (pictures_dir() / (std::string(test.test_suite_name()) + "." + test.name() + ".png")).string();
    // The next test gets a new browser, since this one may be the cause of the failure.
    const std::unique_ptr<Browser> last = std::move(browser_);
    last->screenshot().save(path);
    std::cout << "Screenshot: " << path << '\n';
  }

  static void TearDownTestSuite() { browser_.reset(); }

  bool may_report_errors_ = false;  // on the console, when the test ends

 private:
  static inline std::unique_ptr<Browser> browser_;
};

}  // namespace buoyancy::view
