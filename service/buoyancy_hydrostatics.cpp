// buoyancy-hydrostatics: the program around equilibria, righting arms, ballast, and tables of hulls, tanks
// and permissible KG.
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/App.hpp>

#include "base/angles.h"
#include "base/format.h"
#include "base/json.h"
#include "base/text_file.h"
#include "cli/command_line.h"
#include "cli/progress_bar.h"
#include "scene/body_motions.h"
#include "scene/mesh_warnings.h"
#include "service/hydrostatics/ballast_results.h"
#include "service/hydrostatics/hydrostatics_options.h"
#include "service/hydrostatics/hydrostatics_output.h"
#include "service/hydrostatics/hydrostatics_page.h"
#include "service/hydrostatics/kg_limit.h"
#include "service/hydrostatics/loaded_body.h"
#include "service/hydrostatics/tank_tables.h"
#include "view/page/page_assets.h"

namespace buoyancy::service {
namespace {

bool has_weather(const HydrostaticsOptions& options) {
  return options.exposure.windage_area > 0.0;
}

struct Output {
  std::string text;  // on standard output
  std::string csv;
  std::string html;                   // empty unless it is requested
  std::optional<Error> missing = {};  // what the output lacks
};

Error no_balance(const std::string& heels) {
  return {"gz", "no balance at a heel of " + heels,
          "a body that floats at each heel, and trims by less than 89 degrees",
          "the body sinks, takes in water or has no stable trim",
          "End the heels before it, see the command equilibrium, or fix the trim with --fixed-trim"};
}

// Returns an error that lists the requested heels that the curve lacks; nullopt: it has all of them.
std::optional<Error> missing_heels(const RightingCurve& curve) {
  std::string heels;
  for (const std::optional<double>& heel : {curve.unbalanced_starboard, curve.unbalanced_port}) {
    if (!heel) continue;
    if (!heels.empty()) heels += " and of ";
    heels += format_number(*heel * kDegreesPerRadian, 4) + " degrees";
  }
  if (heels.empty()) return std::nullopt;
  return no_balance(heels + "; there are results only between it and heel 0");
}

PageSubject page_subject(const LoadedBody& loaded, const HydrostaticsPlan& plan) {
  return {.name = loaded.name, .body = &loaded.body, .water = &loaded.water(), .axes = plan.table.axes};
}

double keel_of(const LoadedBody& loaded, const HydrostaticsPlan& plan) {
  const Vec3& up_B = plan.table.axes.up_B;
  return plan.table.keel.value_or(lowest_along(loaded.body, up_B) + up_B.dot(loaded.body.center_B()));
}

SubmergedResult submerged_result(const LoadedBody& loaded, const ShipAxes& axes) {
  const Water& water = loaded.water();
  SubmergedResult result{submerged_rest(loaded.body, water, axes), std::nullopt};
  if (!result.rest) return result;
  const Vec3 up_B = result.rest->q_WB.conjugate() * water.up_W;
  const bool hovers = result.rest->motion == VerticalMotion::kHovers;
  result.terminal_speed =
      terminal_velocity_of(*loaded.scene_body, up_B, hovers ? 0.0 : -result.rest->net_weight);
  if (result.terminal_speed) *result.terminal_speed = std::abs(*result.terminal_speed);
  return result;
}

// three: the text of three.js for the page, empty if no page is requested.
Output equilibrium_output(const LoadedBody& loaded, const HydrostaticsOptions& options,
                          const HydrostaticsPlan& plan, const std::string& three) {
  EquilibriumOptions search;
  search.axes = plan.table.axes;
  search.unstable = options.unstable;
  ProgressBar progress("starts");
  search.progress = [&progress](std::int64_t done, std::int64_t total) {
    progress.update(done, total, done);
  };
  const Equilibria found = find_equilibria(loaded.body, loaded.water(), search);
  progress.clear();
  const Water& water = loaded.water();
  PointRows points{.points = plan.water_points, .rows = {}};
  PartRows parts;
  if (loaded.shares) parts.names = loaded.shares->names;
  const double keel = keel_of(loaded, plan);
  for (const Equilibrium& at : found.attitudes) {
    const Vec3 up_B = at.pose.q_WB.conjugate() * water.up_W;
    const double height = water.up_W.dot(at.pose.p_WB) - water.level;
    points.rows.push_back(readings(points.points, search.axes, keel, up_B, height));
    if (loaded.shares) parts.rows.push_back(displaced_parts(loaded.shares->body, at.pose, water));
  }
  const bool goes_under =
      found.outcome == FlotationOutcome::kSinks || found.outcome == FlotationOutcome::kNeutral;
  std::optional<SubmergedResult> result;
  if (goes_under || options.submerged) result = submerged_result(loaded, search.axes);
  const SubmergedResult* submerged = result ? &*result : nullptr;
  return {options.json ? json_lines(equilibria_json(found, points, parts, submerged))
                       : equilibria_text(found, points, parts, submerged),
          equilibria_csv(found, points),
          three.empty() ? "" : equilibria_page(page_subject(loaded, plan), found, submerged, three)};
}

Expected<Output> table_output(const LoadedBody& loaded, const HydrostaticsOptions& options,
                              const HydrostaticsPlan& plan, const std::string& three) {
  const Expected<HydrostaticTable> table = HydrostaticTable::make(loaded.body, loaded.water(), plan.table);
  if (!table) return tl::unexpected(table.error());
  TableRows rows;
  PointRows points{.points = plan.water_points, .rows = {}};
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
      const ShipAxes& axes = plan.table.axes;
      const Vec3 up_B = up_at(axes, {0.0, trim});
      const Vec3 on_water_B = table->midship() * axes.forward_B + (table->keel() + draft) * axes.up_B;
      points.rows.push_back(readings(points.points, axes, table->keel(), up_B, -up_B.dot(on_water_B)));
      const auto done = static_cast<std::int64_t>(rows.size());
      progress.update(done, total, done);
    }
  }
  progress.clear();
  return Output{
      options.json ? json_lines(table_json(*table, rows, points)) : table_text(*table, rows, points),
      table_csv(rows, points),
      three.empty() ? "" : table_page(page_subject(loaded, plan), *table, rows, plan.drafts.size(), three)};
}

