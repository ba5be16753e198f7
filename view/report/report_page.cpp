#include "view/report/report_page.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <vector>

#include "engine/body_evaluation.h"
#include "engine/subdivision_load.h"
#include "hydrostatics/hydrostatics.h"
#include "view/common/body_statuses.h"
#include "view/common/scene_model.h"
#include "view/common/sea_json.h"
#include "view/page/base64.h"
#include "view/page/page_assets.h"

namespace buoyancy::view {
namespace {

constexpr std::size_t kMaxTimedQueries = 200;

BodyState body_state(const Body& body, const RunRow& row) {
  return {.body_id = body.id,
          .position = {row[kPx], row[kPy], row[kPz]},
          .quaternion_wxyz = {row[kQw], row[kQx], row[kQy], row[kQz]},
          .linear_velocity = {},
          .angular_velocity = {}};
}

// The median duration [ns] of `query` over the rows for which it returns true; null if there are none.
template <typename Query>
Json median_time(const Body& body, const BodyRun& run, Query query) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> times;
  const std::size_t stride = std::max<std::size_t>(1, run.rows.size() / kMaxTimedQueries);
  for (std::size_t i = 0; i < run.rows.size(); i += stride) {
    const ValidatedPose pose = validate_pose(body_state(body, run.rows[i]), 0.0);
    if (pose.status != BodyStatus::kOk) continue;
    const Clock::time_point start = Clock::now();
    const bool counted = query(pose);
    if (counted) times.push_back(std::chrono::duration<double, std::nano>(Clock::now() - start).count());
  }
  if (times.empty()) return nullptr;
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::ranges::nth_element(times, middle);
  return *middle;
}

// How the body's rows are evaluated, and the cost [ns] of an evaluation from the bounds and of a full query.
Json evaluations_json(const Body& body, const BodyRun& run, const Water& water) {
  const FullySubmerged submerged = submerged_constants(body.solver.mesh(), water, body.reference_B);
  BodyOutcome outcome;
  return {{"unchanged", run.evaluations.unchanged},
          {"dry", run.evaluations.dry},
          {"wet", run.evaluations.wet},
          {"crossing", run.evaluations.crossing},
          {"rejected", run.evaluations.rejected},
          {"bounds_ns",
           median_time(body, run,
                       [&](const ValidatedPose& pose) {
                         return try_evaluate_from_bounds(body, submerged, {&water, nullptr}, pose, outcome);
                       })},
          {"query_ns", median_time(body, run, [&](const ValidatedPose& pose) {
             evaluate(body, {&water, nullptr}, pose, outcome);
             return body.subdivision != nullptr || outcome.result.immersion == Immersion::kPiercing;
           })}};
}

// The columns in the page: those of the sea do not exist in water at rest.
std::size_t column_count(const Scene& scene) {
  return has_waves(scene) ? kColumnCount : kSeaTime;
}

// Base64 of the rows, column by column.
std::string encode_rows(const std::vector<RunRow>& rows, std::size_t columns) {
  std::vector<double> numbers;
  numbers.reserve(rows.size() * columns);
  for (std::size_t column = 0; column < columns; ++column) {
    for (const RunRow& row : rows) numbers.push_back(row[column]);
  }
  return base64_of<double>(numbers);
}

// Returns the condition of a row; nullptr: it is that of the scene file, or unknown.
const BodyCondition* condition_of(const BodyRun& run, std::size_t row) {
  if (run.conditions.empty()) return nullptr;
  const std::optional<BodyCondition>& condition = run.conditions[run.condition_of_row[row]];
  return condition ? &*condition : nullptr;
}

Json conditions_json(const BodyRun& run) {
  Json list = Json::array();
  for (const std::optional<BodyCondition>& condition : run.conditions) {
    if (condition) {
      list.push_back({{"flooded", condition->flooded}, {"liquid_volumes", condition->liquid_volumes}});
    } else {
      list.push_back(nullptr);
    }
  }
  return {{"list", std::move(list)}, {"rows", base64_of<std::uint32_t>(run.condition_of_row)}};
}

// Base64 of two points per row [m], W axes, relative to B's origin; NaN if there are none.
std::string encode_metacenters(const Body& body, const BodyRun& run, const Water& water) {
  std::vector<float> numbers;
  numbers.reserve(run.rows.size() * 6);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const RunRow& row = run.rows[i];
    const ValidatedPose pose = validate_pose(body_state(body, row), 0.0);
    std::optional<Hydrostatics> found;
    if (pose.status == BodyStatus::kOk && row[kStatus] == 0.0) {
      found =
          body.subdivision == nullptr
              ? hydrostatics(body.solver.mesh(), pose.pose, water, body.reference_B, body.center_of_mass_B)
              : subdivided_hydrostatics(body, condition_of(run, i), water, pose.pose);
    }
    const Hydrostatics shown = found.value_or(Hydrostatics{});
    for (const Vec3& center : shown.metacenters_W) {
      for (const double coordinate : center) numbers.push_back(static_cast<float>(coordinate));
    }
  }
  return base64_of<float>(numbers);
}

