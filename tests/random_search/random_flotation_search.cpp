// random_flotation_search: searches for an attitude that is reported and is no stable equilibrium.
//
//   random_flotation_search [--cases N] [--seed S] [--case K] [--jobs J]
//
// With --case, only this case is searched, and printed. Exit status: 0 if there is no violation; 1 on a
// violation; 2 on invalid arguments.
#include "tests/random_search/flotation_search.h"
#include "tests/random_search/search_program.h"

namespace buoyancy {
namespace {

struct FlotationSearch {
  using Stats = FlotationSearchStats;

  static Stats run(std::uint64_t seed, std::int64_t begin, std::int64_t end, unsigned threads) {
    return search_flotation(seed, begin, end, threads);
  }
  static std::string text(std::uint64_t seed, std::int64_t number) {
    return random_flotation_case(seed, number).text();
  }
  static std::string summary(const Stats& stats, std::uint64_t seed, std::int64_t /*cases*/) {
    return "seed " + std::to_string(seed) + ": " + stats.text();
  }
};

}  // namespace
}  // namespace buoyancy

int main(int argc, char** argv) {
  return buoyancy::run_search_program<buoyancy::FlotationSearch>(
      {.name = "random_flotation_search",
       .description = "Search for an attitude that is reported and is no stable equilibrium.",
       .case_help = "Search and print this case alone"},
      argc, argv);
}
