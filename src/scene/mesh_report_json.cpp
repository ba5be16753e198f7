#include "scene/mesh_report_json.h"

#include <cstdint>
#include <optional>
#include <utility>

namespace buoyancy {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json to_json(const BoundingBox& box) {
  return {{"min", to_json(box.min_B)}, {"max", to_json(box.max_B)}};
}

Json to_json(const MeshSource& source) {
  Json json{{"format", source.format},
            {"up_axis", source.up_axis},
            {"note", source.note},
            {"nodes", source.nodes},
            {"left_out", source.ignored_primitives}};
  if (const PolygonSplit& split = source.polygons; split.polygons > 0) {
    json["polygons"] = {{"count", split.polygons},
                        {"non_planar", split.non_planar},
                        {"largest_distance", split.largest_distance},
                        {"split_volume", split.split_volume}};
  }
  return json;
}

Json to_json(const ComponentReport& component) {
  return {{"triangles", component.triangles}, {"volume", component.volume}, {"closed", component.closed},
          {"cavity", component.cavity},       {"nested", component.nested}, {"turned", component.flipped}};
}

Json to_json(const std::optional<EnclosedSolid>& solid) {
  if (!solid) return nullptr;
  return {{"volume", solid->volume}, {"centroid", to_json(solid->centroid_B)}};
}

Json to_json(const RepairReport& repair) {
  Json steps = Json::array();
  for (const RepairStep& step : repair.steps) {
    steps.push_back({{"step", to_string(step.kind)},
                     {"count", step.count},
                     {"area", step.area},
                     {"largest_move", step.max_move},
                     {"before", to_json(step.before)},
                     {"after", to_json(step.after)}});
  }
  Json skipped = Json::array();
  for (const SkippedRepair& one : repair.skipped) {
    skipped.push_back({{"step", to_string(one.kind)},
                       {"because", to_string(one.obstacle)},
                       {"faces", one.faces},
                       {"share", one.share}});
  }
  return {{"steps", std::move(steps)},
          {"skipped", std::move(skipped)},
          {"volume_bound", repair.volume_bound},
          {"cap_bulge", repair.cap_bulge},
          {"cap_disagreement", repair.cap_disagreement}};
}

Json to_json(const std::optional<ClosingEstimate>& closing) {
  if (!closing) return nullptr;
  return {{"volume", closing->volume}, {"bulge", closing->bulge}, {"disagreement", closing->disagreement}};
}

}  // namespace

Json mesh_report_json(const MeshReport& report) {
  Json components = Json::array();
  for (const ComponentReport& component : report.components) components.push_back(to_json(component));
  Json holes = Json::array();
  for (const HoleReport& hole : report.holes) {
    holes.push_back({{"edges", hole.edges},
                     {"box", to_json(hole.box)},
                     {"perimeter", hole.perimeter},
                     {"area", hole.area},
                     {"bulge", hole.bulge},
                     {"slit", hole.slit}});
  }
  const std::optional<double>& overlap = report.overlap_volume;
  const std::optional<std::int64_t>& pairs = report.intersecting_pairs;
  return {{"name", report.name},
          {"source", to_json(report.source)},
          {"triangles", report.triangles},
          {"vertices_stored", report.vertices_stored},
          {"vertices_welded", report.vertices_welded},
          {"weld", report.weld == WeldKind::kExact ? "exact" : "tolerance"},
          {"weld_largest_move", report.weld_largest_move},
          {"repair", to_json(report.repair)},
          {"box", to_json(report.box)},
          {"diagonal", report.diagonal},
          {"area", report.area},
          {"volume", report.volume},
          {"volume_by_axis", to_json(report.volume_by_axis)},
          {"area_vector", to_json(report.area_vector)},
          {"closed", report.closed()},
          {"boundary_edges", report.boundary_edges},
          {"non_manifold_edges", report.non_manifold_edges},
          {"balanced_edges", report.balanced_edges},
          {"misoriented_edges", report.misoriented_edges},
          {"degenerate_faces", report.degenerate_faces},
          {"dropped_faces", report.dropped_faces},
          {"duplicate_faces", report.duplicate_faces},
          {"intersecting_pairs", pairs ? Json(*pairs) : Json(nullptr)},
          {"intersections_cut_off", report.intersections_cut_off},
          {"overlap_volume", overlap ? Json(*overlap) : Json(nullptr)},
          {"components", std::move(components)},
          {"holes", std::move(holes)},
          {"closing", to_json(report.closing)},
          {"advice", closing_advice(report)},
          {"turned", report.flipped}};
}

}  // namespace buoyancy
