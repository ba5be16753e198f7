// random_search: searches for a request whose result violates a rule of check_result.h.
//
//   random_search [--cases N] [--seed S] [--record DIRECTORY] [--jobs J] [--table]
//
// Resumes where the seed's last run stopped, until N cases are done; Ctrl-C stops between blocks without
// losing results. Failing cases are shrunk and printed as tests. The last line summarizes all seeds of the
// record. Exit status: 0 if there is no violation; 1 on a violation, in this run or earlier; 2 on invalid
// arguments.
#include <csignal>
#include <cstdio>
#include <thread>

#include "cli/progress_bar.h"
#include "cli/tool_command_line.h"
#include "tests/random_search/search_record.h"
#include "tests/random_search/shrink.h"

namespace {

using namespace buoyancy;

constexpr int kViolationFound = 1;
constexpr int kUsageError = 2;
constexpr std::int64_t kBlock = 64 * kRequestsPerMesh;

volatile std::sig_atomic_t stop_requested = 0;

int report_usage_error(const Error& error) {
  std::fprintf(stderr, "random_search: %s\n", error.message().c_str());
  return kUsageError;
}

void print_failure(std::uint64_t seed, const FailedCase& failure) {
  std::printf("seed %llu, case %lld: %s\n", static_cast<unsigned long long>(seed),
              static_cast<long long>(failure.number), failure.mesh.c_str());
  for (const std::string& violation : failure.violations) std::printf("  %s\n", violation.c_str());
  const auto still_fails = [](const TriangleMesh& mesh, const SearchPose& requested) {
    return fails(mesh, requested, product_results);
  };
  const SearchCase original = search_case(seed, failure.number);
  if (still_fails(original.mesh, original.requested))
    std::printf("%s", as_test(shrunk(original, still_fails), seed, failure.number).c_str());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  buoyancy::ToolCommandLine command_line("Search for a request whose result violates an accuracy rule.",
                                         "random_search");
  std::int64_t cases = 20'000;
  std::uint64_t seed = 1;
  std::filesystem::path record = "build/random_search";
  unsigned jobs = std::max(1U, std::thread::hardware_concurrency());
  bool table = false;
  command_line.add_positive("--cases", cases, "Total number of cases of the seed, including earlier runs");
  command_line.add_option("--seed", seed, "Seed of the random cases");
  command_line.add_option("--record", record, "Directory of the results so far");
  command_line.add_number("--jobs", jobs, 1U, 1024U, "Threads");
  command_line.add_flag("--table", table, "Print the largest error ratios of all seeds as a Markdown table");
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;
  const auto stop = [](int) { stop_requested = 1; };
  std::signal(SIGINT, stop);
  std::signal(SIGTERM, stop);

  Expected<SearchStats> stats = load_stats(record, seed);
  if (!stats) return report_usage_error(stats.error());
  ProgressBar progress("cases");
  const std::int64_t before = stats->cases;
  while (stats->cases < cases && stop_requested == 0) {
    const std::int64_t left = cases - stats->cases;
    const std::int64_t whole_meshes = (left + kRequestsPerMesh - 1) / kRequestsPerMesh * kRequestsPerMesh;
    const SearchStats block = search(seed, stats->cases, stats->cases + std::min(kBlock, whole_meshes), jobs);
    *stats += block;
    if (const Expected<void> saved = save_stats(record, seed, *stats); !saved)
      return report_usage_error(saved.error());
    if (!block.failures.empty()) progress.clear();
    for (const FailedCase& failure : block.failures) print_failure(seed, failure);
    progress.update(stats->cases - before, cases - before, stats->cases - before);
  }
  progress.clear();
  const Expected<SearchStats> all = load_all(record);
  if (!all) return report_usage_error(all.error());
  if (table) std::printf("%s", markdown(*all).c_str());
  std::printf("seed %llu: %s; all seeds: %s\n", static_cast<unsigned long long>(seed),
              summary(*stats).c_str(), summary(*all).c_str());
  return all->failed_cases > 0 ? kViolationFound : 0;
}