Expected<Output> righting_output(const LoadedBody& loaded, const HydrostaticsOptions& options,
                                 const HydrostaticsPlan& plan, const std::string& three) {
  ProgressBar progress("heels");
  RightingArmOptions arms = plan.arms;
  arms.progress = [&progress](std::int64_t done, std::int64_t total) { progress.update(done, total, done); };
  std::optional<HydrostaticTable> table;
  WeatherInputs weather{.exposure = options.exposure};
  if (has_weather(options)) {
    Expected<HydrostaticTable> made = HydrostaticTable::make(loaded.body, loaded.water(), plan.table);
    if (!made) return tl::unexpected(made.error());
    weather.table = &table.emplace(*std::move(made));
  }
  const auto results = righting_results(loaded.body, loaded.water(), plan.heels, plan.points, arms,
                                        table ? &weather : nullptr);
  progress.clear();
  if (!results) return make_error(no_balance("0 degrees"));
  if (results->curve.points.empty()) return tl::unexpected(*missing_heels(results->curve));
  PointRows points{.points = plan.water_points, .rows = {}};
  const double keel = keel_of(loaded, plan);
  for (const auto& [arm, area] : results->curve.points) {
    const Vec3 up_B = up_at(arms.axes, {arm.heel, arm.trim});
    points.rows.push_back(readings(points.points, arms.axes, keel, up_B, arm.height));
  }
  return Output{options.json ? json_lines(righting_json(*results, points)) : righting_text(*results, points),
                righting_csv(*results, points),
                three.empty() ? "" : righting_page(page_subject(loaded, plan), *results, plan.arms, three),
                missing_heels(results->curve)};
}

Expected<Output> ballast_output(const CLI::App& app, const LoadedBody& loaded,
                                const HydrostaticsOptions& options, const HydrostaticsPlan& plan) {
  const Expected<Ballast> ballast = find_ballast(loaded.body, loaded.water(), plan.ballast);
  if (!ballast) return tl::unexpected(ballast.error());
  if (const std::optional<Warning> outside = outside_warning(*ballast)) print_warning(app, *outside);
  return Output{.text = options.json ? json_lines(ballast_json(*ballast)) : ballast_text(*ballast),
                .csv = ballast_csv(*ballast),
                .html = "",
                .missing = instability(*ballast)};
}

