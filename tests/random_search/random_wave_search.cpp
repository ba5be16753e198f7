// random_wave_search: searches for a load in waves that is further from the truth than its published bound.
//
//   random_wave_search [--cases N] [--seed S] [--case K] [--record DIRECTORY] [--jobs J] [--table]
//
// Resumes where the seed's last run stopped, until N cases are done; Ctrl-C stops between blocks without
// losing results. A violation is printed with everything that replays it. With --case, only this case is
// evaluated, on every instruction set, and printed. The last line summarizes all seeds of the record. Exit
// status: 0 if there is no violation; 1 on a violation, in this run or earlier; 2 on invalid arguments.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <thread>

#include "cli/progress_bar.h"
#include "cli/tool_command_line.h"
#include "tests/random_search/wave_record.h"

namespace {

using namespace buoyancy;

constexpr int kViolationFound = 1;
constexpr int kUsageError = 2;

volatile std::sig_atomic_t stop_requested = 0;

int report_usage_error(const Error& error) {
  std::fprintf(stderr, "random_wave_search: %s\n", error.message().c_str());
  return kUsageError;
}

void print_case(std::uint64_t seed, std::int64_t number, const std::string& text,
                const std::vector<std::string>& violations) {
  std::printf("seed %llu, case %lld (scripts/random_search --waves --seed %llu --case %lld)\n%s",
              static_cast<unsigned long long>(seed), static_cast<long long>(number),
              static_cast<unsigned long long>(seed), static_cast<long long>(number), text.c_str());
  for (const std::string& violation : violations) std::printf("  VIOLATION: %s\n", violation.c_str());
  std::fflush(stdout);
}

int replay(std::uint64_t seed, std::int64_t number) {
  const WaveReplay replayed = replay_wave_case(seed, number);
  print_case(seed, number, replayed.text, replayed.violations);
  return replayed.violations.empty() ? 0 : kViolationFound;
}

}  // namespace

int main(int argc, char** argv) {
  buoyancy::ToolCommandLine command_line("Search for a load in waves that violates its bound.",
                                         "random_wave_search");
  std::int64_t cases = 20'000;
  std::uint64_t seed = 1;
  std::int64_t single = -1;
  std::filesystem::path record = "build/random_search";
  unsigned jobs = std::max(1U, std::thread::hardware_concurrency());
  bool table = false;
  command_line.add_positive("--cases", cases, "Total number of cases of the seed, including earlier runs");
  command_line.add_option("--seed", seed, "Seed of the random cases");
  command_line.add_number("--case", single, std::int64_t{0}, std::int64_t{1'000'000'000'000},
                          "Evaluate and print this case alone");
  command_line.add_option("--record", record, "Directory of the results so far");
  command_line.add_number("--jobs", jobs, 1U, 1024U, "Threads");
  command_line.add_flag("--table", table, "Print the figures of all seeds as a Markdown table");
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;
  if (single >= 0) return replay(seed, single);
  const auto stop = [](int) { stop_requested = 1; };
  std::signal(SIGINT, stop);
  std::signal(SIGTERM, stop);

  Expected<WaveSearchStats> stats = load_wave_stats(record, seed);
  if (!stats) return report_usage_error(stats.error());
  ProgressBar progress("cases");
  const std::int64_t before = stats->cases();
  const std::int64_t block_size = kWaveCasesPerMesh * std::max(8U, 2U * jobs);
  for (std::int64_t done = before; done < cases && stop_requested == 0; done = stats->cases()) {
    const std::int64_t left = cases - done;
    const std::int64_t whole_meshes = (left + kWaveCasesPerMesh - 1) / kWaveCasesPerMesh * kWaveCasesPerMesh;
    const WaveSearchStats block = search_waves(seed, done, done + std::min(block_size, whole_meshes), jobs);
    *stats += block;
    if (const Expected<void> saved = save_wave_stats(record, seed, *stats); !saved) {
      return report_usage_error(saved.error());
    }
    if (!block.failures.empty()) progress.clear();
    for (const FailedWaveCase& failure : block.failures) {
      print_case(seed, failure.number, failure.text, failure.violations);
    }
    progress.update(stats->cases() - before, cases - before, stats->cases() - before);
  }
  progress.clear();
  const Expected<WaveSearchStats> all = load_all_wave_stats(record);
  if (!all) return report_usage_error(all.error());
  if (table) std::printf("%s", markdown(*all).c_str());
  std::printf("seed %llu: %s\nall seeds: %s\n", static_cast<unsigned long long>(seed),
              summary(*stats).c_str(), summary(*all).c_str());
  return all->failed_cases > 0 ? kViolationFound : 0;
}
