// Tests the program that produces the data of the plots in docs/stability.md.
#include <map>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "hydrostatics/solver.h"
#include "tests/support/child_process.h"
#include "tests/support/timeouts.h"

namespace buoyancy::bench {
namespace {

TEST(ErrorUnderStress, AffectsSinglePrecisionButNotExactMethods) {
  const FinishedProcess program = run_program("error_under_stress", {}, kRunTimeout);
  ASSERT_EQ(program.exit_code, 0) << program.standard_error;

  std::istringstream lines(program.standard_output);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "sweep,x,method,error_of_whole");
  std::map<std::string, std::set<std::string>> methods_of_step;
  std::map<std::string, std::map<std::string, double>> last;  // last error of each sweep, by method
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string sweep;
    std::string x;
    std::string method;
    std::string error;
    std::getline(fields, sweep, ',');
    std::getline(fields, x, ',');
    std::getline(fields, method, ',');
    std::getline(fields, error);
    methods_of_step[sweep + x].insert(method);
    last[sweep][method] = std::stod(error);
    const auto known = method_from_name(method);
    if (known && is_exact(*known)) {
      EXPECT_LE(std::stod(error), 1e-13) << line;
    }
  }
  EXPECT_GT(methods_of_step.size(), 150U);
  for (const auto& [step, methods] : methods_of_step)
    EXPECT_EQ(methods.size(), kAllMethods.size() + 1) << step;
  EXPECT_GT(last["level"]["float32_in_world"], 0.1);
  EXPECT_GT(last["origin"]["float32_in_world"], 0.1);
  EXPECT_GT(last["origin"]["fast"], 1e3);
}

}  // namespace
}  // namespace buoyancy::bench
