#include "geometry/repair_report.h"

#include <algorithm>
#include <array>
#include <utility>

#include "geometry/mesh_report_facts.h"

namespace buoyancy {
namespace {

struct KindText {
  RepairKind kind;
  std::string_view name;
  const char* singular;  // name of one item that the step counts
  const char* plural;
  std::string_view done;  // what it did with them
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

// Returns whether caps over holes disagree by no more than the rounding of coordinates.
bool is_flat(const RepairReport& report) {
  return report.cap_disagreement <= 1e-6 * report.cap_bulge;
}

Json to_json(const std::optional<EnclosedSolid>& solid) {
  if (!solid) return nullptr;
  return {{"volume", solid->volume}, {"centroid", solid->centroid_B}};
}

Facts step_facts(const RepairStep& step, const RepairReport& report) {
  const KindText& kind = text_of(step.kind);
  Facts facts;
  facts.add("step", kind.name).add("count", step.count);
  facts.say(pluralize(step.count, kind.singular, kind.plural)).say(kind.done);
  if (step.kind == RepairKind::kCloseHoles) {
    facts.say(is_flat(report) ? " by flat caps" : " by caps of least area");
  }
  facts.add("area", step.area, "{:4} m^2").add("largest_move", step.max_move);
  if (step.kind == RepairKind::kInsertVertices) {
    facts.say("up to {:3} m beside them", step.max_move);
  } else if (step.kind == RepairKind::kWeld || step.max_move > 0.0) {
    facts.say("moved up to {:3} m", step.max_move);
  }
  facts.add("before", to_json(step.before)).add("after", to_json(step.after));
  facts.say_if(step.before || step.after, "; volume {} -> {}", volume_text(step.before),
               volume_text(step.after));
  return facts;
}

Facts skipped_facts(const SkippedRepair& skipped) {
  const bool of_holes = skipped.kind == RepairKind::kCloseHoles;
  Facts facts;
  facts.say(of_holes ? "not done: {}" : "not tried further: {}", to_string(skipped.kind));
  facts.add("step", to_string(skipped.kind)).add("because", to_string(skipped.obstacle));
  facts.add("faces", skipped.faces, of_holes ? " ({} holes or edges)" : " ({} faces or edges)");
  facts.say(": {}", to_string(skipped.obstacle)).add("share", skipped.share);
  facts.say_if(skipped.share > 0.0, "{:3} %", 100.0 * skipped.share);
  return facts;
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

Facts repair_facts(const RepairReport& report) {
  Facts facts;
  const auto begin_line = [&facts] { facts.line(facts.text().empty() ? "repair" : ""); };
  const auto add_to = [&](Json& list, Facts one) {
    begin_line();
    facts.say("{}", one.text());
    list.push_back(std::move(one.json()));
  };
  Json& steps = facts.list("steps");
  for (const RepairStep& step : report.steps) add_to(steps, step_facts(step, report));
  Json& skipped = facts.list("skipped");
  for (const SkippedRepair& one : report.skipped) add_to(skipped, skipped_facts(one));
  if (report.volume_bound > 0.0) {
    begin_line();
    facts.say("moved vertices change the volume by at most {:3} m^3", report.volume_bound);
  }
  if (report.cap_bulge > 0.0) {
    begin_line();
    facts.say("closed holes may hide some {:3} m^3 (estimate: a hemisphere over each)", report.cap_bulge);
  }
  const auto asked_for = [](const RepairStep& step) { return step.kind == RepairKind::kCloseHoles; };
  if (std::any_of(report.steps.begin(), report.steps.end(), asked_for)) {
    begin_line();
    facts.say("different caps over them differ by {:3} m^3 (estimate{})", report.cap_disagreement,
              is_flat(report) ? "; exact if the openings are flat" : "");
  }
  facts.add("volume_bound", report.volume_bound).add("cap_bulge", report.cap_bulge);
  facts.add("cap_disagreement", report.cap_disagreement);
  return facts;
}

}  // namespace buoyancy
