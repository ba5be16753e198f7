// Runs the benchmark program on two small meshes and checks its rows, but not its times.
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "bench/time_queries.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "tests/support/child_process.h"
#include "tests/support/contains.h"
#include "tests/support/temp_dir.h"
#include "tests/support/timeouts.h"

namespace buoyancy::bench {
namespace {

struct CsvRow {
  std::string mesh, triangles, method, tolerance, target, regime;
  double median_ns, force_error, torque_error, bound;
};

CsvRow parse(const std::string& line) {
  std::istringstream fields(line);
  const auto field = [&] {
    std::string text;
    std::getline(fields, text, ',');
    return text;
  };
  CsvRow row;
  for (std::string* text : {&row.mesh, &row.triangles, &row.method, &row.tolerance, &row.target, &row.regime})
    *text = field();
  for (double* number : {&row.median_ns, &row.force_error, &row.torque_error, &row.bound})
    *number = std::stod(field());
  EXPECT_TRUE(fields.eof()) << line;
  return row;
}

TEST(SpeedAccuracy, WritesOneRowPerMeasurement) {
  const TempDir directory;
  const std::string csv = directory.path("rows.csv");
  const FinishedProcess program = run_program("speed_accuracy", {"--smoke", "--csv", csv}, kRunTimeout);
  ASSERT_EQ(program.exit_code, 0) << program.standard_error;
  for (const char* const heading :
       {"### Speedup over methods that visit the whole mesh", "### Time, caches flushed before every query"})
    EXPECT_TRUE(contains(program.standard_output, heading));

  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "mesh,triangles,method,tolerance,target,regime,median_ns,force_error,torque_error,bound");
  std::map<std::string, std::size_t> rows_of_mesh;
  std::set<std::string> combinations;
  while (std::getline(file, line)) {
    const CsvRow row = parse(line);
    const std::string mesh_and_regime = row.mesh + "," + row.triangles + "," + row.regime;
    ++rows_of_mesh[mesh_and_regime];
    combinations.insert(mesh_and_regime + row.method + row.tolerance + row.target);
    EXPECT_GE(row.median_ns, 0.0) << line;
    if (row.method == kMemoryReadRow || row.method == kPlainRow) {
      EXPECT_TRUE(std::isnan(row.bound)) << line;
      EXPECT_EQ(std::isnan(row.force_error), row.method == kMemoryReadRow) << line;
    } else {
      EXPECT_LE(row.force_error, row.bound) << line;
    }
    EXPECT_EQ(row.target != kNoTarget, row.method == "hierarchical" || row.method == "exact") << line;
  }
  // Rows: read, plain, five methods, hierarchical at each tolerance; exact and hierarchical on each
  // instruction set but the best. Cold: read, plain, exact, hierarchical.
  const std::size_t warm_rows = 1 + 1 + 5 + kMeasuredTolerances.size() + 2 * (simd_targets().size() - 1);
  std::map<std::string, std::size_t> expected;
  for (const char* const mesh : {"torus knot,1760", "rock,320", "rock shuffled,320", "rock uv,320"}) {
    expected[mesh + std::string(",independent")] = expected[mesh + std::string(",coherent")] = warm_rows;
    expected[mesh + std::string(",cold")] = 4;
  }
  EXPECT_EQ(rows_of_mesh, expected);
  std::size_t rows = 0;
  for (const auto& [mesh_and_regime, count] : expected) rows += count;
  EXPECT_EQ(combinations.size(), rows);
}

TEST(SpeedAccuracy, ReportsUnwritableCsv) {
  const FinishedProcess program =
      run_program("speed_accuracy", {"--smoke", "--csv", "/no/such/directory/rows.csv"}, kRunTimeout);
  EXPECT_EQ(program.exit_code, 1);
  EXPECT_TRUE(contains(program.standard_error, "/no/such/directory/rows.csv"));
  const FinishedProcess full = run_program("speed_accuracy", {"--smoke", "--csv", "/dev/full"}, kRunTimeout);
  EXPECT_EQ(full.exit_code, 1);
}

TEST(SpeedAccuracy, RejectsContradictoryArguments) {
  const FinishedProcess program = run_program("speed_accuracy", {"--smoke", "--quick"}, kRunTimeout);
  EXPECT_EQ(program.exit_code, 2);
}

}  // namespace
}  // namespace buoyancy::bench
