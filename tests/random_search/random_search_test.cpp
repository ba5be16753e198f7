// Tests of the random searches: cases of the product have no violation, runs add up, and what is wrong is
// found. Tests of their oracle: its estimates of its own errors hold.
#include <algorithm>
#include <limits>
#include <ostream>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "tests/random_search/flotation_search.h"
#include "tests/random_search/motion_search.h"
#include "tests/random_search/search.h"
#include "tests/random_search/shrink.h"
#include "tests/random_search/wave_search.h"
#include "tests/stress/stress_case.h"
#include "tests/support/contains.h"
#include "tests/truth/reference_load.h"
#include "waves/sea_snapshot.h"

namespace buoyancy {
namespace {

struct TestedSearch {
  std::string name;
  RandomSearch search;
  std::uint64_t seed;
  std::int64_t cases;
};

void PrintTo(const TestedSearch& tested, std::ostream* out) {
  *out << tested.name;
}

class RandomSearches : public testing::TestWithParam<TestedSearch> {};

INSTANTIATE_TEST_SUITE_P(, RandomSearches,
                         testing::Values(TestedSearch{"still_water", still_water_search(), 1, 20'000},
                                         TestedSearch{"waves", wave_search(), 1, 120},
                                         TestedSearch{"motion", motion_search(), 3, 200},
                                         TestedSearch{"flotation", flotation_search(), 3, 400}),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(RandomSearches, FindNoViolation) {
  const RandomSearch& search = GetParam().search;
  const std::int64_t cases = tries(static_cast<int>(GetParam().cases / search.unit)) * search.unit;
  const SearchStats stats =
      search.run(GetParam().seed, 0, cases, std::max(1U, std::thread::hardware_concurrency()));
  EXPECT_EQ(stats.cases, cases);
  for (const SearchFailure& failure : stats.failures) {
    ADD_FAILURE() << "case " << failure.number << ": " << failure.violations.front() << "\n" << failure.text;
  }
  const SearchFigures total = stats.total();
  for (const auto& [what, found] : total.largest) EXPECT_GT(found.value, 0.0) << what;
  // Truth that is not known would pass as well, and a bound that is never approached.
  EXPECT_LE(total.count("undecided"), cases / 50);
  EXPECT_LE(total.median_ratio(), 3000.0);
}

TEST_P(RandomSearches, AreReproducibleAcrossRunsAndThreads) {
  const RandomSearch& search = GetParam().search;
  SearchStats parts = search.run(4, 0, 2 * search.unit, 1);
  parts += search.run(4, 2 * search.unit, 5 * search.unit, 3);
  const SearchStats whole = search.run(4, 0, 5 * search.unit, 2);
  EXPECT_EQ(parts.cases, 5 * search.unit);
  EXPECT_EQ(search.table(parts), search.table(whole));
  EXPECT_EQ(search.summary(parts), search.summary(whole));
  const SearchFailure again = search.replay(4, search.unit);
  EXPECT_TRUE(again.violations.empty());
  EXPECT_FALSE(again.text.empty());
}

TEST(SearchFigures, HaveAMedianRatio) {
  SearchFigures figures;
  EXPECT_EQ(figures.median_ratio(), 0.0);
  for (const double ratio : {0.5, 10.0, 1000.0, 1e5, std::numeric_limits<double>::infinity()}) {
    figures.add_ratio(ratio);
  }
  EXPECT_NEAR(figures.median_ratio(), 1000.0, 130.0);
}

// A wrong result, off by four force error bounds, where about half of the body is submerged.
std::vector<GivenResult> broken_results(const HydrostaticMesh& mesh, const SearchPose& requested) {
  BuoyancyResult result = result_of(Evaluator::kExact, mesh, requested);
  if (result.volume > 0.4 * mesh.volume && result.volume < 0.6 * mesh.volume)
    result.force_W += 4.0 * result.force_error_bound * requested.water.up_W;
  return {{Evaluator::kExact, "", result}};
}

TEST(StillWaterSearch, FindsAndShrinksInaccurateResult) {
  const SearchStats stats = search(2, 0, 8 * kRequestsPerMesh, broken_results);
  ASSERT_GT(stats.failed_cases, 0);
  ASSERT_FALSE(stats.failures.empty());
  EXPECT_GT(stats.total().most("force / gate"), 3.0);
  const std::int64_t number = stats.failures[0].number;
  const SearchCase found = search_case(2, number);
  const auto still_fails = [](const TriangleMesh& mesh, const SearchPose& requested) {
    return fails(mesh, requested, broken_results);
  };
  ASSERT_TRUE(still_fails(found.mesh, found.requested));
  const SearchCase small = shrunk(found, still_fails);
  EXPECT_TRUE(still_fails(small.mesh, small.requested));
  EXPECT_LE(small.mesh.triangles.size(), 8U);
  const std::string text = as_test(small, 2, number);
  EXPECT_TRUE(contains(text, "TEST(FoundBySearch, Seed2Case" + std::to_string(number)));
}

TEST(StillWaterSearch, FindsNanResult) {
  const SearchStats stats = search(3, 0, kRequestsPerMesh, [](const HydrostaticMesh&, const SearchPose&) {
    BuoyancyResult result;
    result.torque_W.x() = std::numeric_limits<double>::quiet_NaN();
    return std::vector<GivenResult>{{Evaluator::kFast, "", result}};
  });
  EXPECT_EQ(stats.failed_cases, kRequestsPerMesh);
}

// The product's loads, with bounds that are too small by this factor.
EvaluateWaves with_bounds_times(double factor) {
  return [factor](const WaveBody& body, const SeaExpansion& expansion, const SeaSnapshot& sea,
                  const WaveRequest& request) {
    WaveLoad load = product_load(body, expansion, sea, request);
    load.force_bound *= factor;
    load.torque_bound *= factor;
    load.volume_bound *= factor;
    return load;
  };
}

TEST(WaveSearch, FindsBoundsTooSmallByAHundred) {
  const SearchStats stats = search_waves(2, 0, 3 * kWaveCasesPerMesh, 1, with_bounds_times(0.01));
  EXPECT_GE(stats.failed_cases, 4);
  ASSERT_FALSE(stats.failures.empty());
  const SearchFailure& failure = stats.failures[0];
  EXPECT_TRUE(contains(failure.violations[0], "error"));
  EXPECT_FALSE(replay_wave_case(2, failure.number, with_bounds_times(0.01)).violations.empty());
  EXPECT_TRUE(replay_wave_case(2, failure.number, product_load).violations.empty());
}

TEST(WaveSearch, FindsLoadsOfASeaThatIsLateAndNan) {
  const SearchStats late = search_waves(3, 0, 4 * kWaveCasesPerMesh, 1,
                                        [](const WaveBody& body, const SeaExpansion& expansion,
                                           const SeaSnapshot& sea, const WaveRequest& request) {
                                          SeaSnapshot later(sea.sea());
                                          later.set_time(request.utime, request.lead_time + 0.1);
                                          return product_load(body, expansion, later, request);
                                        });
  EXPECT_GE(late.failed_cases, 8);
  const SearchStats nan =
      search_waves(4, 0, kWaveCasesPerMesh, 1,
                   [](const WaveBody&, const SeaExpansion&, const SeaSnapshot&, const WaveRequest&) {
                     WaveLoad load;
                     load.torque.x() = std::numeric_limits<double>::quiet_NaN();
                     return load;
                   });
  EXPECT_EQ(nan.failed_cases, kWaveCasesPerMesh);
}

TEST(MotionSearch, DrawsBodiesOfBothKindsWithinTheirLimits) {
  double heaviest = 0.0;
  for (std::int64_t number = 0; number < 40; ++number) {
    const MotionCase motion = random_motion_case(5, number);
    EXPECT_EQ(motion.kind, number % 2 == 0 ? MotionKind::kSubmerged : MotionKind::kPiercing);
    EXPECT_LE(motion.options.step, 0.1);
    const Scene scene = Scene::prepare(motion.scene).value();
    const BodyDescription& body = motion.scene.bodies.front();
    const RigidBody rigid = make_rigid_body(scene.bodies().front(), scene.water()).value();
    if (body.added_mass) heaviest = std::max(heaviest, body.added_mass->matrix(0, 0) / rigid.mass);
  }
  EXPECT_GT(heaviest, 5.0);
  EXPECT_LE(heaviest, 50.0);
}

TEST(ReferenceLoad, IsWithinItsEstimateOfTheError) {
  int compared = 0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(tries(60)); ++seed) {
    RandomPoses random(seed);
    const WaveSearchBody body = random_wave_mesh(random);
    const WaveRequest request = random_wave_request(body, random);
    const Sea sea = Sea::make(request.description, request.water).value();
    const ReferenceSea reference(sea, request.utime, request.lead_time, request.pose, body.mesh.center_B);
    const auto load = [&](double accuracy) {
      const double force = accuracy * body.mesh.volume;
      return reference_load(body.source_B, body.mesh.center_B, reference, request.reference_B,
                            {.force_error = force,
                             .torque_error = force * body.mesh.max_lever_arm(request.reference_B),
                             .volume_error = force});
    };
    const ReferenceLoad coarse = load(1e-2);
    const ReferenceLoad fine = load(1e-5);
    if (!fine.resolved) continue;
    ++compared;
    EXPECT_LE((coarse.force - fine.force).norm(), coarse.force_error + fine.force_error) << describe(request);
    EXPECT_LE((coarse.torque - fine.torque).norm(), coarse.torque_error + fine.torque_error)
        << describe(request);
    EXPECT_LE(std::abs(coarse.volume - fine.volume), coarse.volume_error + fine.volume_error)
        << describe(request);
  }
  EXPECT_GE(compared, tries(60) * 3 / 4);
}

}  // namespace
}  // namespace buoyancy
