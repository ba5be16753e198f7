#include "client/ping/service_causes.h"

#include <string>

#include <gtest/gtest.h>

#include "tests/ping/two_scenes.h"
#include "tests/support/damaged_boxes.h"
#include "tests/support/scene_of.h"

namespace buoyancy::ping {
namespace {

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

TEST(ServiceCauses, NameWhatStatusTells) {
  const Scene scene = SceneText{}.scene();
  ServiceInfo service;
  EXPECT_TRUE(causes_from_service(scene, service).empty());
  service.status.emplace();
  service.status->version = BUOYANCY_VERSION;
  service.status->scene_bodies = 2;
  EXPECT_TRUE(causes_from_service(scene, service).empty());
  service.status->version = "0.1";
  service.status->scene = "/etc/other.toml";
  service.status->scene_bodies = 3;
  service.instance_ids = {1, 2};
  const std::string found = joined(causes_from_service(scene, service));
  for (const char* const part : {"2 services", "/etc/other.toml with 3 bodies", "version 0.1"}) {
    EXPECT_NE(found.find(part), std::string::npos) << part << "\n" << found;
  }
}

TEST(ServiceCauses, CompareSeasOfBothSides) {
  SceneText text;
  text.water = kWaves;
  text.tolerance = "0.001";
  const Scene scene = text.scene();
  ServiceInfo service;
  service.sea = to_sea_state(*scene.sea(), 5);
  EXPECT_TRUE(causes_from_service(scene, service).empty());
  service.sea->level = 0.25;
  service.sea->current[1] = 1.5;
  service.sea->amplitude[0] *= 2.0;
  const std::string found = joined(causes_from_service(scene, service));
  EXPECT_NE(found.find("another level: 0.25 instead of 0 m"), std::string::npos) << found;
  EXPECT_NE(found.find("another current: 1.5 instead of 0 m/s"), std::string::npos) << found;
  EXPECT_NE(found.find("other waves"), std::string::npos) << found;
}

TEST(ServiceCauses, NameConditionsThatTheServiceReceived) {
  const Scene scene = scene_of(damaged_boxes());
  ServiceInfo service;
  service.status.emplace();
  service.status->version = BUOYANCY_VERSION;
  service.status->scene_bodies = 3;
  EXPECT_TRUE(causes_from_service(scene, service).empty());
  service.status->counters.conditions_received = 2;
  EXPECT_NE(joined(causes_from_service(scene, service)).find("has received 2 conditions"), std::string::npos);
}

TEST(ServiceCauses, DistinguishSilentServiceFromNone) {
  ServiceInfo service;
  const std::string local = "udpm://239.255.76.67:7667?ttl=0";
  EXPECT_NE(cause_of_silence({}, local, service).find("needs ttl=1"), std::string::npos);
  const std::string remote = cause_of_silence({}, "udpm://239.255.76.67:7667?ttl=1", service);
  EXPECT_EQ(remote.find("ttl=1"), std::string::npos) << remote;
  EXPECT_NE(remote.find("not running"), std::string::npos) << remote;
  service.status.emplace();
  service.status->scene = "/etc/other.toml";
  const std::string silent = cause_of_silence({}, local, service);
  EXPECT_NE(silent.find("a service runs here (scene /etc/other.toml"), std::string::npos) << silent;
}

}  // namespace
}  // namespace buoyancy::ping
