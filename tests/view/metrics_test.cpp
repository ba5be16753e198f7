#include "view/live/metrics.h"

#include <limits>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/contains.h"

namespace buoyancy::view {
namespace {

TEST(Metrics, HaveOneTypeAndOneValueEach) {
  ServiceStatus status;
  status.version = "2.0.0";
  status.scene = "a\\b \"c\"\nd.toml";
  status.instance_id = -5;
  status.scene_fingerprint = std::numeric_limits<std::int64_t>::min();
  status.counters.requests = 1'234'567'890'123;
  status.counters.bodies[1] = 7;
  status.counters.retained_bytes = 99;
  status.latency.p99 = 0.1;
  const std::string text = metrics_text(&status);
  for (const char* line :
       {"buoyancy_up 1\n", "buoyancy_requests_total 1234567890123\n", "buoyancy_bodies_unknown_total 7\n",
        "# TYPE buoyancy_retained_bytes gauge\nbuoyancy_retained_bytes 99\n",
        "buoyancy_latency_p99_seconds 0.1\n", "# TYPE buoyancy_faults_dropped_total counter\n",
        R"(buoyancy_info{version="2.0.0",scene="a\\b \"c\"\nd.toml",injected_faults="",instance_id="-5",)"
        "scene_fingerprint=\"-9223372036854775808\"} 1\n"}) {
    EXPECT_TRUE(contains(text, line)) << text;
  }
  std::set<std::string> names;
  std::istringstream lines(text);
  for (std::string type, value; std::getline(lines, type) && std::getline(lines, value);) {
    ASSERT_EQ(type.rfind("# TYPE buoyancy_", 0), 0U) << type;
    const std::string name = type.substr(7, type.rfind(' ') - 7);
    EXPECT_EQ(value.rfind(name, 0), 0U) << value;
    EXPECT_TRUE(names.insert(name).second) << name;
  }
}

TEST(Metrics, SayThatThereIsNoService) {
  EXPECT_EQ(metrics_text(nullptr), "# TYPE buoyancy_up gauge\nbuoyancy_up 0\n");
  EXPECT_EQ(Metrics().text(), metrics_text(nullptr));
}

}  // namespace
}  // namespace buoyancy::view
