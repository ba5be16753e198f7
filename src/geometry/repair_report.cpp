#include "geometry/repair_report.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "base/format.h"

namespace buoyancy {
namespace {

struct KindText {
  RepairKind kind;
  std::string_view name;
  const char* singular;  // of what it counts
  const char* plural;
  std::string_view done;  // with it
};
constexpr std::array kKinds{
    KindText{RepairKind::kWeld, "weld", "vertex", "vertices", " merged with others beside them"},
    KindText{RepairKind::kInsertVertices, "insert_vertices", "vertex", "vertices",
             " inserted into edges on which they lie"},
    KindText{RepairKind::kRemoveDuplicates, "remove_duplicates", "copy of a face", "copies of faces",
             " removed"},
    KindText{RepairKind::kRemoveBackFaces, "remove_back_faces", "face", "faces",
             " stored for both sides: one side removed"},
    KindText{RepairKind::kRemoveOpposites, "remove_opposites", "face", "faces",
             " that cancel their opposites removed"},
    KindText{RepairKind::kTurnFaces, "turn_faces", "face", "faces",
             " turned to the winding of their neighbours"},
    KindText{RepairKind::kRemoveInnerFaces, "remove_inner_faces", "face", "faces",
             " inside the surface removed"},
    KindText{RepairKind::kRemoveSheets, "remove_sheets", "face", "faces", " of zero thickness removed"},
    KindText{RepairKind::kCapHoles, "cap_holes", "negligible hole", "negligible holes", " closed"},
    KindText{RepairKind::kMirror, "mirror", "face", "faces", " of the mirror image added"},
    KindText{RepairKind::kRaiseRims, "raise_rims", "rim", "rims", " raised by a wall"},
    KindText{RepairKind::kCloseHoles, "close_holes", "hole", "holes", " closed"},
};

struct ObstacleText {
  RepairObstacle obstacle;
  std::string_view text;
};
constexpr std::array kObstacles{
    ObstacleText{RepairObstacle::kTooMany, "too many to finish in time"},
    ObstacleText{RepairObstacle::kNotOrientable, "no consistent winding exists"},
    ObstacleText{RepairObstacle::kSelfIntersection,
                 "faces intersect, so that inside and outside cannot be told apart"},
    ObstacleText{RepairObstacle::kLeak, "the outside reaches the inside, as through a hole"},
    ObstacleText{RepairObstacle::kAmbiguous, "sheets that may be parts of a surface"},
    ObstacleText{RepairObstacle::kTooThin,
                 "too thin: moved vertices might change the volume by more than 1 %"},
    ObstacleText{RepairObstacle::kBulge, "too large: hemispheres over them hold this share of the volume"},
    ObstacleText{RepairObstacle::kDisagreement,
                 "not flat: the volumes under different caps differ by this share"},
    ObstacleText{RepairObstacle::kNoRim, "no rim faces up"},
    ObstacleText{RepairObstacle::kStillOpen, "others would be left, or nothing is enclosed"},
};

const KindText& text_of(RepairKind kind) {
  return *std::find_if(kKinds.begin(), kKinds.end(),
                       [kind](const KindText& text) { return text.kind == kind; });
}

std::string volume_text(const std::optional<EnclosedSolid>& solid) {
  return solid ? format_number(solid->volume) + " m^3" : "not closed";
}

// Is what caps over holes disagree about rounding of their coordinates?
bool is_flat(const RepairReport& report) {
  return report.cap_disagreement <= 1e-6 * report.cap_bulge;
}

std::string step_text(const RepairStep& step, const RepairReport& report) {
  const KindText& kind = text_of(step.kind);
  std::string text = pluralize(step.count, kind.singular, kind.plural);
  text += kind.done;
  if (step.kind == RepairKind::kCloseHoles)
    text += is_flat(report) ? " by flat caps" : " by caps of least area";
  text += ", " + format_number(step.area, 4) + " m^2";
  if (step.kind == RepairKind::kInsertVertices) {
    text += ", up to " + format_number(step.max_move, 3) + " m beside them";
  } else if (step.kind == RepairKind::kWeld || step.max_move > 0.0) {
    text += ", moved up to " + format_number(step.max_move, 3) + " m";
  }
  if (!step.before && !step.after) return text;
  return text + "; volume " + volume_text(step.before) + " -> " + volume_text(step.after);
}

std::string skipped_text(const SkippedRepair& skipped) {
  const bool of_holes = skipped.kind == RepairKind::kCloseHoles;
  std::string text = of_holes ? "not done: " : "not tried further: ";
  text += to_string(skipped.kind);
  text += " (" + std::to_string(skipped.faces) + (of_holes ? " holes or edges): " : " faces or edges): ");
  text += to_string(skipped.obstacle);
  if (skipped.share > 0.0) text += ", " + format_number(100.0 * skipped.share, 3) + " %";
  return text;
}

}  // namespace

std::string_view to_string(RepairKind kind) {
  return text_of(kind).name;
}

std::string_view to_string(RepairObstacle obstacle) {
  return std::find_if(kObstacles.begin(), kObstacles.end(),
                      [obstacle](const ObstacleText& text) { return text.obstacle == obstacle; })
      ->text;
}

void append(const RepairReport& more, RepairReport& report) {
  report.steps.insert(report.steps.end(), more.steps.begin(), more.steps.end());
  report.skipped.insert(report.skipped.end(), more.skipped.begin(), more.skipped.end());
  report.volume_bound += more.volume_bound;
  report.cap_bulge += more.cap_bulge;
  report.cap_disagreement += more.cap_disagreement;
}

std::vector<std::string> to_lines(const RepairReport& report) {
  std::vector<std::string> lines;
  lines.reserve(report.steps.size() + report.skipped.size() + 3);
  for (const RepairStep& step : report.steps) lines.push_back(step_text(step, report));
  for (const SkippedRepair& skipped : report.skipped) lines.push_back(skipped_text(skipped));
  if (report.volume_bound > 0.0) {
    lines.push_back("moved vertices change the volume by at most " + format_number(report.volume_bound, 3) +
                    " m^3");
  }
  if (report.cap_bulge > 0.0) {
    lines.push_back("closed holes may hide some " + format_number(report.cap_bulge, 3) +
                    " m^3 (estimate: a hemisphere over each)");
  }
  const auto asked_for = [](const RepairStep& step) { return step.kind == RepairKind::kCloseHoles; };
  if (std::any_of(report.steps.begin(), report.steps.end(), asked_for)) {
    lines.push_back("different caps over them differ by " + format_number(report.cap_disagreement, 3) +
                    " m^3 (estimate" + (is_flat(report) ? "; exact if the openings are flat)" : ")"));
  }
  return lines;
}

}  // namespace buoyancy
