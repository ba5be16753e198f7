// A GoogleTest fixture with a running buoyancyd. It includes GoogleTest, which the test links.
//
//   class FloatingBox : public buoyancy::testing::ServiceTest {
//    protected:
//     buoyancy::testing::ServiceOptions service_options() const override {
//       buoyancy::testing::ServiceOptions options;
//       options.scene = "scenes/box.toml";
//       return options;
//     }
//   };
//   TEST_F(FloatingBox, ComesToRest) { ... service().lcm_url() ... }
#pragma once

#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "testing/service_process.h"

namespace buoyancy::testing {

// Each test starts a service and stops it at its end. A test that failed reports the log of the service.
class ServiceTest : public ::testing::Test {
 protected:
  // Returns what to start.
  virtual ServiceOptions service_options() const = 0;

  // Precondition: SetUp() has not failed.
  ServiceProcess& service() { return *service_; }

  void SetUp() override {
    Expected<ServiceProcess> started = ServiceProcess::start(service_options());
    ASSERT_TRUE(started) << started.error().message();
    service_.emplace(*std::move(started));
  }

  void TearDown() override {
    if (!service_) return;
    const int exit_code = service_->stop();
    EXPECT_EQ(exit_code, 0) << "buoyancyd ended with this exit code";
    // The log is a failure of its own, so that reports in files contain it too.
    if (HasFailure()) ADD_FAILURE() << "The log of buoyancyd:\n" << service_->log();
  }

 private:
  std::optional<ServiceProcess> service_;
};

}  // namespace buoyancy::testing
