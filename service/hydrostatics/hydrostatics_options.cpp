#include "service/hydrostatics/hydrostatics_options.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "base/angles.h"
#include "base/csv_field.h"
#include "base/format.h"
#include "cli/channel_options.h"
#include "cli/command_line.h"
#include "cli/mesh_options.h"

namespace buoyancy::service {
namespace {

constexpr std::array<std::pair<const char*, HydrostaticsCommand>, 6> kCommands{
    {{"equilibrium", HydrostaticsCommand::kEquilibrium},
     {"table", HydrostaticsCommand::kTable},
     {"gz", HydrostaticsCommand::kRightingArms},
     {"ballast", HydrostaticsCommand::kBallast},
     {"tanks", HydrostaticsCommand::kTanks},
     {"kg-limit", HydrostaticsCommand::kKgLimit}}};

Expected<Vec3> parse_point(const std::string& subject, const std::string& text) {
  if (const std::optional<Vec3> point = parse_vector(text)) return *point;
  return make_error({subject, quote(text), "three finite numbers, X,Y,Z in metres", "", ""});
}

std::vector<double> in_radians(std::vector<double> degrees) {
  for (double& value : degrees) value *= kRadiansPerDegree;
  return degrees;
}

Expected<void> check_angles(const std::string& subject, const std::vector<double>& degrees, double limit) {
  for (const double value : degrees) {
    if (std::abs(value) <= limit) continue;
    return make_error(
        {subject, CLI::detail::to_string(value) + " degrees",
         "-" + CLI::detail::to_string(limit) + " to " + CLI::detail::to_string(limit) + " degrees", "", ""});
  }
  return {};
}

const char* name_of(HydrostaticsCommand command) {
  return kCommands[static_cast<std::size_t>(command)].first;
}

// Refuses options that the command does not use, and a command that lacks one that it needs.
Expected<void> check_command_options(const CLI::App& app, HydrostaticsCommand command) {
  using enum HydrostaticsCommand;
  struct Use {
    const char* option;
    std::vector<HydrostaticsCommand> commands;
  };
  const std::vector<Use> uses{{"--unstable", {kEquilibrium}},
                              {"--submerged", {kEquilibrium}},
                              {"--draft", {kTable, kBallast, kKgLimit}},
                              {"--heel", {kRightingArms, kBallast, kTanks}},
                              {"--fixed-trim", {kRightingArms, kKgLimit}},
                              {"--deck-edge", {kRightingArms, kKgLimit}},
                              {"--downflooding", {kRightingArms, kKgLimit}},
                              {"--windage-area", {kRightingArms, kKgLimit}},
                              {"--marks", {kEquilibrium, kTable, kRightingArms}},
                              {"--freeboard", {kEquilibrium, kTable, kRightingArms}},
                              {"--body-mass", {kBallast}},
                              {"--at", {kBallast}},
                              {"--along", {kBallast}},
                              {"--tank", {kTanks}},
                              {"--sounding", {kTanks}},
                              {"--sounding-at", {kTanks}},
                              {"--html", {kEquilibrium, kTable, kRightingArms}}};
  for (const Use& use : uses) {
    if (app.count(use.option) == 0 || std::ranges::count(use.commands, command) > 0) continue;
    std::string commands;
    for (const HydrostaticsCommand other : use.commands) {
      commands += (commands.empty() ? "the command " : " or ") + std::string(name_of(other));
    }
    return make_error({use.option, "with another command", commands, "", ""});
  }
  const bool is_by_draft = command == kTable || command == kKgLimit;
  const bool has_trim =
      is_by_draft || command == kBallast || command == kTanks || app.count("--fixed-trim") > 0;
  if (app.count("--trim") > 0 && !has_trim) {
    return make_error({"--trim", "without --fixed-trim",
                       "the command table, kg-limit, ballast or tanks, or gz with --fixed-trim",
                       "a body trims freely", ""});
  }
  if (is_by_draft && app.count("--draft") == 0) {
    return make_error({name_of(command), "no --draft", "--draft FROM:TO:STEP in metres", "",
                       "For instance --draft 1:5:0.5"});
  }
  return {};
}

// Sets the mass and the centre of mass of a mesh: of the command ballast its mass is --body-mass, since
// --mass is that of the ballast.
Expected<void> plan_mass(const HydrostaticsOptions& options, HydrostaticsPlan& plan) {
  const bool is_ballast = plan.command == HydrostaticsCommand::kBallast;
  const char* name = is_ballast ? "--body-mass" : "--mass";
  plan.mass = is_ballast ? options.body_mass : options.mass;
  if (options.mesh.empty()) {
    if (!plan.mass) return {};
    return make_error({name, "with --scene", "--mesh", "the scene says what the body weighs",
                       "Set mass in its section [body.client]"});
  }
  const bool has_center = !options.center_of_mass.empty();
  if (!plan.mass && !has_center && !needs_mass(plan.command)) return {};
  if (!plan.mass || !has_center) {
    return make_error(
        {"--mesh", std::string("without ") + (plan.mass ? "--center-of-mass" : name),
         std::string(name) + " and --center-of-mass of the body",
         is_ballast && options.mass ? "--mass is that of the ballast" : "what floats has a mass",
         std::string("For instance ") + name + " 1000 --center-of-mass 0,0,0.5"});
  }
  const Expected<Vec3> center = parse_point("--center-of-mass", options.center_of_mass);
  if (!center) return tl::unexpected(center.error());
  plan.center_of_mass_B = *center;
  return {};
}

Expected<void> plan_ranges(const HydrostaticsOptions& options, HydrostaticsPlan& plan) {
  if (!options.drafts.empty()) {
    Expected<std::vector<double>> drafts = parse_range("--draft", options.drafts);
    if (!drafts) return tl::unexpected(drafts.error());
    plan.drafts = *std::move(drafts);
  }
  Expected<std::vector<double>> trims = parse_range("--trim", options.trims);
  if (!trims) return tl::unexpected(trims.error());
  if (Expected<void> checked = check_angles("--trim", *trims, 89.0); !checked) return checked;
  plan.trims = in_radians(*std::move(trims));
  Expected<std::vector<double>> heels = parse_range("--heel", options.heels);
  if (!heels) return tl::unexpected(heels.error());
  if (Expected<void> checked = check_angles("--heel", *heels, 180.0); !checked) return checked;
  plan.heels = in_radians(*std::move(heels));
  if (!options.soundings.empty()) {
    Expected<std::vector<double>> soundings = parse_range("--sounding", options.soundings);
    if (!soundings) return tl::unexpected(soundings.error());
    plan.soundings = *std::move(soundings);
  }
  if (options.fixed_trim) {
    if (plan.trims.size() != 1) {
      return make_error({"--trim", quote(options.trims), "one number with --fixed-trim", "", ""});
    }
    plan.arms.fixed_trim = plan.trims.front();
  }
  return {};
}

Expected<std::vector<Vec3>> parse_points(const std::string& subject, const std::vector<std::string>& texts) {
  std::vector<Vec3> points;
  for (const std::string& text : texts) {
    const Expected<Vec3> point = parse_point(subject, text);
    if (!point) return tl::unexpected(point.error());
    points.push_back(*point);
  }
  return points;
}

// NAME=X,Y
Expected<DraftMark> parse_mark(const std::string& text) {
  const std::size_t equals = text.find('=');
  DraftMark mark{.name = text.substr(0, equals)};
  const auto in_name = [](char c) {
    return c == '_' || c == '-' || std::isalnum(static_cast<unsigned char>(c));
  };
  if (equals != std::string::npos && !mark.name.empty() && std::ranges::all_of(mark.name, in_name)) {
    const std::vector<std::string_view> parts = split(std::string_view(text).substr(equals + 1), ',');
    if (parts.size() == 2 && parse_finite(parts[0], mark.forward) && parse_finite(parts[1], mark.port)) {
      return mark;
    }
  }
  return make_error({"--marks", quote(text),
                     "NAME=X,Y: a name of letters, digits, _ and -, and metres forward and to port", "",
                     "For instance --marks aft=-40,0 fwd=40,0"});
}

Expected<void> plan_water_points(const HydrostaticsOptions& options, WaterPoints& points) {
  for (const std::string& text : options.marks) {
    const Expected<DraftMark> mark = parse_mark(text);
    if (!mark) return tl::unexpected(mark.error());
    if (std::ranges::count(points.marks, mark->name, &DraftMark::name) > 0) {
      return make_error({"--marks", "two marks " + quote(mark->name), "a name for each mark", "", ""});
    }
    points.marks.push_back(*mark);
  }
  Expected<std::vector<Vec3>> freeboards = parse_points("--freeboard", options.freeboards);
  if (!freeboards) return tl::unexpected(freeboards.error());
  points.freeboards_B = *std::move(freeboards);
  return {};
}

Expected<void> plan_points(const HydrostaticsOptions& options, HydrostaticsPlan& plan) {
  Expected<std::vector<Vec3>> deck_edge = parse_points("--deck-edge", options.deck_edges);
  if (!deck_edge) return tl::unexpected(deck_edge.error());
  plan.points.deck_edge_B = *std::move(deck_edge);
  Expected<std::vector<Vec3>> downflooding = parse_points("--downflooding", options.downfloodings);
  if (!downflooding) return tl::unexpected(downflooding.error());
  plan.points.downflooding_B = *std::move(downflooding);
  return {};
}

// Precondition: plan_ranges() was called.
Expected<void> plan_tanks(const CLI::App& app, const HydrostaticsOptions& options, HydrostaticsPlan& plan) {
  if (app.count("--heel") == 0) plan.heels = {0.0};
  for (const double heel : plan.heels) {
    // A level that a pipe along the ship's upward axis does not meet has no sounding.
    if (Expected<void> checked = check_angles("--heel", {heel * kDegreesPerRadian}, 89.0); !checked) {
      return checked;
    }
  }
  if (options.sounding_at.empty()) return {};
  const Expected<Vec3> foot = parse_point("--sounding-at", options.sounding_at);
  if (!foot) return tl::unexpected(foot.error());
  plan.sounding_foot_B = *foot;
  return {};
}

}  // namespace

bool needs_mass(HydrostaticsCommand command) {
  using enum HydrostaticsCommand;
  return command == kEquilibrium || command == kRightingArms || command == kBallast;
}

Expected<void> plan_axes(const HydrostaticsOptions& options, const ShipAxes& own, HydrostaticsPlan& plan) {
  ShipAxes axes = own;
  if (!options.up.empty()) {
    const Expected<Vec3> up_B = parse_axis("--up", options.up);
    if (!up_B) return tl::unexpected(up_B.error());
    axes = axes_with_up(*up_B);
  }
  if (!options.forward.empty()) {
    const Expected<Vec3> forward_B = parse_axis("--forward", options.forward);
    if (!forward_B) return tl::unexpected(forward_B.error());
    axes.forward_B = *forward_B;
  }
  const Expected<ShipAxes> checked = make_ship_axes(axes.forward_B, axes.up_B);
  if (!checked) return tl::unexpected(checked.error());
  plan.table.axes = *checked;
  plan.arms.axes = *checked;
  plan.ballast.axes = *checked;
  return {};
}

Expected<std::vector<double>> parse_range(const std::string& subject, const std::string& text) {
  constexpr double kMaxValues = 100'000.0;
  const std::vector<std::string_view> parts = split(text, ':');
  double from = 0.0;
  double to = 0.0;
  double step = 1.0;
  if (parts.size() == 1 && parse_finite(parts[0], from)) return std::vector<double>{from};
  if (parts.size() == 3 && parse_finite(parts[0], from) && parse_finite(parts[1], to) &&
      parse_finite(parts[2], step) && step > 0.0 && to >= from && (to - from) / step < kMaxValues) {
    std::vector<double> values;
    const auto count = static_cast<int>(std::floor((to - from) / step * (1.0 + 1e-12) + 1e-9));
    for (int i = 0; i <= count; ++i) values.push_back(std::min(from + i * step, to));
    return values;
  }
  return make_error({subject, quote(text),
                     "FROM:TO:STEP with FROM <= TO and a STEP above 0, at most 100000 values, or one number",
                     "", ""});
}

namespace {

std::string with_default(std::string type, double value) {
  return type.append(" [").append(format_shortest(value)).append("]");
}

// Adds the options that say with --mesh what a scene file says otherwise.
void add_mesh_options(CLI::App& app, CLI::Option* mesh, HydrostaticsOptions& options) {
  constexpr double kMax = 1e9;
  add_scale_option(app, options.scale, mesh);
  app.add_option("--density", options.density,
                 "With --mesh: density of the water, or of the tank's liquid, kg/m^3")
      ->needs(mesh)
      ->check(number_in(0.0, kMax, "kg/m^3"))
      ->option_text(with_default("RHO", options.density));
  app.add_option("--gravity", options.gravity, "With --mesh: gravity, m/s^2")
      ->needs(mesh)
      ->check(number_in(0.0, kMax, "m/s^2"))
      ->option_text(with_default("G", options.gravity));
  app.add_option("--open", options.open,
                 "With --mesh: dry_boundary accepts a mesh with holes and evaluates it while their edges are "
                 "dry")
      ->needs(mesh)
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, OpenPolicy>(kOpenPolicyNames.begin(), kOpenPolicyNames.end())))
      ->option_text("refuse|dry_boundary [refuse]");
}

