#include "service/hydrostatics/hydrostatics_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "base/angles.h"
#include "base/json.h"
#include "flotation/displaced_sum.h"
#include "service/hydrostatics/table_columns.h"
#include "view/page/base64.h"
#include "view/page/mesh_drawing.h"
#include "view/page/page_assets.h"

namespace buoyancy::service {
namespace {

constexpr std::size_t kStateNumbers = 19;

constexpr TableColumn kHeel{"heel", "Heel", "°"};
constexpr TableColumn kTrim{"trim", "Trim", "°"};
constexpr TableColumn kDraft{"draft", "Draft of the lowest point", "m"};

// Returns at most `max` of the numbers below count, ascending and evenly spaced, with the first and the last.
std::vector<std::size_t> evenly_chosen(std::size_t count, std::size_t max) {
  const std::size_t chosen = std::min(count, std::max<std::size_t>(max, 2));
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < chosen; ++i) {
    numbers.push_back(chosen == count ? i : i * (count - 1) / (chosen - 1));
  }
  return numbers;
}

using State = std::array<double, kStateNumbers>;

State state_at(const PageSubject& subject, const Pose& pose) {
  const Water& water = *subject.water;
  const std::optional<FloatingState> found = floating_state(*subject.body, pose, water);
  const Hydrostatics hydrostatics = found ? found->hydrostatics : Hydrostatics{};
  const Vec3 force_W = hydrostatics.density * water.gravity * hydrostatics.volume * water.up_W;
  State state{};
  auto* next = state.data();
  const auto add = [&next](const auto& numbers) { next = std::copy(numbers.begin(), numbers.end(), next); };
  add(pose.p_WB);
  add(std::array{pose.q_WB.w(), pose.q_WB.x(), pose.q_WB.y(), pose.q_WB.z()});
  add(force_W);
  add(hydrostatics.center_of_buoyancy_W);
  add(hydrostatics.metacenters_W[0]);
  const Vec3 up_B = pose.q_WB.conjugate() * water.up_W;
  add(total_center_of_mass_B(*subject.body, liquid_sum(*subject.body, up_B, FreeSurfaces::kNo)));
  return state;
}

// height: [m], of B's origin over the water.
Pose pose_at(const PageSubject& subject, const HeelTrim& angles, double height) {
  const Water& water = *subject.water;
  return {water.up_W * (water.level + height), attitude_at(subject.axes, angles, water.up_W)};
}

// The rows of a page, one after the other.
struct PageRows {
  std::vector<TableColumn> columns;
  std::vector<std::vector<double>> values;
  std::vector<State> states;
  std::size_t all = 0;    // of the results
  std::size_t group = 0;  // rows per group
};

std::string encoded_values(const PageRows& rows) {
  std::vector<double> numbers;
  numbers.reserve(rows.columns.size() * rows.values.size());
  for (std::size_t column = 0; column < rows.columns.size(); ++column) {
    for (const std::vector<double>& row : rows.values) numbers.push_back(row[column]);
  }
  return view::base64_of<double>(numbers);
}

std::string encoded_states(const PageRows& rows) {
  std::vector<double> numbers;
  numbers.reserve(kStateNumbers * rows.states.size());
  for (const State& state : rows.states) numbers.insert(numbers.end(), state.begin(), state.end());
  return view::base64_of<double>(numbers);
}

Json mesh_json(const FloatingBody& body) {
  view::MeshDrawing drawing;
  for (const FloatingBody::SignedVolume& volume : body.volumes()) {
    if (volume.placed.signed_permeability < 0.0) continue;
    view::append(drawing, volume.placed.mesh->surface, volume.R_B, volume.offset_B);
  }
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  for (std::size_t i = 0; i + 2 < drawing.positions.size(); i += 3) {
    const Vec3 vertex(drawing.positions[i], drawing.positions[i + 1], drawing.positions[i + 2]);
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  const std::size_t triangles = drawing.triangle_count();
  view::reduce(drawing, view::kMaxDrawnTriangles);
  return {{"center", body.center_B()},
          {"diagonal", (high - low).norm()},
          {"volume", body.volume()},
          {"triangles", triangles},
          {"shown_triangles", drawing.triangle_count()},
          {"positions", view::base64_of<float>(drawing.positions)},
          {"indices", view::base64_of<std::uint32_t>(drawing.indices)}};
}

Json model_json(const PageSubject& subject, bool with_mass) {
  const Water& water = *subject.water;
  const FloatingBody& body = *subject.body;
  return {
      {"water",
       {{"up", water.up_W}, {"level", water.level}, {"density", water.density}, {"gravity", water.gravity}}},
      {"bodies", Json::array({{{"id", 1},
                               {"mesh", 0},
                               {"mass", with_mass ? std::optional(body.total_mass()) : std::nullopt},
                               {"center_of_mass",
                                with_mass ? std::optional(body.center_of_mass_B()) : std::nullopt}}})},
      {"meshes", Json::array({mesh_json(body)})}};
}

Json page_data(const PageSubject& subject, const char* command, const PageRows& rows, Json results,
               bool with_mass) {
  Json columns = Json::array();
  for (const TableColumn& column : rows.columns) {
    columns.push_back({{"name", column.name}, {"title", column.title}, {"unit", column.unit}});
  }
  return {{"version", BUOYANCY_VERSION},
          {"name", subject.name},
          {"command", command},
          {"mass", subject.body->mass()},
          {"total_mass", subject.body->total_mass()},
          {"center_of_mass", subject.body->center_of_mass_B()},
          {"model", model_json(subject, with_mass)},
          {"columns", std::move(columns)},
          {"values", encoded_values(rows)},
          {"rows", rows.values.size()},
          {"all_rows", rows.all},
          {"group_rows", rows.group},
          {"states", encoded_states(rows)},
          {"rests", Json::array()},
          {"results", std::move(results)},
          {"outcome_text", ""}};
}

std::string page_of(const Json& data, std::string_view three) {
  std::string page = view::self_contained_page("hydrostatics.html", three);
  view::insert_data(page, json_line(data));
  return page;
}

// Returns the stable attitudes among heel 0 and the heels at which the righting arm vanishes.
Json rests_json(const PageSubject& subject, const RightingResults& results,
                const RightingArmOptions& options) {
  constexpr double kStep = 1e-4;  // [rad]
  const FloatingBody& body = *subject.body;
  const auto arm_at = [&](double heel, double trim) {
    return righting_arm(body, *subject.water, heel, options, trim);
  };
  std::vector<RightingArm> arms;
  const std::optional<RightingArm> upright = arm_at(0.0, 0.0);
  const std::optional<RightingArm> left = arm_at(-kStep, 0.0);
  const std::optional<RightingArm> right = arm_at(kStep, 0.0);
  if (upright && left && right && left->gz < 0.0 && right->gz > 0.0) arms.push_back(*upright);
  for (const ArmCrossing& crossing : results.curve.crossings) {
    if (!crossing.returns) continue;
    const auto nearest = std::ranges::min_element(results.curve.points, {}, [&](const auto& point) {
      return std::abs(point.arm.heel - crossing.heel);
    });
    if (const auto arm = arm_at(crossing.heel, nearest->arm.trim)) arms.push_back(*arm);
  }
  std::ranges::sort(arms, {}, &RightingArm::heel);
  // Heels of 180 degrees to either side are the same attitude.
  constexpr double kTurn = 2.0 * std::numbers::pi;
  if (arms.size() > 1 && arms.back().heel - arms.front().heel > kTurn - 1e-9) arms.erase(arms.begin());
  Json rests = Json::array();
  for (const RightingArm& arm : arms) {
    rests.push_back({{"heel", arm.heel * kDegreesPerRadian},
                     {"trim", arm.trim * kDegreesPerRadian},
                     {"draft", arm.draft},
                     {"state", state_at(subject, pose_at(subject, {arm.heel, arm.trim}, arm.height))}});
  }
  return rests;
}

}  // namespace

std::string equilibria_page(const PageSubject& subject, const Equilibria& equilibria,
                            const SubmergedResult* submerged, std::string_view three) {
  PageRows rows;
  rows.columns = {kHeel, kTrim, kDraft};
  for (const Equilibrium& at : equilibria.attitudes) {
    rows.values.push_back({at.angles.heel * kDegreesPerRadian, at.angles.trim * kDegreesPerRadian, at.draft});
    rows.states.push_back(state_at(subject, at.pose));
  }
  rows.all = rows.group = rows.values.size();
  Json data = page_data(subject, "equilibrium", rows, equilibria_json(equilibria, {}, {}, submerged), true);
  std::string text;
  if (equilibria.attitudes.empty()) text = outcome_sentence(equilibria.outcome);
  if (submerged != nullptr) {
    if (!text.empty()) text += ' ';
    text += submerged_text(*submerged);
  }
  if (!text.empty()) data["outcome_text"] = text;
  return page_of(data, three);
}

std::string righting_page(const PageSubject& subject, const RightingResults& results,
                          const RightingArmOptions& options, std::string_view three) {
  PageRows rows;
  rows.columns = {kHeel,
                  {"gz", "GZ, righting arm", "m"},
                  {"kn", "KN", "m"},
                  {"area", "Area under GZ from heel 0", "m rad"},
                  kTrim,
                  kDraft};
  for (const std::size_t i : evenly_chosen(results.curve.points.size(), kMaxPageRows)) {
    const auto& [arm, area] = results.curve.points[i];
    rows.values.push_back(
        {arm.heel * kDegreesPerRadian, arm.gz, arm.kn, area, arm.trim * kDegreesPerRadian, arm.draft});
    rows.states.push_back(state_at(subject, pose_at(subject, {arm.heel, arm.trim}, arm.height)));
  }
  rows.all = results.curve.points.size();
  rows.group = rows.values.size();
  Json json = righting_json(results, {});
  json.erase("points");
  Json data = page_data(subject, "gz", rows, std::move(json), true);
  data["rests"] = rests_json(subject, results, options);
  return page_of(data, three);
}

std::string table_page(const PageSubject& subject, const HydrostaticTable& table, const TableRows& rows,
                       std::size_t drafts, std::string_view three) {
  const std::span<const TableColumn> columns = table_columns();
  PageRows shown;
  shown.columns.assign(columns.begin(), columns.end());
  const std::vector<std::size_t> trims = evenly_chosen(rows.size() / drafts, kMaxPageRows / 10);
  const std::vector<std::size_t> chosen = evenly_chosen(drafts, kMaxPageRows / trims.size());
  for (const std::size_t trim : trims) {
    for (const std::size_t draft : chosen) {
      const HydrostaticRow& row = rows[trim * drafts + draft];
      const Vec3 on_water_B =
          table.midship() * subject.axes.forward_B + (table.keel() + row.draft) * subject.axes.up_B;
      const HeelTrim angles{0.0, row.trim};
      const double height = -up_at(subject.axes, angles).dot(on_water_B);
      shown.values.push_back(values_of(row));
      shown.states.push_back(state_at(subject, pose_at(subject, angles, height)));
    }
  }
  shown.all = rows.size();
  shown.group = chosen.size();
  Json results{{"keel", table.keel()},
               {"midship", table.midship()},
               {"length_between_perpendiculars", table.length_between_perpendiculars()}};
  return page_of(page_data(subject, "table", shown, std::move(results), false), three);
}

}  // namespace buoyancy::service
