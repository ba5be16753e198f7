// For tests of pages, as `class TheReport : public PageTest {};`: one browser for all tests of a program, a
// desktop's screen at the start of each, and what was on the screen of a test that failed.
#pragma once

#include <iostream>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "tests/view/browser.h"

namespace buoyancy::view {

class PageTest : public testing::Test {
 protected:
  static Browser& browser() { return *browser_; }

  // Not in SetUpTestSuite(): where that fails, GoogleTest says [  SKIPPED ], which CTest takes for a test
  // that may be.
  void SetUp() override {
    if (!browser_) {
      browser_ = std::make_unique<Browser>();
    } else {
      browser_->resize(kDesktop);
    }
  }

  void TearDown() override {
    if (!HasFailure() || !browser_) return;
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    const std::string path =
        std::string(BUOYANCY_PICTURES) + "/" + test.test_suite_name() + "." + test.name() + ".png";
    // The next test gets a browser of its own: this one may be what failed.
    const std::unique_ptr<Browser> last = std::move(browser_);
    last->screenshot().save(path);
    std::cout << "What was on the screen: " << path << '\n';
  }

  static void TearDownTestSuite() { browser_.reset(); }

 private:
  static inline std::unique_ptr<Browser> browser_;
};

}  // namespace buoyancy::view