// Adds what the weather criterion needs.
void add_weather_options(CLI::App& app, WeatherExposure& exposure) {
  constexpr double kMax = 1e9;
  CLI::Option* area =
      app.add_option("--windage-area", exposure.windage_area,
                     "gz, kg-limit: lateral area over the water, m^2; also evaluate the weather "
                     "criterion of the 2008 IS Code")
          ->check(number_in(0.0, kMax, "m^2"))
          ->option_text("A");
  CLI::Option* lever = app.add_option("--windage-lever", exposure.windage_lever,
                                      "Height of the centre of that area over the centre of the lateral area "
                                      "under water, or over half the draft, m")
                           ->needs(area)
                           ->check(number_in(0.0, kMax, "m"))
                           ->option_text("Z");
  area->needs(lever);
  app.add_option("--wind-pressure", exposure.wind_pressure, "Pressure of the wind, Pa")
      ->needs(area)
      ->check(number_in(0.0, kMax, "Pa"))
      ->option_text(with_default("P", exposure.wind_pressure));
  app.add_option("--bilge-keel-area", exposure.bilge_keel_area,
                 "Area of the bilge keels, and of the side view of a bar keel, m^2")
      ->needs(area)
      ->check(number_in(0.0, kMax, "m^2"))
      ->option_text(with_default("AK", exposure.bilge_keel_area));
  app.add_flag("--sharp-bilges", exposure.sharp_bilges, "The bilges are sharp")->needs(area);
}

}  // namespace

