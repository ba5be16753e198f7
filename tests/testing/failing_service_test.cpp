// A test of a user that fails, and one whose service has died.

#include <gtest/gtest.h>
#include <signal.h>

#include "testing/service_test.h"
#include "tests/support/timeouts.h"

namespace {

class FailingService : public buoyancy::testing::ServiceTest {
 protected:
  buoyancy::testing::ServiceOptions service_options() const override {
    buoyancy::testing::ServiceOptions options;
    options.scene_text = "[[body]]\nid = 1\nshape = { type = \"box\", size = [1, 1, 1] }\n";
    options.ready_timeout = buoyancy::kWaitTimeout;
    return options;
  }
};

TEST_F(FailingService, Fails) {
  FAIL() << "as a user's test may";
}

TEST_F(FailingService, HasDied) {
  EXPECT_EQ(kill(service().pid(), SIGKILL), 0);
}

}  // namespace
