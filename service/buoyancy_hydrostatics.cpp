// buoyancy-hydrostatics: the program around equilibria, righting arms and hydrostatic tables.
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <numbers>
#include <string>
#include <system_error>

#include <CLI/App.hpp>

#include "cli/command_line.h"
#include "cli/progress_bar.h"
#include "service/hydrostatics/hydrostatics_options.h"
#include "service/hydrostatics/hydrostatics_output.h"
#include "service/hydrostatics/loaded_body.h"

namespace buoyancy::service {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

struct Output {
  std::string text;  // on standard output
  std::string csv;
};

Expected<void> write_file(const std::filesystem::path& path, const std::string& text) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  bool written = file != nullptr && std::fwrite(text.data(), 1, text.size(), file) == text.size();
  const int write_error = errno;
  if (file != nullptr) written = std::fclose(file) == 0 && written;
  if (written) return {};
  return make_error({path.string(), std::generic_category().message(file == nullptr ? write_error : errno),
                     "a file that can be written", "", ""});
}

Output equilibrium_output(const LoadedBody& loaded, const HydrostaticsOptions& options,
                          const HydrostaticsPlan& plan) {
  EquilibriumOptions search;
  search.axes = plan.table.axes;
  search.unstable = options.unstable;
  const Equilibria found = find_equilibria(loaded.body, loaded.water(), search);
  return {options.json ? equilibria_json(found) : equilibria_text(found), equilibria_csv(found)};
}

Expected<Output> table_output(const LoadedBody& loaded, const HydrostaticsOptions& options,
                              const HydrostaticsPlan& plan) {
  const Expected<HydrostaticTable> table = HydrostaticTable::make(loaded.body, loaded.water(), plan.table);
  if (!table) return tl::unexpected(table.error());
  TableRows rows;
  ProgressBar progress("rows");
  const auto total = static_cast<std::int64_t>(plan.trims.size() * plan.drafts.size());
  for (const double trim : plan.trims) {
    for (const double draft : plan.drafts) {
      const std::optional<HydrostaticRow> row = table->row(draft, trim);
      if (!row) {
        return make_error({"draft " + CLI::detail::to_string(draft) + " m", "no result",
                           "a draft at which the edge of an open mesh is dry", "",
                           "End the drafts below it"});
      }
      rows.push_back(*row);
      const auto done = static_cast<std::int64_t>(rows.size());
      progress.update(done, total, done);
    }
  }
  progress.clear();
  return Output{options.json ? table_json(*table, rows) : table_text(*table, rows), table_csv(rows)};
}

// The general criteria, to starboard; empty where the arms are not known up to 90 degrees.
std::vector<StabilityCriterion> general_criteria(const LoadedBody& loaded,
                                                 const RightingArmOptions& options) {
  constexpr int kMaxHeel = 90;  // [degrees]
  constexpr std::size_t kThirty = 30;
  constexpr std::size_t kForty = 40;
  std::vector<double> heels;
  for (int heel = 0; heel <= kMaxHeel; ++heel) heels.push_back(heel * kRadiansPerDegree);
  const auto curve = righting_curve(loaded.body, loaded.water(), heels, options);
  constexpr double kStep = 1e-4;  // [rad], of the central difference
  const auto right = righting_arm(loaded.body, loaded.water(), kStep, options);
  const auto left = righting_arm(loaded.body, loaded.water(), -kStep, options);
  if (!curve || !right || !left) return {};
  const double to_thirty = curve->points[kThirty].area;
  const double to_forty = curve->points[kForty].area;
  double beyond_thirty = curve->points[kThirty].arm.gz;
  for (std::size_t i = kThirty; i < heels.size(); ++i) {
    beyond_thirty = std::max(beyond_thirty, curve->points[i].arm.gz);
  }
  const double heel_of_max = curve->max_starboard ? curve->max_starboard->heel / kRadiansPerDegree : 0.0;
  if (curve->max_starboard && heel_of_max >= 30.0) {
    beyond_thirty = std::max(beyond_thirty, curve->max_starboard->gz);
  }
  return {{"area from 0 to 30 degrees", to_thirty, 0.055, "m rad"},
          {"area from 0 to 40 degrees", to_forty, 0.090, "m rad"},
          {"area from 30 to 40 degrees", to_forty - to_thirty, 0.030, "m rad"},
          {"largest GZ at 30 degrees or more", beyond_thirty, 0.20, "m"},
          {"heel of the largest GZ", heel_of_max, 25.0, "degrees"},
          {"GM at heel 0", (right->gz - left->gz) / (2.0 * kStep), 0.15, "m"}};
}

Expected<Output> righting_output(const LoadedBody& loaded, const HydrostaticsOptions& options,
                                 const HydrostaticsPlan& plan) {
  const auto curve = righting_curve(loaded.body, loaded.water(), plan.heels, plan.arms);
  if (!curve) {
    return make_error({"gz", "no balance at one of the heels",
                       "a body that floats at each heel, and trims by less than 89 degrees",
                       "the body sinks, takes in water or has no stable trim",
                       "See the command equilibrium, or fix the trim with --fixed-trim"});
  }
  const RightingResults results{*curve, general_criteria(loaded, plan.arms)};
  return Output{options.json ? righting_json(results) : righting_text(results), righting_csv(results)};
}

int run(int argc, char** argv) {
  CLI::App app("", "buoyancy-hydrostatics");
  HydrostaticsOptions options;
  add_options(app, options);
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  const auto fail = [&app](const Error& error, ExitCode exit_code) {
    print_error(app, error);
    return exit_code;
  };
  const Expected<HydrostaticsPlan> plan = plan_hydrostatics(app, options);
  if (!plan) return fail(plan.error(), kUsageError);
  const Expected<LoadedBody> loaded = load_body(options, *plan);
  if (!loaded) return fail(loaded.error(), kUsageError);

  Expected<Output> output;
  switch (plan->command) {
    case HydrostaticsCommand::kEquilibrium:
      output = equilibrium_output(*loaded, options, *plan);
      break;
    case HydrostaticsCommand::kTable:
      output = table_output(*loaded, options, *plan);
      break;
    case HydrostaticsCommand::kRightingArms:
      output = righting_output(*loaded, options, *plan);
      break;
  }
  if (!output) return fail(output.error(), kFailure);
  if (!options.csv.empty()) {
    if (const Expected<void> written = write_file(options.csv, output->csv); !written) {
      return fail(written.error(), kFailure);
    }
  }
  return print_output(app, output->text) ? kSuccess : kFailure;
}

}  // namespace
}  // namespace buoyancy::service

int main(int argc, char** argv) {
  return buoyancy::service::run(argc, argv);
}
