// Tests of the search in waves: some cases of the product have no violation, bounds that are too small are
// found, and runs add up. Tests of its oracle: its estimates of its own errors hold.
#include <algorithm>
#include <filesystem>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "tests/random_search/wave_record.h"
#include "tests/stress/stress_case.h"
#include "waves/sea_snapshot.h"

namespace buoyancy {
namespace {

TEST(WaveSearch, FindsNoViolationIn120Cases) {
  const std::int64_t meshes = tries(15);
  const WaveSearchStats stats =
      search_waves(1, 0, meshes * kWaveCasesPerMesh, std::max(1U, std::thread::hardware_concurrency()));
  EXPECT_EQ(stats.cases(), meshes * kWaveCasesPerMesh);
  for (const FailedWaveCase& failure : stats.failures) {
    for (const std::string& violation : failure.violations) {
      ADD_FAILURE() << "case " << failure.number << ": " << violation << "\n" << failure.text;
    }
  }
  const WaveFigures total = stats.total();
  EXPECT_GT(total.force.value, 0.0);
  EXPECT_LE(total.undecided, stats.cases() / 50);
  // A bound that is never approached would pass as well.
  EXPECT_LE(total.ratios.median(), 3000.0);
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
  const WaveSearchStats stats = search_waves(2, 0, 3 * kWaveCasesPerMesh, 1, with_bounds_times(0.01));
  EXPECT_GE(stats.failed_cases, 4);
  ASSERT_FALSE(stats.failures.empty());
  const FailedWaveCase& failure = stats.failures[0];
  EXPECT_NE(failure.violations[0].find("error"), std::string::npos) << failure.violations[0];
  const WaveReplay replayed = replay_wave_case(2, failure.number, with_bounds_times(0.01));
  EXPECT_FALSE(replayed.violations.empty());
  EXPECT_TRUE(replay_wave_case(2, failure.number).violations.empty());
}

TEST(WaveSearch, FindsLoadsOfASeaThatIsLate) {
  const WaveSearchStats stats =
      search_waves(3, 0, 4 * kWaveCasesPerMesh, 1,
                   [](const WaveBody& body, const SeaExpansion& expansion, const SeaSnapshot& sea,
                      const WaveRequest& request) {
                     SeaSnapshot late(sea.sea());
                     late.set_time(request.utime, request.lead_time + 0.1);
                     return wave_load(body, expansion, late, request.pose, request.reference_B);
                   });
  EXPECT_GE(stats.failed_cases, 8);
}

TEST(WaveSearch, FindsNanResult) {
  const WaveSearchStats stats =
      search_waves(4, 0, kWaveCasesPerMesh, 1,
                   [](const WaveBody&, const SeaExpansion&, const SeaSnapshot&, const WaveRequest&) {
                     WaveLoad load;
                     load.torque.x() = std::numeric_limits<double>::quiet_NaN();
                     return load;
                   });
  EXPECT_EQ(stats.failed_cases, kWaveCasesPerMesh);
}

TEST(WaveSearch, IsReproducibleAcrossRunsAndThreads) {
  WaveSearchStats parts = search_waves(5, 0, kWaveCasesPerMesh, 1);
  parts += search_waves(5, kWaveCasesPerMesh, 3 * kWaveCasesPerMesh, 3);
  const WaveSearchStats whole = search_waves(5, 0, 3 * kWaveCasesPerMesh, 2);
  EXPECT_EQ(markdown(parts), markdown(whole));
  EXPECT_EQ(summary(parts), summary(whole));
}

TEST(WaveSearch, SavesRecordsAndAddsSeeds) {
  const std::filesystem::path directory =
      std::filesystem::temp_directory_path() /
      ("buoyancy_wave_search_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()));
  std::filesystem::remove_all(directory);
  EXPECT_EQ(load_wave_stats(directory, 6)->cases(), 0);
  const WaveSearchStats found = search_waves(6, 0, kWaveCasesPerMesh, 1, with_bounds_times(1e-4));
  ASSERT_TRUE(save_wave_stats(directory, 6, found));
  ASSERT_TRUE(save_wave_stats(directory, 7, found));
  const Expected<WaveSearchStats> again = load_wave_stats(directory, 6);
  ASSERT_TRUE(again);
  EXPECT_EQ(summary(*again), summary(found));
  EXPECT_EQ(markdown(*again), markdown(found));
  EXPECT_EQ(again->failures.size(), found.failures.size());
  EXPECT_EQ(load_all_wave_stats(directory)->cases(), 2 * found.cases());
  std::filesystem::remove_all(directory);
}

TEST(RatioHistogram, HasAMedian) {
  RatioHistogram ratios;
  EXPECT_EQ(ratios.median(), 0.0);
  for (const double ratio : {0.5, 10.0, 1000.0, 1e5, std::numeric_limits<double>::infinity()}) {
    ratios.add(ratio);
  }
  EXPECT_NEAR(ratios.median(), 1000.0, 130.0);
}

TEST(ReferenceLoad, IsWithinItsEstimateOfTheError) {
  int compared = 0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(tries(60)); ++seed) {
    RandomPoses random(seed);
    const WaveMesh body = random_wave_mesh(random);
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
