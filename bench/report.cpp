#include "report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "markdown_table.h"
#include "time_queries.h"

namespace buoyancy::bench {
namespace {

constexpr const char* kRock = "rock";

// The methods whose time is proportional to the mesh and that are exact to rounding.
constexpr std::array kLinearExactMethods{kPlainRow, "exact", "exact_surface"};

// Limits and goals of the speedup of hierarchical over `plain`, on the best instruction set.
struct SpeedupGoal {
  std::string_view mesh;
  std::size_t triangles;
  double required, goal;
};
constexpr std::array kSpeedupGoals{
    SpeedupGoal{"torus knot", 1'760, 4, 6},    SpeedupGoal{"rock", 5'120, 7, 10},
    SpeedupGoal{"rock", 30'420, 18, 25},       SpeedupGoal{"rock uv", 30'000, 18, 25},
    SpeedupGoal{"rock", 297'680, 33, 50},      SpeedupGoal{"rock", 1'003'520, 70, 100},
    SpeedupGoal{"rock uv", 1'000'000, 55, 75},
};

constexpr double kMaxExponent = 0.70;
constexpr double kExponentGoal = 0.60;
constexpr std::size_t kReadGoalTriangles = 30'000;  // from this size on a query must be faster than one read
constexpr double kToleranceGoal = 1e-3;
constexpr double kMaxToleranceGrowth = 3.0;  // of the query time from the smallest to the largest rock
constexpr double kMaxBuildNs = 1000.0;       // per triangle
constexpr double kMaxTreeBytes = 34.0;       // per triangle

// Three significant digits without an exponent.
std::string microseconds(double ns) {
  const double us = 1e-3 * ns;
  return format_cell(us < 9.995 ? "%.2f" : us < 99.95 ? "%.1f" : "%.0f", us);
}

std::string error(double value) {
  return std::isnan(value) ? "" : format_cell("%.2g", value);
}

// "0", "1e-6".
std::string power_of_ten(double value) {
  return value == 0.0 ? "0" : format_cell("1e%g", std::round(std::log10(value)));
}

struct MeshName {
  std::string name;
  std::size_t triangles;

  bool operator==(const MeshName&) const = default;
};

std::vector<MeshName> meshes_of(const std::vector<Measurement>& rows) {
  std::vector<MeshName> meshes;
  for (const Measurement& row : rows) {
    const MeshName mesh{row.mesh, row.triangles};
    if (std::find(meshes.begin(), meshes.end(), mesh) == meshes.end()) meshes.push_back(mesh);
  }
  return meshes;
}

class Report {
 public:
  Report(std::FILE* file, const BenchmarkResults& results)
      : file_(file),
        measurements_(results.measurements),
        trees_(results.trees),
        meshes_(meshes_of(results.measurements)) {}

  void times(const std::string& regime, const char* heading) const {
    std::fprintf(file_, "### %s\n\nMedian time per query, us.\n\n", heading);
    by_method(regime, true, [](const Measurement& row) { return microseconds(row.median_ns); });
  }

  void cold_times() const {
    std::fprintf(
        file_,
        "### Time, caches flushed before every query\n\nMedian time per query, us, as beside a simulator "
        "that needs the caches itself: every fourth of the poses far\napart, a buffer of at least 96 MB "
        "written and read before each. The ratio is that of the faster of `plain` and `exact`\nto "
        "`hierarchical`.\n\n");
    MarkdownTable table({"mesh", "triangles", "read", "plain", "exact", "hierarchical", "ratio"});
    for (const MeshName& mesh : meshes_) {
      std::vector<std::string> cells{mesh.name, std::to_string(mesh.triangles)};
      for (const char* const method : {kMemoryReadRow, kPlainRow, "exact", "hierarchical"})
        cells.push_back(microseconds(find(mesh, method, 0.0, kColdRegime)->median_ns));
      const double ratio = fastest_linear(mesh, kColdRegime)->median_ns /
                           find(mesh, "hierarchical", 0.0, kColdRegime)->median_ns;
      cells.push_back(format_cell("%.1f", ratio));
      table.add(std::move(cells));
    }
    table.print(file_, 1);
  }

  void errors() const {
    std::fprintf(file_, "### Largest error\n\n");
    std::fprintf(file_,
                 "Of force, over the poses far apart and along the trajectory, relative to the whole.\n\n");
    by_method(kIndependentRegime, false, [&](const Measurement& row) {
      const Measurement* coherent = find_measurement(measurements_, row.mesh, row.triangles, row.method,
                                                     row.tolerance, "", kCoherentRegime);
      return error(std::max(row.errors.force, coherent->errors.force));
    });
  }

  void ratios() const {
    std::fprintf(file_, "### Speedup over methods that visit the whole mesh\n\n");
    std::fprintf(
        file_,
        "Times over that of `hierarchical` at tolerance 0; poses far apart, caches warm. `plain` is the "
        "paper's exact method as\na user would write it: 40 lines of C++ in double precision, with the same "
        "compiler flags (`bench/plain_exact.cpp`).\nThe fastest is that of `plain`, `exact` and "
        "`exact_surface`, which are exact to rounding.\n\n");
    MarkdownTable table({"mesh", "triangles", "plain, us", "exact, us", "hierarchical, us", "target",
                         "exact / plain", "fastest / hierarchical", "plain / hierarchical", "required",
                         "goal", "", "slowest target", "plain / hierarchical"});
    for (const MeshName& mesh : meshes_) {
      const double plain = find(mesh, kPlainRow, 0.0)->median_ns;
      const double exact = find(mesh, "exact", 0.0)->median_ns;
      const Measurement* const best = find(mesh, "hierarchical", 0.0);
      const Measurement* const slowest = slowest_target(mesh);
      const double speedup = plain / best->median_ns;
      std::vector<std::string> cells{
          mesh.name,
          std::to_string(mesh.triangles),
          microseconds(plain),
          microseconds(exact),
          microseconds(best->median_ns),
          best->target,
          format_cell("%.2f", exact / plain),
          format_cell("%.1f", fastest_linear(mesh, kIndependentRegime)->median_ns / best->median_ns),
          format_cell("%.1f", speedup),
          "",
          "",
          "",
          slowest->target,
          format_cell("%.1f", plain / slowest->median_ns)};
      const auto goal = std::find_if(kSpeedupGoals.begin(), kSpeedupGoals.end(), [&](const SpeedupGoal& g) {
        return g.mesh == mesh.name && g.triangles == mesh.triangles;
      });
      if (goal != kSpeedupGoals.end()) {
        cells[9] = format_cell("%g", goal->required);
        cells[10] = format_cell("%g", goal->goal);
        cells[11] = pass_or_fail(speedup >= goal->required);
        if (speedup >= goal->goal) cells[11] += ", goal too";
      }
      table.add(std::move(cells));
    }
    table.print(file_, 1);
  }

  void read_comparison() const {
    std::fprintf(file_, "### Query time compared with reading the mesh\n\n");
    std::fprintf(file_,
                 "Vertices and indices are read repeatedly, from the nearest cache that holds them.\n\n");
    MarkdownTable table({"mesh", "triangles", "read, us", "hierarchical, us", "query / read", ""});
    for (const MeshName& mesh : meshes_) {
      const double reading = find(mesh, kMemoryReadRow, 0.0)->median_ns;
      const double query = find(mesh, "hierarchical", 0.0)->median_ns;
      table.add({mesh.name, std::to_string(mesh.triangles), microseconds(reading), microseconds(query),
                 format_cell("%.2f", query / reading),
                 mesh.triangles >= kReadGoalTriangles ? pass_or_fail(query < reading) : ""});
    }
    table.print(file_, 1);
  }

  void targets() const {
    std::fprintf(file_, "### Instruction sets\n\n");
    std::fprintf(file_, "Median times of `exact` / `hierarchical` at tolerance 0, us, poses far apart.\n\n");
    std::vector<std::string> header{"mesh", "triangles"};
    std::vector<std::string> names;
    for (const Measurement& row : measurements_) {
      if (row.target != kNoTarget && std::find(names.begin(), names.end(), row.target) == names.end())
        names.push_back(row.target);
    }
    header.insert(header.end(), names.begin(), names.end());
    MarkdownTable table(header);
    for (const MeshName& mesh : meshes_) {
      std::vector<std::string> cells{mesh.name, std::to_string(mesh.triangles)};
      for (const std::string& target : names) {
        const auto time = [&](const std::string& method) {
          return microseconds(find_measurement(measurements_, mesh.name, mesh.triangles, method, 0.0, target,
                                               kIndependentRegime)
                                  ->median_ns);
        };
        cells.push_back(time("exact") + " / " + time("hierarchical"));
      }
      table.add(std::move(cells));
    }
    table.print(file_, 1);
  }

  void growth() const {
    std::vector<const Measurement*> hierarchical;
    for (const MeshName& mesh : meshes_) {
      if (mesh.name == kRock) hierarchical.push_back(find(mesh, "hierarchical", 0.0));
    }
    if (hierarchical.size() < 2) return;
    const double exponent = fitted_exponent(hierarchical);
    std::fprintf(
        file_,
        "### Growth\n\nThe time of `hierarchical` at tolerance 0 grows as triangles^%.2f, fitted to the "
        "%zu rocks, poses far apart\n(at most %.2f: %s; goal %.2f: %s).\n\n",
        exponent, hierarchical.size(), kMaxExponent, pass_or_fail(exponent <= kMaxExponent).c_str(),
        kExponentGoal, pass_or_fail(exponent <= kExponentGoal).c_str());
  }

  void tolerances() const {
    std::fprintf(file_, "### Tolerance\n\nTrue error of force and the published bound, poses far apart.\n\n");
    MarkdownTable table({"mesh", "triangles", "tolerance", "time, us", "error, median", "error, largest",
                         "bound, median", "bound, largest"});
    for (const MeshName& mesh : meshes_) {
      if (mesh.name != kRock) continue;
      for (const double tolerance : kMeasuredTolerances) {
        const Measurement& row = *find(mesh, "hierarchical", tolerance);
        table.add({mesh.name, std::to_string(mesh.triangles), power_of_ten(tolerance),
                   microseconds(row.median_ns), error(row.errors.force_median), error(row.errors.force),
                   error(row.errors.bound_median), error(row.errors.bound)});
      }
    }
    table.print(file_, 1);
    tolerance_goals();
  }

  void trees() const {
    std::fprintf(file_, "### The tree\n\n");
    MarkdownTable table({"mesh", "triangles", "build, ns per triangle", "at most",
                         "memory, bytes per triangle", "at most", ""});
    for (const TreeCost& tree : trees_) {
      table.add({tree.mesh, std::to_string(tree.triangles), format_cell("%.0f", tree.build_ns),
                 format_cell("%g", kMaxBuildNs), format_cell("%.0f", tree.bytes),
                 format_cell("%g", kMaxTreeBytes),
                 pass_or_fail(tree.build_ns <= kMaxBuildNs && tree.bytes <= kMaxTreeBytes)});
    }
    table.print(file_, 1);
  }

 private:
  const Measurement* find(const MeshName& mesh, const std::string& method, double tolerance,
                          const std::string& regime = kIndependentRegime) const {
    return find_measurement(measurements_, mesh.name, mesh.triangles, method, tolerance, "", regime);
  }

  const Measurement* fastest_linear(const MeshName& mesh, const std::string& regime) const {
    const Measurement* fastest = nullptr;
    for (const char* const method : kLinearExactMethods) {
      const Measurement* const row = find(mesh, method, 0.0, regime);
      if (row != nullptr && (fastest == nullptr || row->median_ns < fastest->median_ns)) fastest = row;
    }
    return fastest;
  }

  const Measurement* slowest_target(const MeshName& mesh) const {
    const Measurement* slowest = find(mesh, "hierarchical", 0.0);
    for (const Measurement& row : measurements_) {
      if (row.mesh == mesh.name && row.triangles == mesh.triangles && row.method == "hierarchical" &&
          row.tolerance == 0.0 && row.regime == kIndependentRegime && row.median_ns > slowest->median_ns)
        slowest = &row;
    }
    return slowest;
  }

  // Prints a row per mesh and a column per method and tolerance, all on the best instruction set.
  template <typename Cell>
  void by_method(const std::string& regime, bool with_read, const Cell& cell) const {
    std::vector<std::string> header{"mesh", "triangles"};
    std::vector<std::pair<std::string, double>> columns;
    if (with_read) columns.emplace_back(kMemoryReadRow, 0.0);
    columns.emplace_back(kPlainRow, 0.0);
    for (const Method method : kAllMethods) columns.emplace_back(to_string(method), 0.0);
    for (const double tolerance : kMeasuredTolerances) {
      if (tolerance > 0.0) columns.emplace_back("hierarchical", tolerance);
    }
    for (const auto& [method, tolerance] : columns)
      header.push_back(tolerance > 0.0 ? "at " + power_of_ten(tolerance) : method);
    MarkdownTable table(header);
    for (const MeshName& mesh : meshes_) {
      std::vector<std::string> cells{mesh.name, std::to_string(mesh.triangles)};
      for (const auto& [method, tolerance] : columns)
        cells.push_back(
            cell(*find_measurement(measurements_, mesh.name, mesh.triangles, method, tolerance, "", regime)));
      table.add(std::move(cells));
    }
    table.print(file_, 1);
  }

  void tolerance_goals() const {
    const Measurement* smallest = nullptr;
    const Measurement* largest = nullptr;
    std::string slower;
    for (const MeshName& mesh : meshes_) {
      const Measurement* const row = find(mesh, "hierarchical", kToleranceGoal);
      if (mesh.triangles > 5'000 && row->median_ns >= find(mesh, "hierarchical", 0.0)->median_ns) {
        slower += (slower.empty() ? "" : ", ") + mesh.name + " " + std::to_string(mesh.triangles);
      }
      if (mesh.name != kRock) continue;
      if (smallest == nullptr) smallest = row;
      largest = row;
    }
    if (smallest == largest) return;
    const double growth = largest->median_ns / smallest->median_ns;
    std::fprintf(file_,
                 "- Tolerance %s takes %.2f times as long at %zu triangles as at %zu (at most %g: %s).\n",
                 power_of_ten(kToleranceGoal).c_str(), growth, largest->triangles, smallest->triangles,
                 kMaxToleranceGrowth, pass_or_fail(growth <= kMaxToleranceGrowth).c_str());
    std::fprintf(
        file_,
        "- It takes less time than tolerance 0 on every mesh of more than 5,000 triangles: %s%s%s.\n\n",
        pass_or_fail(slower.empty()).c_str(), slower.empty() ? "" : ", not on ", slower.c_str());
  }

  std::FILE* file_;
  const std::vector<Measurement>& measurements_;
  const std::vector<TreeCost>& trees_;
  std::vector<MeshName> meshes_;
};

}  // namespace

double fitted_exponent(const std::vector<const Measurement*>& rows) {
  const auto count = static_cast<double>(rows.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (const Measurement* row : rows) {
    mean_x += std::log(static_cast<double>(row->triangles)) / count;
    mean_y += std::log(row->median_ns) / count;
  }
  double xy = 0.0;
  double xx = 0.0;
  for (const Measurement* row : rows) {
    const double x = std::log(static_cast<double>(row->triangles)) - mean_x;
    xy += x * (std::log(row->median_ns) - mean_y);
    xx += x * x;
  }
  return xy / xx;
}

void print_report(std::FILE* file, const BenchmarkResults& results) {
  const Report report(file, results);
  report.times(kIndependentRegime, "Time, poses far apart");
  report.times(kCoherentRegime, "Time, a floating body's trajectory");
  report.cold_times();
  report.errors();
  report.ratios();
  report.read_comparison();
  report.targets();
  report.growth();
  report.tolerances();
  report.trees();
}

}  // namespace buoyancy::bench