void add_options(CLI::App& app, HydrostaticsOptions& options) {
  app.description(
      "Compute where and how a body floats: its equilibrium attitudes, righting arms, hydrostatic tables,\n"
      "permissible KG, where ballast belongs, and tank tables. Angles are in degrees, heel positive to\n"
      "starboard, trim positive by the stern.\n" +
      exit_status_help(
          {.success = "on success, also if the body sinks",
           .failure =
               "on a runtime error, if a righting arm, a row or a limit has no result, or if no stable\n"
               "ballast is found",
           .usage_error = "on invalid arguments, scene or mesh"}));
  app.set_version_flag("--version", "buoyancy-hydrostatics " BUOYANCY_VERSION);
  auto* from = app.add_option_group("body", "Input geometry (exactly one)");
  CLI::Option* scene = from->add_option("--scene", options.scene, "Scene file (TOML): water and bodies");
  CLI::Option* mesh = from->add_option("--mesh", options.mesh, "One mesh, in water of level 0");
  from->require_option(1);
  app.add_option("--body", options.body, "With --scene: id of the body (default: the only one)")
      ->needs(scene)
      ->option_text("ID");
  app.add_option("--mass", options.mass, "With --mesh: mass, kg; ballast: mass of the ballast")
      ->check(CLI::PositiveNumber)
      ->option_text("M");
  app.add_option("--body-mass", options.body_mass,
                 "ballast with --mesh: mass of the body without the ballast, kg")
      ->check(CLI::PositiveNumber)
      ->option_text("M");
  app.add_option("--center-of-mass", options.center_of_mass,
                 "With --mesh: centre of mass in the frame of the (scaled) mesh, m")
      ->needs(mesh)
      ->option_text("X,Y,Z");
  add_mesh_options(app, mesh, options);
  app.add_option("--forward", options.forward,
                 "The ship's forward axis in the frame of the mesh: x, --forward=-x, y ...")
      ->option_text("AXIS [x, or y where up is along x]");
  app.add_option("--up", options.up,
                 "The ship's upward axis, likewise (default: that of the body or of the "
                 "scene's world; with --mesh z)")
      ->option_text("AXIS");
  app.add_option("--keel", options.keel,
                 "Height of the keel K in the frame of the mesh, m (default: its lowest point)")
      ->option_text("Z");
  app.add_option("--aft-perpendicular", options.aft_perpendicular,
                 "Along the forward axis, m (default: the aft end of the mesh)")
      ->option_text("X");
  app.add_option("--forward-perpendicular", options.forward_perpendicular,
                 "Along the forward axis, m (default: the forward end of the mesh)")
      ->option_text("X");
  app.add_flag("--unstable", options.unstable, "equilibrium: also report unstable attitudes");
  app.add_flag("--submerged", options.submerged,
               "equilibrium: also report how a body that floats rests, and rises, fully submerged");
  app.add_option("--draft", options.drafts,
                 "table, kg-limit: drafts over the keel at midship, m; ballast: draft of the lowest point")
      ->option_text("FROM:TO:STEP");
  app.add_option("--trim", options.trims,
                 "table, kg-limit, tanks: trims, degrees; gz: the fixed trim; ballast: the target [0]")
      ->option_text("FROM:TO:STEP [0]");
  app.add_option("--heel", options.heels, "gz, tanks: heels, degrees; ballast: the target [0]")
      ->option_text("FROM:TO:STEP [gz: -180:180:5, tanks: 0]");
  app.add_flag("--fixed-trim", options.fixed_trim,
               "gz, kg-limit: fix the trim at that of --trim, instead of letting the body trim");
  app.add_option(
         "--at", options.ballast_places,
         "ballast: where it is, in the frame of the mesh, m; twice: split it. Default: find the place")
      ->allow_extra_args(false)
      ->option_text("X,Y,Z");
  app.add_option("--along", options.ballast_line,
                 "ballast: find the place on the line along this axis through --at, or else the origin")
      ->option_text("x|y|z");
  app.add_option("--deck-edge", options.deck_edges,
                 "gz, kg-limit: a point of the deck edge in the frame of the mesh, m; report the heels to "
                 "either side "
                 "at which the first goes under water. Repeatable")
      ->allow_extra_args(false)
      ->option_text("X,Y,Z");
  app.add_option("--downflooding", options.downfloodings,
                 "gz, kg-limit: an opening that lets water in; the same, and the curve of the criteria ends "
                 "there. "
                 "Repeatable")
      ->allow_extra_args(false)
      ->option_text("X,Y,Z");
  app.add_option("--tank", options.tank,
                 "tanks: the number of one of the body's tanks, from 0 (default: all of them)")
      ->needs(scene)
      ->option_text("N");
  app.add_option("--sounding", options.soundings,
                 "tanks: heights of the liquid over the foot of the sounding pipe along the ship's upward "
                 "axis, m (default: 11 of the upright tank)")
      ->option_text("FROM:TO:STEP");
  app.add_option(
         "--sounding-at", options.sounding_at,
         "tanks: the foot of the sounding pipe in the frame of the mesh, m (default: at the height of "
         "the tank's lowest point, under its centre)")
      ->option_text("X,Y,Z");
  app.add_option("--marks", options.marks,
                 "equilibrium, gz, table: print the draft at this place of the base line, metres along the "
                 "forward and port axes. Several, and repeatable")
      ->option_text("NAME=X,Y ...");
  app.add_option(
         "--freeboard", options.freeboards,
         "equilibrium, gz, table: print the height over the water of a point in the frame of the mesh, "
         "m. Repeatable")
      ->allow_extra_args(false)
      ->option_text("X,Y,Z");
  add_weather_options(app, options.exposure);
  app.add_option("--csv", options.csv, "Also write the results to a CSV file")->option_text("FILE");
  CLI::Option* html = app.add_option("--html", options.html,
                                     "Also write the results as one HTML page, with plots and the hull")
                          ->option_text("FILE");
  app.add_option("--three", options.three,
                 "With --html: three.js library (three.min.js) to embed in the page")
      ->needs(html)
      ->capture_default_str();
  app.add_flag("--json", options.json, "Print the results as JSON");
  app.add_option("COMMAND", options.command, "equilibrium, table, gz, ballast, tanks or kg-limit")
      ->required()
      ->check(CLI::IsMember({"equilibrium", "table", "gz", "ballast", "tanks", "kg-limit"}))
      ->option_text("equilibrium|table|gz|ballast|tanks|kg-limit");
}