Expected<Output> kg_limit_output(const LoadedBody& loaded, const HydrostaticsOptions& options,
                                 const HydrostaticsPlan& plan) {
  const Expected<HydrostaticTable> table = HydrostaticTable::make(loaded.body, loaded.water(), plan.table);
  if (!table) return tl::unexpected(table.error());
  const WeatherInputs weather{.exposure = options.exposure, .table = &*table};
  std::vector<KgLimit> limits;
  ProgressBar progress("drafts");
  const auto total = static_cast<std::int64_t>(plan.trims.size() * plan.drafts.size());
  for (const double trim : plan.trims) {
    for (const double draft : plan.drafts) {
      const std::optional<KgLimit> limit =
          kg_limit(loaded.body, loaded.water(), *table, draft, trim, plan.points, plan.arms,
                   has_weather(options) ? &weather : nullptr);
      if (!limit) {
        return make_error(
            {"draft " + CLI::detail::to_string(draft) + " m", "no result",
             "a draft at which the hull displaces water and has a waterplane, and the edge of an "
             "open mesh is dry",
             "", "Choose drafts between the keel and the deck"});
      }
      limits.push_back(*limit);
      const auto done = static_cast<std::int64_t>(limits.size());
      progress.update(done, total, done);
    }
  }
  progress.clear();
  return Output{.text = options.json ? json_lines(kg_limits_json(limits)) : kg_limits_text(limits),
                .csv = kg_limits_csv(limits),
                .html = ""};
}

// Writes and prints the output, and returns the exit code.
int write_output(const CLI::App& app, const HydrostaticsOptions& options, const Expected<Output>& output) {
  const auto fail = [&app](const Error& error) {
    print_error(app, error);
    return kFailure;
  };
  if (!output) return fail(output.error());
  for (const auto& [path, text] :
       {std::pair{&options.csv, &output->csv}, std::pair{&options.html, &output->html}}) {
    if (path->empty()) continue;
    if (const Expected<void> written = write_file(*path, *text); !written) return fail(written.error());
  }
  if (!print_output(app, output->text)) return kFailure;
  return output->missing ? fail(*output->missing) : kSuccess;
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
  Expected<HydrostaticsPlan> plan = plan_hydrostatics(app, options);
  if (!plan) return fail(plan.error(), kUsageError);
  std::string three;
  if (!options.html.empty()) {
    Expected<std::string> text = view::three_js(options.three);
    if (!text) return fail(text.error(), kFailure);
    three = *std::move(text);
  }
  Expected<LoadedScene> scene = load_scene(options, *plan);
  if (!scene) return fail(scene.error(), kUsageError);
  if (const Expected<void> axes = plan_axes(options, scene->axes(), *plan); !axes) {
    return fail(axes.error(), kUsageError);
  }
  UpAxisCheck up;
  if (!options.mesh.empty()) up = {.up_B = plan->table.axes.up_B, .remedy = UpRemedy::kShipAxis};
  for (const Warning& warning : mesh_warnings(scene->scene, up)) print_warning(app, warning);
  if (plan->command == HydrostaticsCommand::kTanks) {
    const Expected<TankTables> tables = tank_tables(*scene, options, *plan);
    if (!tables) return fail(tables.error(), kUsageError);
    return write_output(
        app, options,
        Output{options.json ? json_lines(tank_tables_json(*tables)) : tank_tables_text(*tables),
               tank_tables_csv(*tables), ""});
  }
  const Expected<LoadedBody> loaded = load_body(*std::move(scene), *plan);
  if (!loaded) return fail(loaded.error(), kUsageError);
  plan->table.knows_mass = loaded->knows_mass;
  if (loaded->assumed_mass) print_warning(app, *loaded->assumed_mass);

  Expected<Output> output;
  switch (plan->command) {
    case HydrostaticsCommand::kEquilibrium:
      output = equilibrium_output(*loaded, options, *plan, three);
      break;
    case HydrostaticsCommand::kTable:
      output = table_output(*loaded, options, *plan, three);
      break;
    case HydrostaticsCommand::kRightingArms:
      output = righting_output(*loaded, options, *plan, three);
      break;
    case HydrostaticsCommand::kBallast:
      output = ballast_output(app, *loaded, options, *plan);
      break;
    case HydrostaticsCommand::kTanks:
      break;  // written above
    case HydrostaticsCommand::kKgLimit:
      output = kg_limit_output(*loaded, options, *plan);
      break;
  }
  return write_output(app, options, output);
}

}  // namespace
}  // namespace buoyancy::service

int main(int argc, char** argv) {
  return buoyancy::service::run(argc, argv);
}
