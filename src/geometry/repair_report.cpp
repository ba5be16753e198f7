#include "geometry/repair_report.h"

#include "base/format.h"

namespace buoyancy {
namespace {

std::string action(const RepairStep& step) {
  const auto count = [&step](const std::string& singular, const std::string& plural) {
    return pluralize(step.count, singular, plural);
  };
  switch (step.kind) {
    case RepairKind::kWeld:
      return count("vertex", "vertices") + " merged with others beside them";
    case RepairKind::kInsertVertices:
      return count("vertex", "vertices") + " inserted into edges on which they lie";
    case RepairKind::kRemoveDuplicates:
      return count("copy of a face", "copies of faces") + " removed";
    case RepairKind::kRemoveBackFaces:
      return count("face", "faces") + " stored for both sides: one side removed";
    case RepairKind::kRemoveOpposites:
      return count("face", "faces") + " that cancel their opposites removed";
    case RepairKind::kTurnFaces:
      return count("face", "faces") + " turned to the winding of their neighbours";
    case RepairKind::kRemoveInnerFaces:
      return count("face", "faces") + " inside the surface removed";
    case RepairKind::kRemoveSheets:
      return count("face", "faces") + " of zero thickness removed";
    case RepairKind::kCapHoles:
      return count("negligible hole", "negligible holes") + " closed";
  }
  return {};
}

std::string volume_text(const std::optional<EnclosedSolid>& solid) {
  return solid ? format_number(solid->volume) + " m^3" : "not closed";
}

std::string step_text(const RepairStep& step) {
  std::string text = action(step) + ", " + format_number(step.area, 4) + " m^2";
  if (step.kind == RepairKind::kWeld) text += ", moved up to " + format_number(step.max_move, 3) + " m";
  if (step.kind == RepairKind::kInsertVertices)
    text += ", up to " + format_number(step.max_move, 3) + " m beside them";
  if (!step.before && !step.after) return text;
  return text + "; volume " + volume_text(step.before) + " -> " + volume_text(step.after);
}

std::string skipped_text(const SkippedRepair& skipped) {
  std::string text = "not tried further: ";
  text += to_string(skipped.kind);
  text += " (" + std::to_string(skipped.faces) + " faces or edges): ";
  text += to_string(skipped.obstacle);
  return text;
}

}  // namespace

std::string_view to_string(RepairKind kind) {
  switch (kind) {
    case RepairKind::kWeld:
      return "weld";
    case RepairKind::kInsertVertices:
      return "insert_vertices";
    case RepairKind::kRemoveDuplicates:
      return "remove_duplicates";
    case RepairKind::kRemoveBackFaces:
      return "remove_back_faces";
    case RepairKind::kRemoveOpposites:
      return "remove_opposites";
    case RepairKind::kTurnFaces:
      return "turn_faces";
    case RepairKind::kRemoveInnerFaces:
      return "remove_inner_faces";
    case RepairKind::kRemoveSheets:
      return "remove_sheets";
    case RepairKind::kCapHoles:
      return "cap_holes";
  }
  return {};
}

std::string_view to_string(RepairObstacle obstacle) {
  switch (obstacle) {
    case RepairObstacle::kTooMany:
      return "too many to finish in time";
    case RepairObstacle::kNotOrientable:
      return "no consistent winding exists";
    case RepairObstacle::kSelfIntersection:
      return "faces intersect, so that inside and outside cannot be told apart";
    case RepairObstacle::kLeak:
      return "the outside reaches the inside, as through a hole";
    case RepairObstacle::kAmbiguous:
      return "sheets that may be parts of a surface";
    case RepairObstacle::kTooThin:
      return "too thin: moved vertices might change the volume by more than 1 %";
  }
  return {};
}

std::vector<std::string> to_lines(const RepairReport& report) {
  std::vector<std::string> lines;
  lines.reserve(report.steps.size() + report.skipped.size() + 2);
  for (const RepairStep& step : report.steps) lines.push_back(step_text(step));
  for (const SkippedRepair& skipped : report.skipped) lines.push_back(skipped_text(skipped));
  if (report.volume_bound > 0.0) {
    lines.push_back("moved vertices change the volume by at most " + format_number(report.volume_bound, 3) +
                    " m^3");
  }
  if (report.cap_bulge > 0.0) {
    lines.push_back("closed holes may hide some " + format_number(report.cap_bulge, 3) +
                    " m^3 (estimate: a hemisphere over each)");
  }
  return lines;
}

}  // namespace buoyancy
