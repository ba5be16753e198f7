#include "tests/random_search/flotation_search.h"

#include <algorithm>
#include <thread>

#include <gtest/gtest.h>

#include "tests/stress/stress_case.h"

namespace buoyancy {
namespace {

TEST(FlotationSearch, FindsOnlyStableEquilibriaOf400RandomBodies) {
  const FlotationSearchStats stats =
      search_flotation(3, 0, tries(400), std::max(1U, std::thread::hardware_concurrency()));
  for (const FailedFlotationCase& failure : stats.failures) {
    ADD_FAILURE() << "case " << failure.number << ": " << failure.violation << "\n"
                  << random_flotation_case(3, failure.number).text();
  }
  EXPECT_EQ(stats.cases, tries(400));
  EXPECT_GT(stats.attitudes, stats.cases);
}

TEST(FlotationSearch, GivesTheSameResultsWithAnyNumberOfThreads) {
  EXPECT_EQ(search_flotation(4, 0, 12, 1).text(), search_flotation(4, 0, 12, 3).text());
}

}  // namespace
}  // namespace buoyancy