namespace {

// Reads the target and the places, after the ranges of draft, heel and trim.
Expected<void> plan_ballast(const CLI::App& app, const HydrostaticsOptions& options, HydrostaticsPlan& plan) {
  if (plan.command != HydrostaticsCommand::kBallast) return {};
  const auto one_of = [&app](const char* name, const std::vector<double>& values) -> Expected<double> {
    if (app.count(name) == 0) return 0.0;
    if (values.size() == 1) return values.front();
    return make_error({name, std::to_string(values.size()) + " values", "one number with ballast", "", ""});
  };
  const Expected<double> heel = one_of("--heel", plan.heels);
  if (!heel) return tl::unexpected(heel.error());
  const Expected<double> trim = one_of("--trim", plan.trims);
  if (!trim) return tl::unexpected(trim.error());
  const Expected<double> draft = one_of("--draft", plan.drafts);
  if (!draft) return tl::unexpected(draft.error());
  if (!options.mass && app.count("--draft") == 0) {
    return make_error({"ballast", "neither --mass nor --draft", "--mass M in kg, or --draft D in metres",
                       "one of them decides how deep the body lies", "For instance --mass 100"});
  }
  plan.ballast = {.target = {*heel, *trim}, .mass = options.mass};
  if (app.count("--draft") > 0) plan.ballast.draft = *draft;
  Expected<std::vector<Vec3>> places = parse_points("--at", options.ballast_places);
  if (!places) return tl::unexpected(places.error());
  plan.ballast.places_B = *std::move(places);
  const std::size_t most = options.ballast_line.empty() ? 2 : 1;
  if (plan.ballast.places_B.size() > most) {
    return make_error({"--at", std::to_string(plan.ballast.places_B.size()) + " places",
                       "at most two, or one with --along", "", ""});
  }
  if (options.ballast_line.empty()) return {};
  const Expected<Vec3> along = parse_axis("--along", options.ballast_line);
  if (!along) return tl::unexpected(along.error());
  plan.ballast.along_B = *along;
  return {};
}

}  // namespace

