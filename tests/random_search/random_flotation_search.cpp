// random_flotation_search: searches for an attitude that is reported and is no stable equilibrium.
//
//   random_flotation_search [--cases N] [--seed S] [--case K] [--jobs J]
//
// With --case, only this case is searched, and printed. Exit status: 0 if there is no violation; 1 on a
// violation; 2 on invalid arguments.
#include <algorithm>
#include <cstdio>
#include <thread>

#include "cli/progress_bar.h"
#include "cli/tool_command_line.h"
#include "tests/random_search/flotation_search.h"

int main(int argc, char** argv) {
  using namespace buoyancy;
  ToolCommandLine command_line("Search for an attitude that is reported and is no stable equilibrium.",
                               "random_flotation_search");
  std::int64_t cases = 20'000;
  std::uint64_t seed = 1;
  std::int64_t single = -1;
  unsigned jobs = std::max(1U, std::thread::hardware_concurrency());
  command_line.add_positive("--cases", cases, "Number of cases");
  command_line.add_option("--seed", seed, "Seed of the random cases");
  command_line.add_number("--case", single, std::int64_t{0}, std::int64_t{1'000'000'000'000},
                          "Search and print this case alone");
  command_line.add_number("--jobs", jobs, 1U, 1024U, "Threads");
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;

  const std::int64_t begin = std::max<std::int64_t>(single, 0);
  const std::int64_t end = single >= 0 ? single + 1 : cases;
  if (single >= 0) std::printf("%s", random_flotation_case(seed, single).text().c_str());
  FlotationSearchStats stats;
  ProgressBar progress("cases");
  constexpr std::int64_t kBlock = 200;
  for (std::int64_t at = begin; at < end; at += kBlock) {
    const FlotationSearchStats block = search_flotation(seed, at, std::min(at + kBlock, end), jobs);
    if (!block.failures.empty()) progress.clear();
    for (const FailedFlotationCase& failure : block.failures) {
      std::printf("VIOLATION: seed %llu, case %lld: %s\n%s", static_cast<unsigned long long>(seed),
                  static_cast<long long>(failure.number), failure.violation.c_str(),
                  random_flotation_case(seed, failure.number).text().c_str());
    }
    stats += block;
    progress.update(at - begin, end - begin, at - begin);
  }
  progress.clear();
  std::printf("seed %llu: %s, %zu violations\n", static_cast<unsigned long long>(seed), stats.text().c_str(),
              stats.failures.size());
  return stats.failures.empty() ? 0 : 1;
}
