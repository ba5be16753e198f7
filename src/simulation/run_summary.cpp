#include "simulation/run_summary.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/format.h"
#include "base/json.h"

namespace buoyancy {
namespace {

double steps_per_second(const RunSummary& summary) {
  return summary.wall_time > 0.0 ? static_cast<double>(summary.steps) / summary.wall_time : 0.0;
}

}  // namespace

BodySummary summarize(const SimulatedBody& body, const Water& water) {
  const HydrostaticMesh& mesh = body.body->prepared_mesh->mesh;
  const WaterPlane plane = water_plane_in_body(pose_of(body.rigid, body.state), water, mesh.center_B);
  BodySummary summary;
  summary.id = body.body->id;
  summary.name = body.body->name;
  summary.mass = body.rigid.mass;
  summary.draft = -lowest_height(mesh, plane);
  summary.heave = water.up_W.dot(body.state.center_W) - water.level;
  const Vec3& up_B = plane.up_B;
  summary.roll = std::atan2(up_B.y(), up_B.z());
  summary.pitch = std::atan2(-up_B.x(), std::hypot(up_B.y(), up_B.z()));
  // The kinetic energy of a body at rest is rounding error, relative to which no energy means anything.
  constexpr double kRounding = 1e-14;  // of m g L
  const EnergyStats& energy = body.energy;
  if (energy.max_kinetic > kRounding * body.rigid.mass * water.gravity * mesh.diagonal) {
    summary.energy_drift = (energy.current - energy.initial) / energy.max_kinetic;
    summary.energy_range = (energy.max - energy.min) / energy.max_kinetic;
  }
  return summary;
}

std::string to_text(const RunSummary& summary) {
  std::string text;
  append_line(text, "%5s  %-20s %12s %12s %12s %10s %10s %12s %12s", "body", "name", "mass kg", "draft m",
              "heave m", "roll deg", "pitch deg", "energy drift", "energy range");
  for (const BodySummary& body : summary.bodies) {
    append_line(text, "%5d  %-20.60s %12.6g %12.6f %12.6f %10.4f %10.4f %12.2e %12.2e", body.id,
                body.name.c_str(), body.mass, body.draft, body.heave, body.roll * kDegreesPerRadian,
                body.pitch * kDegreesPerRadian, body.energy_drift, body.energy_range);
  }
  const LatencyPercentiles round_trip = summary.client.round_trip.percentiles();
  append_line(text, "steps       %lld of %lld (%.6g s simulated in %.3g s, %.0f steps/s)%s",
              static_cast<long long>(summary.steps), static_cast<long long>(summary.steps_requested),
              summary.time, summary.wall_time, steps_per_second(summary),
              summary.interrupted ? ", interrupted" : "");
  append_line(text, "round trip  p50 %.1f us, p99 %.1f us, p99.9 %.1f us, max %.1f us", 1e6 * round_trip.p50,
              1e6 * round_trip.p99, 1e6 * round_trip.p999, 1e6 * round_trip.max);
  append_line(
      text, "requests    %lld, retries %lld, unanswered %lld, late %lld (by at most %lld), malformed %lld",
      static_cast<long long>(summary.client.requests), static_cast<long long>(summary.client.retries),
      static_cast<long long>(summary.client.unanswered), static_cast<long long>(summary.client.late),
      static_cast<long long>(summary.client.max_lag), static_cast<long long>(summary.client.malformed));
  for (const Warning& warning : summary.warnings) text += "warning     " + warning.message() + "\n";
  return text;
}

std::string to_json(const RunSummary& summary) {
  Json bodies = Json::array();
  for (const BodySummary& body : summary.bodies) {
    bodies.push_back({{"id", body.id},
                      {"name", body.name},
                      {"mass", body.mass},
                      {"draft", body.draft},
                      {"heave", body.heave},
                      {"roll_deg", body.roll * kDegreesPerRadian},
                      {"pitch_deg", body.pitch * kDegreesPerRadian},
                      {"energy_drift", body.energy_drift},
                      {"energy_range", body.energy_range}});
  }
  Json warnings = Json::array();
  for (const Warning& warning : summary.warnings) warnings.push_back(warning.message());
  const LatencyPercentiles round_trip = summary.client.round_trip.percentiles();
  const Json json = {{"integrator", to_string(summary.options.integrator)},
                     {"step", summary.options.step},
                     {"lead_time", summary.options.lead_time},
                     {"delay_steps", summary.options.delay_steps},
                     {"session_id", summary.options.session_id},
                     {"steps", summary.steps},
                     {"steps_requested", summary.steps_requested},
                     {"interrupted", summary.interrupted},
                     {"time", summary.time},
                     {"wall_time", summary.wall_time},
                     {"bodies", bodies},
                     {"round_trip",
                      {{"p50", round_trip.p50},
                       {"p99", round_trip.p99},
                       {"p999", round_trip.p999},
                       {"max", round_trip.max}}},
                     {"requests", summary.client.requests},
                     {"retries", summary.client.retries},
                     {"unanswered", summary.client.unanswered},
                     {"late", summary.client.late},
                     {"max_lag", summary.client.max_lag},
                     {"malformed", summary.client.malformed},
                     {"warnings", warnings}};
  return json_lines(json);
}

}  // namespace buoyancy
