// random_motion_search: searches for a motion of a body with drag or added mass that gains energy.
//
//   random_motion_search [--cases N] [--seed S] [--case K] [--jobs J]
//
// Ends with a table of the largest rises. With --case, only this case is simulated, and printed. Exit status:
// 0 if there is no violation; 1 on a violation; 2 on invalid arguments.
#include "tests/random_search/motion_search.h"
#include "tests/random_search/search_program.h"

namespace buoyancy {
namespace {

struct MotionSearch {
  using Stats = MotionSearchStats;

  static Stats run(std::uint64_t seed, std::int64_t begin, std::int64_t end, unsigned threads) {
    return search_motions(seed, begin, end, threads);
  }
  static std::string text(std::uint64_t seed, std::int64_t number) {
    return random_motion_case(seed, number).text();
  }
  static std::string summary(const Stats& stats, std::uint64_t seed, std::int64_t cases) {
    return markdown(stats) + "seed " + std::to_string(seed) + ": " + std::to_string(cases) + " cases";
  }
};

}  // namespace
}  // namespace buoyancy

int main(int argc, char** argv) {
  return buoyancy::run_search_program<buoyancy::MotionSearch>(
      {.name = "random_motion_search",
       .description = "Search for a motion with drag or added mass that gains energy.",
       .case_help = "Simulate and print this case alone"},
      argc, argv);
}