Json loads_json(const BodyRun& run) {
  std::vector<float> numbers;
  numbers.reserve(run.loads.size() * kLoadColumnCount);
  for (std::size_t column = 0; column < kLoadColumnCount; ++column) {
    for (const LoadRow& row : run.loads) numbers.push_back(static_cast<float>(row[column]));
  }
  return {{"data", base64_of<float>(numbers)},
          {"recorded", run.loads_recorded},
          {"computed", run.loads_computed},
          {"without_velocities", run.loads_without_velocities}};
}

Json status_json(const ServiceStatus& status) {
  const ServiceCounters& counters = status.counters;
  return {{"version", status.version},
          {"uptime", status.uptime},
          {"requests", counters.requests},
          {"computed", counters.computed},
          {"retries", counters.retries},
          {"superseded", counters.superseded},
          {"rejected", counters.rejected()},
          {"dry", counters.bodies_dry},
          {"wet", counters.bodies_wet},
          {"crossing", counters.bodies_crossing},
          {"unchanged", counters.bodies_unchanged},
          {"p50", status.latency.p50},
          {"p99", status.latency.p99},
          {"max", status.latency.max}};
}

Json seas_json(const RecordedRun& run) {
  Json seas = Json::array();
  for (const std::shared_ptr<const SeaPeriod>& sea : run.seas) seas.push_back(sea_json(*sea));
  return seas;
}

Json surfaces_json(const RecordedRun& run) {
  Json surfaces = Json::array();
  for (const DrawnSurface& drawn : run.surfaces) {
    surfaces.push_back(drawn.sea);
    surfaces.back()["time"] = drawn.time;
  }
  return surfaces;
}

}  // namespace

std::string report_data(const Scene& scene, const RecordedRun& run, const ReportOptions& options) {
  Json data{{"file", options.file},
            {"version", options.version},
            {"body_statuses", body_statuses()},
            {"columns", std::vector(kColumnNames.begin(), kColumnNames.begin() + column_count(scene))},
            {"selected", options.selected},
            {"sessions", run.sessions},
            {"computed", run.computed},
            {"unknown_bodies", run.unknown_bodies},
            {"notices", run.notices},
            {"warnings", run.warnings},
            {"suppressed_warnings", run.suppressed_warnings},
            {"status", run.status ? status_json(*run.status) : Json(nullptr)},
            {"model", scene_model(scene)},
            {"seas", seas_json(run)},
            {"bodies", Json::array()}};
  if (!run.surfaces.empty()) data["surfaces"] = surfaces_json(run);
  data["model"].erase("sea");  // it is one of "seas"
  for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
    const Body& body = scene.bodies()[i];
    const BodyRun& body_run = run.bodies[i];
    Json described{{"id", body.id},
                   {"recorded", body_run.recorded},
                   {"statuses", body_run.statuses},
                   {"max_force", body_run.max_force},  // null: unknown
                   {"shown", body_run.shown},
                   {"rows", body_run.rows.size()}};
    if (body_run.shown) {
      described["data"] = encode_rows(body_run.rows, column_count(scene));
      if (!has_waves(scene)) described["evaluations"] = evaluations_json(body, body_run, scene.water());
      if (body.hydrostatics) described["metacenters"] = encode_metacenters(body, body_run, scene.water());
      if (has_loads(body)) described["loads"] = loads_json(body_run);
      if (!body_run.conditions.empty()) described["conditions"] = conditions_json(body_run);
    }
    data["bodies"].push_back(std::move(described));
  }
  return json_line(data);
}

std::string report_page(const std::string& data, std::string_view three, const PageParts& parts) {
  std::string page = self_contained_page("report.html", three, parts.subdivision);
  const auto fill_in = [&page](std::string_view placeholder, const std::string& text) {
    page.replace(page.find(placeholder), placeholder.size(), text);
  };
  fill_in("<!-- loads -->\n", parts.loads ? "<script>\n" + page_text("loads.js") + "\n</script>\n" : "");
  insert_data(page, data);
  return page;
}

}  // namespace buoyancy::view
