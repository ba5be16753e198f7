// Tests of the search itself: it finds and shrinks defects, and runs add up; 20,000 cases of the product have
// no violation.
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "tests/random_search/search_record.h"
#include "tests/random_search/shrink.h"

namespace buoyancy {
namespace {

#ifdef __SANITIZE_THREAD__
constexpr std::int64_t kCases = 10 * kRequestsPerMesh;
#else
constexpr std::int64_t kCases = 625 * kRequestsPerMesh;  // 20,000
#endif

TEST(RandomSearch, FindsNoViolationIn20000Cases) {
  const SearchStats stats = search(1, 0, kCases, std::max(1U, std::thread::hardware_concurrency()));
  EXPECT_EQ(stats.cases, kCases);
  EXPECT_GE(stats.results, 7 * kCases);
  for (const FailedCase& failure : stats.failures) {
    for (const std::string& violation : failure.violations)
      ADD_FAILURE() << "case " << failure.number << ", " << failure.mesh << ": " << violation;
  }
}

// A wrong result, off by four force error bounds, where about half of the body is submerged.
std::vector<GivenResult> broken_results(const HydrostaticMesh& mesh, const SearchPose& requested) {
  BuoyancyResult result =
      buoyancy(Solver(mesh, Method::kExact), requested.pose, requested.water, requested.reference_B);
  if (result.volume > 0.4 * mesh.volume && result.volume < 0.6 * mesh.volume)
    result.force_W += 4.0 * result.force_error_bound * requested.water.up_W;
  return {{Evaluator::kExact, "", result}};
}

TEST(RandomSearch, FindsAndShrinksInaccurateResult) {
  const SearchStats stats = search(2, 0, 8 * kRequestsPerMesh, broken_results);
  ASSERT_GT(stats.failed_cases, 0);
  ASSERT_FALSE(stats.failures.empty());
  EXPECT_GT(stats.largest[0][0].value, 3.0);
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
  EXPECT_NE(text.find("TEST(FoundBySearch, Seed2Case" + std::to_string(number)), std::string::npos) << text;
}

TEST(RandomSearch, FindsNanResult) {
  const SearchStats stats = search(3, 0, kRequestsPerMesh, [](const HydrostaticMesh&, const SearchPose&) {
    BuoyancyResult result;
    result.torque_W.x() = std::numeric_limits<double>::quiet_NaN();
    return std::vector<GivenResult>{{Evaluator::kFast, "", result}};
  });
  EXPECT_EQ(stats.failed_cases, kRequestsPerMesh);
}

TEST(RandomSearch, IsReproducibleAcrossRunsAndThreads) {
  SearchStats parts = search(4, 0, 2 * kRequestsPerMesh, 1);
  parts += search(4, 2 * kRequestsPerMesh, 5 * kRequestsPerMesh, 3);
  const SearchStats whole = search(4, 0, 5 * kRequestsPerMesh, 2);
  EXPECT_EQ(parts.cases, whole.cases);
  EXPECT_EQ(parts.results, whole.results);
  EXPECT_EQ(markdown(parts), markdown(whole));
  for (std::size_t row = 0; row < whole.largest.size(); ++row) {
    for (std::size_t column = 0; column < whole.largest[row].size(); ++column)
      EXPECT_EQ(parts.largest[row][column].at, whole.largest[row][column].at);
  }
}

TEST(RandomSearch, SavesRecordsAndAddsSeeds) {
  const std::filesystem::path directory =
      std::filesystem::temp_directory_path() /
      ("buoyancy_search_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()));
  std::filesystem::remove_all(directory);
  EXPECT_EQ(load_stats(directory, 5)->cases, 0);
  const SearchStats found = search(5, 0, 2 * kRequestsPerMesh, broken_results);
  ASSERT_TRUE(save_stats(directory, 5, found));
  ASSERT_TRUE(save_stats(directory, 6, found));
  const Expected<SearchStats> again = load_stats(directory, 5);
  ASSERT_TRUE(again);
  EXPECT_EQ(summary(*again), summary(found));
  EXPECT_EQ(markdown(*again), markdown(found));
  EXPECT_EQ(load_all(directory)->cases, 2 * found.cases);
  std::filesystem::remove_all(directory);
}

}  // namespace
}  // namespace buoyancy
