#include "client/ping/service_causes.h"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "scene/scene_fingerprint.h"
#include "tests/ping/two_scenes.h"
#include "tests/support/contains.h"
#include "tests/support/damaged_boxes.h"
#include "tests/support/scene_of.h"

namespace buoyancy::ping {
namespace {

TEST(ServiceCauses, NameWhatStatusTells) {
  const Scene scene = SceneText{}.scene();
  ServiceInfo service;
  EXPECT_TRUE(causes_from_service(scene, service).empty());
  service.status.emplace();
  service.status->version = BUOYANCY_VERSION;
  service.status->scene_bodies = 2;
  service.status->scene_fingerprint = scene_fingerprint(scene);
  service.instance_ids = {1};
  EXPECT_TRUE(service_warnings(scene, service).empty());
  EXPECT_TRUE(causes_from_service(scene, service).empty());
  service.status->version = "0.1";
  service.status->scene = "/etc/other.toml";
  service.status->scene_bodies = 3;
  service.instance_ids = {1, 2};
  const std::string found = joined(causes_from_service(scene, service));
  for (const char* const part : {"2 services", "/etc/other.toml with 3 bodies", "version 0.1"}) {
    EXPECT_TRUE(contains(found, part));
  }
}

TEST(ServiceWarnings, NameEachThingThatAUserHasToKnow) {
  const Scene scene = SceneText{}.scene();
  using Change = std::pair<const char*, std::function<void(ServiceInfo&)>>;
  for (const auto& [text, change] : std::initializer_list<Change>{
           {"1 other service on the channel of its status",
            [](ServiceInfo& now) {
              now.instance_ids = {1, 2};
            }},
           {"2 other services", [](ServiceInfo& now) { now.status->other_services = 2; }},
           {"its scene  is not that of", [](ServiceInfo& now) { ++now.status->scene_fingerprint; }},
           {"2 velocities that contradict the motion",
            [](ServiceInfo& now) { now.status->counters.motions_contradicting = 2; }},
           {"1 session with quaternions that look like x, y, z, w",
            [](ServiceInfo& now) { now.status->counters.quaternions_xyzw = 1; }}}) {
    ServiceInfo service;
    service.status.emplace();
    service.status->scene_fingerprint = scene_fingerprint(scene);
    service.instance_ids = {1};
    change(service);
    const std::vector<Warning> warnings = service_warnings(scene, service);
    ASSERT_EQ(warnings.size(), 1U) << text;
    EXPECT_TRUE(contains(warnings[0].message(), text));
  }
}

TEST(ServiceCauses, CompareSeasOfBothSides) {
  SceneText text;
  text.water = kWaves;
  text.tolerance = "0.001";
  const Scene scene = text.scene();
  const auto causes_after = [&](const std::function<void(SeaState&)>& change) {
    ServiceInfo service;
    service.sea = to_sea_state(*scene.sea(), 5);
    change(*service.sea);
    return joined(causes_from_service(scene, service));
  };
  EXPECT_EQ(causes_after([](SeaState&) {}), "");
  EXPECT_EQ(causes_after([](SeaState& sea) { sea.gravity *= 1.0 + 1e-13; }), "") << "rounding";
  using Change = std::pair<const char*, std::function<void(SeaState&)>>;
  for (const auto& [cause, change] : std::initializer_list<Change>{
           {"another level: 0.25 instead of 0 m", [](SeaState& sea) { sea.level = 0.25; }},
           {"another depth: 7.5 instead of inf m", [](SeaState& sea) { sea.depth = 7.5; }},
           {"another gravity: 9.7 instead of 9.80665 m/s^2", [](SeaState& sea) { sea.gravity = 9.7; }},
           {"another ramp: 20 instead of 0 s", [](SeaState& sea) { sea.ramp = 20.0; }},
           {"another time_origin: 7 instead of 0 us", [](SeaState& sea) { sea.time_origin = 7; }},
           {"another current: 1.5 instead of 0 m/s", [](SeaState& sea) { sea.current[0] = 1.5; }},
           {"another current: -1.5 instead of 0 m/s", [](SeaState& sea) { sea.current[1] = -1.5; }},
           {"another current: 2.5 instead of 0 m/s", [](SeaState& sea) { sea.current[2] = 2.5; }},
           {"another wave_pressure", [](SeaState& sea) { sea.wave_pressure ^= 1; }},
           {"other waves: 1 component against 1", [](SeaState& sea) { sea.amplitude[0] *= 2.0; }},
           {"other waves: 1 component", [](SeaState& sea) { sea.angular_frequency[0] *= 2.0; }},
           {"other waves: 1 component", [](SeaState& sea) { sea.direction[0] += 0.5; }},
           {"other waves: 1 component", [](SeaState& sea) { sea.phase[0] += 0.5; }}}) {
    const std::string found = causes_after(change);
    EXPECT_TRUE(contains(found, cause));
    EXPECT_EQ(std::ranges::count(found, '\n'), 1) << found;
  }
}

TEST(ServiceCauses, NameConditionsThatTheServiceReceived) {
  const Scene scene = scene_of(damaged_boxes());
  ServiceInfo service;
  service.status.emplace();
  service.status->version = BUOYANCY_VERSION;
  service.status->scene_bodies = 3;
  service.status->scene_fingerprint = scene_fingerprint(scene);
  EXPECT_TRUE(causes_from_service(scene, service).empty());
  service.status->counters.conditions_received = 2;
  EXPECT_TRUE(contains(joined(causes_from_service(scene, service)), "has received 2 conditions"));
}

TEST(ServiceCauses, DistinguishSilentServiceFromNone) {
  ServiceInfo service;
  const std::string local = "udpm://239.255.76.67:7667?ttl=0";
  EXPECT_TRUE(contains(cause_of_silence({}, local, service), "needs ttl=1"));
  const std::string remote = cause_of_silence({}, "udpm://239.255.76.67:7667?ttl=1", service);
  EXPECT_FALSE(contains(remote, "ttl=1"));
  EXPECT_TRUE(contains(remote, "not running"));
  service.status.emplace();
  service.status->scene = "/etc/other.toml";
  const std::string silent = cause_of_silence({}, local, service);
  EXPECT_TRUE(contains(silent, "a service runs here (scene /etc/other.toml"));
}

}  // namespace
}  // namespace buoyancy::ping
