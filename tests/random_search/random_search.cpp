// random_search: searches for a case that violates a rule.
//
//   random_search [--waves | --motion | --flotation] [--cases N] [--first K] [--seed S] [--case K] [--jobs J]
//                 [--table]
//
// Evaluates N cases from the first on; Ctrl-C stops between blocks without losing results. Violations are
// printed with all that is known about their cases. With --case, only this case is evaluated and printed. The
// last line is a summary. Exit status: 0 if there is no violation; 1 on a violation; 2 on invalid arguments.
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <thread>

#include "cli/progress_bar.h"
#include "cli/tool_command_line.h"
#include "tests/random_search/flotation_search.h"
#include "tests/random_search/motion_search.h"
#include "tests/random_search/search.h"
#include "tests/random_search/wave_search.h"

namespace {

using namespace buoyancy;

constexpr int kViolationFound = 1;
constexpr int kUsageError = 2;
constexpr std::int64_t kBlock = 256;  // cases, at least; a run stops between blocks

volatile std::sig_atomic_t stop_requested = 0;

int report_usage_error(const Error& error) {
  std::fprintf(stderr, "random_search: %s\n", error.message().c_str());
  return kUsageError;
}

// Evaluates and prints a case. Returns the exit code.
int print_case(const RandomSearch& search, std::uint64_t seed, std::int64_t number) {
  const SearchFailure found = search.replay(seed, number);
  const std::string option = search.name.empty() ? "" : " --" + search.name;
  std::printf("seed %llu, case %lld (scripts/random_search%s --seed %llu --case %lld)\n%s",
              static_cast<unsigned long long>(seed), static_cast<long long>(number), option.c_str(),
              static_cast<unsigned long long>(seed), static_cast<long long>(number), found.text.c_str());
  for (const std::string& violation : found.violations) std::printf("  VIOLATION: %s\n", violation.c_str());
  std::fflush(stdout);
  return found.violations.empty() ? 0 : kViolationFound;
}

}  // namespace

int main(int argc, char** argv) {
  const std::array searches{still_water_search(), wave_search(), motion_search(), flotation_search()};
  std::array<bool, 4> chosen{};
  std::int64_t cases = 20'000;
  std::int64_t first = 0;
  std::uint64_t seed = 1;
  std::int64_t single = -1;
  unsigned jobs = std::max(1U, std::thread::hardware_concurrency());
  bool table = false;
  ToolCommandLine command_line(searches[0].description + ".", "random_search");
  for (std::size_t i = 1; i < searches.size(); ++i) {
    command_line.add_flag("--" + searches[i].name, chosen[i], searches[i].description + ", instead");
  }
  constexpr std::int64_t kMaxCase = 1'000'000'000'000;
  command_line.add_positive("--cases", cases, "Number of cases");
  command_line.add_number("--first", first, std::int64_t{0}, kMaxCase,
                          "First case, for a run that continues another");
  command_line.add_option("--seed", seed, "Seed of the random cases");
  command_line.add_number("--case", single, std::int64_t{0}, kMaxCase, "Evaluate and print this case alone");
  command_line.add_number("--jobs", jobs, 1U, 1024U, "Threads");
  command_line.add_flag("--table", table, "Print the figures as a Markdown table");
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;
  if (std::ranges::count(chosen, true) > 1) {
    return report_usage_error({"--waves, --motion, --flotation", "given together", "one of them", "", ""});
  }
  const auto which = std::ranges::find(chosen, true);
  const RandomSearch& search =
      searches[which == chosen.end() ? 0 : static_cast<std::size_t>(which - chosen.begin())];
  if (single >= 0) return print_case(search, seed, single);
  const auto stop = [](int) { stop_requested = 1; };
  std::signal(SIGINT, stop);
  std::signal(SIGTERM, stop);

  SearchStats stats;
  ProgressBar progress("cases");
  const auto whole_units = [&](std::int64_t count) {
    return (count + search.unit - 1) / search.unit * search.unit;
  };
  first = whole_units(first);
  const std::int64_t block_size = whole_units(std::max<std::int64_t>(kBlock, search.unit * 2 * jobs));
  while (stats.cases < cases && stop_requested == 0) {
    const std::int64_t begin = first + stats.cases;
    const SearchStats block =
        search.run(seed, begin, begin + std::min(block_size, whole_units(cases - stats.cases)), jobs);
    stats += block;
    if (!block.failures.empty()) progress.clear();
    for (const SearchFailure& failure : block.failures) print_case(search, seed, failure.number);
    progress.update(stats.cases, cases, stats.cases);
  }
  progress.clear();
  if (table) std::printf("%s", search.table(stats).c_str());
  std::printf("seed %llu, from case %lld: %s\n", static_cast<unsigned long long>(seed),
              static_cast<long long>(first), search.summary(stats).c_str());
  return stats.failed_cases > 0 ? kViolationFound : 0;
}
