// The command line and the loop of a random search that keeps no record.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <thread>

#include "cli/progress_bar.h"
#include "cli/tool_command_line.h"

namespace buoyancy {

struct SearchProgram {
  const char* name;
  const char* description;
  const char* case_help;  // of --case
};

// Parses --cases, --seed, --case and --jobs, and searches block by block. A search has
//   Stats: with operator+= and `failures`, each with its `number` and `violation`;
//   static Stats run(seed, begin, end, threads);
//   static std::string text(seed, number);             describes a case
//   static std::string summary(stats, seed, cases);    without the number of violations
// Returns the exit code: 0 if there is no violation; 1 on a violation; 2 on invalid arguments.
template <typename Search>
int run_search_program(const SearchProgram& program, int argc, char** argv) {
  ToolCommandLine command_line(program.description, program.name);
  std::int64_t cases = 20'000;
  std::uint64_t seed = 1;
  std::int64_t single = -1;
  unsigned jobs = std::max(1U, std::thread::hardware_concurrency());
  command_line.add_positive("--cases", cases, "Number of cases");
  command_line.add_option("--seed", seed, "Seed of the random cases");
  command_line.add_number("--case", single, std::int64_t{0}, std::int64_t{1'000'000'000'000},
                          program.case_help);
  command_line.add_number("--jobs", jobs, 1U, 1024U, "Threads");
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;

  const std::int64_t begin = std::max<std::int64_t>(single, 0);
  const std::int64_t end = single >= 0 ? single + 1 : cases;
  if (single >= 0) std::printf("%s", Search::text(seed, single).c_str());
  typename Search::Stats stats;
  ProgressBar progress("cases");
  constexpr std::int64_t kBlock = 200;
  for (std::int64_t at = begin; at < end; at += kBlock) {
    const typename Search::Stats block = Search::run(seed, at, std::min(at + kBlock, end), jobs);
    if (!block.failures.empty()) progress.clear();
    for (const auto& failure : block.failures) {
      std::printf("VIOLATION: seed %llu, case %lld: %s\n%s", static_cast<unsigned long long>(seed),
                  static_cast<long long>(failure.number), failure.violation.c_str(),
                  Search::text(seed, failure.number).c_str());
    }
    stats += block;
    progress.update(at - begin, end - begin, at - begin);
  }
  progress.clear();
  std::printf("%s, %zu violations\n", Search::summary(stats, seed, end - begin).c_str(),
              stats.failures.size());
  return stats.failures.empty() ? 0 : 1;
}

}  // namespace buoyancy