Expected<HydrostaticsPlan> plan_hydrostatics(const CLI::App& app, const HydrostaticsOptions& options) {
  HydrostaticsPlan plan;
  for (const auto& [name, command] : kCommands) {
    if (options.command == name) plan.command = command;
  }
  if (const Expected<void> checked = check_command_options(app, plan.command); !checked) {
    return tl::unexpected(checked.error());
  }
  if (const Expected<void> mass = plan_mass(options, plan); !mass) return tl::unexpected(mass.error());
  if (!options.mesh.empty()) {
    const Expected<Vec3> scale = parse_scale(options.scale);
    if (!scale) return tl::unexpected(scale.error());
    plan.placement.scale = *scale;
  }
  plan.table = {.keel = options.keel,
                .aft_perpendicular = options.aft_perpendicular,
                .forward_perpendicular = options.forward_perpendicular};
  plan.arms.keel = options.keel;
  if (const Expected<void> ranges = plan_ranges(options, plan); !ranges) {
    return tl::unexpected(ranges.error());
  }
  if (plan.command == HydrostaticsCommand::kTanks) {
    if (const Expected<void> tanks = plan_tanks(app, options, plan); !tanks) {
      return tl::unexpected(tanks.error());
    }
  }
  if (const Expected<void> points = plan_points(options, plan); !points) {
    return tl::unexpected(points.error());
  }
  if (const Expected<void> points = plan_water_points(options, plan.water_points); !points) {
    return tl::unexpected(points.error());
  }
  if (const Expected<void> ballast = plan_ballast(app, options, plan); !ballast) {
    return tl::unexpected(ballast.error());
  }
  for (const std::filesystem::path& output : {options.csv, options.html}) {
    if (output.empty()) continue;
    const Expected<void> checked = check_output_not_input(output, {options.scene, options.mesh});
    if (!checked) return tl::unexpected(checked.error());
  }
  if (!options.csv.empty() && options.csv.lexically_normal() == options.html.lexically_normal()) {
    return make_error({"--html", options.html.string(), "another file than that of --csv", "", ""});
  }
  return plan;
}

}  // namespace buoyancy::service
