#include "client/ping/response_checks.h"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "tests/ping/two_scenes.h"
#include "tests/support/contains.h"

namespace buoyancy::ping {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Compares one reply, in which the first body is surface-piercing, after `change` was applied to it.
class ChangedReply {
 public:
  explicit ChangedReply(const SceneText& text = {}) : scene_(text.scene()), handler_(scene_) {
    make_states(scene_, {scene_.water().level, 0.0}, 1, 0, states_);
    expected_ = reply_of(handler_, request_id(0), states_);
  }

  ResponseChecks compare(const std::function<void(WrenchResponse&)>& change) const {
    return compare_after(&Reply::wrenches, change);
  }
  ResponseChecks compare_loads_after(const std::function<void(BodiesLoads&)>& change) const {
    return compare_after(&Reply::loads, change);
  }

  const Scene& scene() const { return scene_; }

 private:
  template <typename Message>
  ResponseChecks compare_after(ByteVector Reply::*bytes, const std::function<void(Message&)>& change) const {
    Reply reply = received(expected_);
    auto message = decoded<Message>(reply.*bytes);
    change(message);
    encode(message, reply.*bytes);
    ResponseChecks checks(scene_);
    checks.add(request_id(0), states_, expected_, reply);
    return checks;
  }

  Scene scene_;
  RequestHandler handler_;
  std::vector<BodyState> states_;
  ExpectedReply expected_;
};

// The checks of the first body that failed.
std::vector<Check> failed_checks(const ResponseChecks& checks) {
  std::vector<Check> failed;
  for (const Check check : kAllChecks) {
    if (checks.bodies()[0].at(check).failed > 0) failed.push_back(check);
  }
  return failed;
}

TEST(ResponseChecks, PassIdenticalReply) {
  const ResponseChecks checks = ChangedReply().compare([](WrenchResponse&) {});
  EXPECT_TRUE(checks.all_passed());
  EXPECT_EQ(checks.replies(), 1);
  EXPECT_EQ(checks.identical(), 1);
  EXPECT_TRUE(checks.differing().empty());
}

TEST(ResponseChecks, AllowSumOfBothBoundsAndNoMore) {
  SceneText text;
  text.tolerance = "0.01";
  const ChangedReply reply(text);
  const double weight = reply.scene().water().density * reply.scene().water().gravity;
  for (const double factor : {0.9, 1.1, -0.9, -1.1}) {
    std::vector<std::pair<Check, std::function<void(BodyWrench&)>>> changes{
        {Check::kVolume,
         [&](BodyWrench& w) { w.submerged_volume += factor * 2.0 * w.force_error_bound / weight; }}};
    for (const std::size_t axis : {0U, 1U, 2U}) {
      changes.emplace_back(Check::kForce,
                           [=](BodyWrench& w) { w.force[axis] += factor * 2.0 * w.force_error_bound; });
      changes.emplace_back(Check::kTorque,
                           [=](BodyWrench& w) { w.torque[axis] += factor * 2.0 * w.torque_error_bound; });
      changes.emplace_back(Check::kCenter, [=](BodyWrench& w) {
        const double force = std::hypot(w.force[0], w.force[1], w.force[2]);
        w.center_of_buoyancy[axis] += factor * 4.0 * w.torque_error_bound / force;
      });
    }
    for (const auto& [check, change] : changes) {
      const ResponseChecks checks =
          reply.compare([&apply = change](WrenchResponse& response) { apply(response.bodies[0]); });
      EXPECT_EQ(checks.identical(), 0);
      const bool allowed = std::abs(factor) < 1.0;
      EXPECT_EQ(failed_checks(checks), allowed ? std::vector<Check>{} : std::vector<Check>{check})
          << to_string(check) << " at " << factor;
      EXPECT_EQ(checks.all_passed(), allowed);
    }
  }
}

TEST(ResponseChecks, FailOnStatusNanAndZeros) {
  const ChangedReply reply;
  const auto failed_after = [&reply](const std::function<void(BodyWrench&)>& change) {
    return failed_checks(reply.compare([&](WrenchResponse& response) { change(response.bodies[0]); }));
  };
  EXPECT_EQ(failed_after([](BodyWrench& w) { w.status = BodyStatus::kUnknownBody; }),
            std::vector<Check>{Check::kStatus});
  EXPECT_EQ(failed_after([](BodyWrench& w) { w.force[0] = kNan; }), std::vector<Check>{Check::kForce});
  EXPECT_EQ(failed_after([](BodyWrench& w) { w.submerged_volume = kNan; }),
            std::vector<Check>{Check::kVolume});
  EXPECT_EQ(failed_after([](BodyWrench& w) { w.force_error_bound = kNan; }),
            (std::vector<Check>{Check::kForce}));
  EXPECT_EQ(failed_after([](BodyWrench& w) { w.center_of_buoyancy = {}; }),
            std::vector<Check>{Check::kCenter});
}

TEST(ResponseChecks, FailOnOtherIdsBodiesAndOrder) {
  const ChangedReply reply;
  const std::vector<std::function<void(WrenchResponse&)>> changes{
      [](WrenchResponse& response) { ++response.id.utime; },
      [](WrenchResponse& response) { response.bodies.pop_back(); },
      [](WrenchResponse& response) { response.bodies[1].body_id = 8; },
      [](WrenchResponse& response) { std::swap(response.bodies[0], response.bodies[1]); }};
  for (const auto& change : changes) {
    const ResponseChecks checks = reply.compare(change);
    EXPECT_EQ(checks.wrong_ids(), 1);
    EXPECT_FALSE(checks.all_passed());
    EXPECT_TRUE(contains(checks.first_wrong_ids(), "bodies 1 7"));
  }
}

TEST(ResponseChecks, CompareLoads) {
  SceneText text;
  text.body = kDrag;
  text.outputs = kWithLoads;
  const ChangedReply reply(text);
  EXPECT_TRUE(reply.compare_loads_after([](BodiesLoads&) {}).all_passed());
  const ResponseChecks checks =
      reply.compare_loads_after([](BodiesLoads& loads) { loads.bodies[0].damping[2][2] *= 1.001; });
  EXPECT_EQ(failed_checks(checks), std::vector<Check>{Check::kLoads});
  EXPECT_TRUE(checks.only_motion_loads_differ());
  EXPECT_TRUE(contains(checks.bodies()[0].at(Check::kLoads).failure, "damping"));
}

// Other methods and tolerances agree within their bounds, in waves as well.
TEST(ResponseChecks, PassOtherMethodsAndTolerances) {
  for (const char* const method : {"exact", "fast", "improved", "fast_surface", "exact_surface"}) {
    SceneText other;
    other.method = method;
    EXPECT_TRUE(compare_scenes(SceneText{}.scene(), other.scene()).all_passed()) << method;
  }
  SceneText coarse;
  coarse.tolerance = "0.01";
  EXPECT_TRUE(compare_scenes(SceneText{}.scene(), coarse.scene()).all_passed());
  EXPECT_TRUE(compare_scenes(coarse.scene(), SceneText{}.scene()).all_passed());
  SceneText waves;
  waves.water = kWaves;
  waves.tolerance = "0.001";
  coarse.water = kWaves;
  EXPECT_TRUE(compare_scenes(waves.scene(), coarse.scene()).all_passed());
  EXPECT_TRUE(compare_scenes(coarse.scene(), waves.scene()).all_passed());
}

}  // namespace
}  // namespace buoyancy::ping
