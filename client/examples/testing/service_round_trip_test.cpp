// A test of round trips with the real service, to be copied into a project of your own: a crate at its
// equilibrium draft gets a force that balances its weight, also from a service that loses messages.
//
//   find_package(buoyancy REQUIRED)
//   find_package(GTest REQUIRED)
//   add_executable(service_round_trip_test service_round_trip_test.cpp)
//   target_link_libraries(service_round_trip_test buoyancy::testing buoyancy::client GTest::gtest_main)
//
// buoyancyd is searched for in $PATH; the environment variable BUOYANCYD names another one.
#include <cstdint>
#include <vector>

#include <buoyancy/client/client.h>
#include <buoyancy/testing/service_test.h>
#include <gtest/gtest.h>

namespace {

// A crate of 1 m^3 in fresh water.
constexpr const char* kScene = R"(
[water]
density = 1000.0
[[body]]
id = 1
shape = { type = "box", size = [1, 1, 1] }
)";

class Crate : public buoyancy::testing::ServiceTest {
 protected:
  buoyancy::testing::ServiceOptions service_options() const override {
    buoyancy::testing::ServiceOptions options;
    options.scene_text = kScene;
    return options;
  }
};

TEST_F(Crate, FloatsAtHalfItsHeight) {
  buoyancy::ClientOptions options;
  options.channel.lcm_url = service().lcm_url();
  auto client = buoyancy::Client::open(options);
  ASSERT_TRUE(client) << client.error().message();

  buoyancy::BodyState state;
  state.body_id = 1;
  state.quaternion_wxyz = {1, 0, 0, 0};
  for (std::int64_t step = 0; step < 100; ++step) {
    const auto response = client->request(10'000 * step, std::vector{state});
    ASSERT_TRUE(response) << response.error().message();
    const buoyancy::BodyWrench& wrench = (*response)->bodies[0];
    EXPECT_NEAR(wrench.force[2], 500.0 * 9.80665, wrench.force_error_bound);
  }
}

}  // namespace
