#include "view/report/report_page.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <nlohmann/json.hpp>

#include "engine/body_evaluation.h"
#include "hydrostatics/hydrostatics.h"
#include "view/common/base64.h"
#include "view/common/page_assets.h"
#include "view/common/scene_model.h"

namespace buoyancy {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kQueriesTimed = 200;

BodyState state_of(const Body& body, const Row& row) {
  return {.body_id = body.id,
          .position = {row[kPx], row[kPy], row[kPz]},
          .quaternion_wxyz = {row[kQw], row[kQx], row[kQy], row[kQz]},
          .linear_velocity = {},
          .angular_velocity = {}};
}

// ns, the median of what `query` takes for the rows that it answers true for; null: for none.
template <typename Query>
Json median_time(const Body& body, const BodyRun& run, Query query) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> times;
  const std::size_t stride = std::max<std::size_t>(1, run.rows.size() / kQueriesTimed);
  for (std::size_t i = 0; i < run.rows.size(); i += stride) {
    const ValidatedPose asked = validate_pose(state_of(body, run.rows[i]), 0.0);
    if (asked.status != BodyStatus::kOk) continue;
    const Clock::time_point start = Clock::now();
    const bool counts = query(asked);
    if (counts) times.push_back(std::chrono::duration<double, std::nano>(Clock::now() - start).count());
  }
  if (times.empty()) return nullptr;
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::ranges::nth_element(times, middle);
  return *middle;
}

// What of this body's rows was skipped, and what a query costs with and without.
Json skipping_of(const Body& body, const BodyRun& run, const Water& water) {
  const FullySubmerged wet = fully_submerged(body.solver.mesh(), water, body.reference_B);
  BodyOutcome outcome;
  return {{"unchanged", run.skipped.unchanged},
          {"dry", run.skipped.dry},
          {"wet", run.skipped.wet},
          {"crossing", run.skipped.crossing},
          {"refused", run.skipped.refused},
          {"bounds_ns", median_time(body, run,
                                    [&](const ValidatedPose& asked) {
                                      return try_evaluate_from_bounds(body, wet, water, asked, outcome);
                                    })},
          {"query_ns", median_time(body, run, [&](const ValidatedPose& asked) {
             evaluate(body, water, asked, outcome);
             return outcome.result.immersion == Immersion::kPiercing;
           })}};
}

// Column after column.
std::string rows_text(const std::vector<Row>& rows) {
  std::vector<double> numbers;
  numbers.reserve(rows.size() * kColumnCount);
  for (std::size_t column = 0; column < kColumnCount; ++column) {
    for (const Row& row : rows) numbers.push_back(row[column]);
  }
  return base64_of<double>(numbers);
}

// Row after row: two points, m, W axes, from B's origin; NaN where there are none.
std::string metacenters_text(const Body& body, const BodyRun& run, const Water& water) {
  std::vector<float> numbers;
  numbers.reserve(run.rows.size() * 6);
  for (const Row& row : run.rows) {
    const ValidatedPose asked = validate_pose(state_of(body, row), 0.0);
    std::optional<Hydrostatics> found;
    if (asked.status == BodyStatus::kOk && row[kStatus] == 0.0) {
      found = hydrostatics(body.solver.mesh(), asked.pose, water, body.reference_B, body.center_of_mass_B);
    }
    const Hydrostatics shown = found.value_or(Hydrostatics{});
    for (const Vec3& center : shown.metacenters_W) {
      for (const double coordinate : center) numbers.push_back(static_cast<float>(coordinate));
    }
  }
  return base64_of<float>(numbers);
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

}  // namespace

std::string report_data(const Scene& scene, const RecordedRun& run, const ReportOptions& options) {
  Json data{{"file", options.file},
            {"version", options.version},
            {"columns", kColumnNames},
            {"selected", options.selected},
            {"sessions", run.sessions},
            {"computed", run.computed},
            {"unknown_bodies", run.unknown_bodies},
            {"warnings", run.warnings},
            {"suppressed_warnings", run.suppressed_warnings},
            {"status", run.status ? status_json(*run.status) : Json(nullptr)},
            {"model", scene_model(scene)},
            {"bodies", Json::array()}};
  for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
    const Body& body = scene.bodies()[i];
    const BodyRun& of_body = run.bodies[i];
    Json described{{"id", body.id},
                   {"recorded", of_body.recorded},
                   {"statuses", of_body.statuses},
                   {"largest_force", of_body.largest_force},  // null: not known
                   {"shown", of_body.shown},
                   {"rows", of_body.rows.size()}};
    if (of_body.shown) {
      described["data"] = rows_text(of_body.rows);
      described["skipped"] = skipping_of(body, of_body, scene.water());
      if (body.hydrostatics) described["metacenters"] = metacenters_text(body, of_body, scene.water());
    }
    data["bodies"].push_back(std::move(described));
  }
  return data.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string report_page(const std::string& data, std::string_view three) {
  constexpr std::string_view kPlace = "<!-- data -->";
  std::string page = self_contained_page("report.html", three);
  const std::size_t place = page.find(kPlace);
  page.replace(place, kPlace.size(),
               "<script type=\"application/json\" id=\"data\">" + escaped_for_script(data) + "</script>");
  return page;
}

}  // namespace buoyancy
