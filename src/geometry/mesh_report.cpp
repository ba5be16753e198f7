#include "geometry/mesh_report.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "geometry/mesh_report_facts.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMaxListed = 8;  // components; holes
constexpr double kMinOverlap = 1e-6;   // of the volume
// Files hold single precision: more digits would be noise.
constexpr std::string_view kBoxWords = "from {:7} to {:7}";

std::string percent(double share) {
  return format_number(100.0 * share, 3) + " %";
}

Facts polygons_facts(const PolygonSplit& split) {
  const bool some = split.non_planar > 0;
  Facts facts;
  facts.line("polygons").add("count", split.polygons, "{} of four or more corners, split into triangles");
  facts.add("non_planar", split.non_planar, some ? "; {} not planar" : "");
  facts.add("largest_distance", split.largest_distance, some ? "up to {:4} m from a plane" : "");
  facts.add("split_volume", split.split_volume, some ? "between whose extreme splits lie {:4} m^3" : "");
  return facts;
}

Facts source_facts(const MeshSource& source) {
  Facts facts;
  facts.add("format", source.format, source.format.empty() ? "" : "{}");
  facts.add("up_axis", source.up_axis, source.up_axis.empty() ? "" : "up axis {}");
  facts.add("note", source.note).add("nodes", source.nodes, source.nodes > 1 ? "{} nodes" : "");
  facts.add("left_out", source.ignored_primitives);
  facts.say_if(source.ignored_primitives > 0,
               pluralize(source.ignored_primitives, "point or line left out", "points and lines left out"));
  facts.say_if(!source.note.empty(), "{}", source.note);
  return facts;
}

std::string edges_text(const MeshReport& report) {
  Facts facts;
  facts.say_if(report.boundary_edges > 0, "{} boundary", report.boundary_edges);
  facts.say_if(report.non_manifold_edges > 0, "{} non-manifold", report.non_manifold_edges);
  facts.say_if(report.misoriented_edges > 0, "{} misoriented", report.misoriented_edges);
  facts.say_if(report.balanced_edges > 0, "{} balanced", report.balanced_edges);
  if (report.closed()) {
    facts.say(report.balanced_edges > 0 ? " (shared by four or more faces)"
                                        : "each used once in each direction");
  }
  return facts.text();
}

std::string_view state_text(const MeshReport& report) {
  if (report.triangles == 0) return "none";
  if (report.closed()) return report.balanced_edges == 0 ? "closed" : "balanced";
  return report.non_manifold_edges == 0 && report.misoriented_edges == 0 ? "open" : "open or inconsistent";
}

std::string faces_text(const MeshReport& report) {
  Facts facts;
  facts.say_if(report.dropped_faces > 0, "{} dropped for using a vertex twice", report.dropped_faces);
  facts.say_if(report.degenerate_faces > 0, "{} of zero area", report.degenerate_faces);
  facts.say_if(report.duplicate_faces > 0, "{} of an earlier face",
               pluralize(report.duplicate_faces, "duplicate", "duplicates"));
  return facts.text();
}

Facts component_facts(const ComponentReport& component) {
  Facts facts;
  facts.add("triangles", component.triangles);
  facts.say(pluralize(component.triangles, "triangle", "triangles"));
  facts.add("volume", component.volume, "{} m^3");
  facts.add("closed", component.closed).say_if(!component.closed, "open");
  facts.add_flag("cavity", component.cavity, "a cavity");
  facts.add_flag("nested", component.nested, "inside another: its volume counts twice");
  facts.add_flag("turned", component.flipped, "was inside out: its winding was reversed");
  return facts;
}

Json to_json(const std::optional<ClosingEstimate>& closing) {
  if (!closing) return nullptr;
  return {{"volume", closing->volume}, {"bulge", closing->bulge}, {"disagreement", closing->disagreement}};
}

Json to_json(const BoundingBox& box) {
  return {{"min", box.min_B}, {"max", box.max_B}};
}

// number: of the hole, from 1. closing: estimate for all holes together, if it is known.
Facts hole_facts(std::size_t number, const HoleReport& hole, const std::optional<ClosingEstimate>& closing) {
  Facts facts;
  facts.add("edges", hole.edges).say("{}: {}", number, pluralize(hole.edges, "edge", "edges"));
  facts.add("box", to_json(hole.box)).say(kBoxWords, hole.box.min_B, hole.box.max_B);
  facts.add("perimeter", hole.perimeter, "; {:4} m around").add("area", hole.area, "{:4} m^2");
  facts.add("bulge", hole.bulge, "{:3} m^3 in a hemisphere over it");
  if (closing) facts.say("{} of the closed volume", percent(hole.bulge / closing->volume));
  facts.add_flag("slit", hole.slit, "; a slit");
  return facts;
}

std::int64_t count_components(const MeshReport& report, bool ComponentReport::*flag) {
  return std::count_if(report.components.begin(), report.components.end(),
                       [flag](const ComponentReport& component) { return component.*flag; });
}

// Adds a list; only its first kMaxListed entries have lines in the text.
void add_list(std::string_view key, std::vector<Facts> all, Facts& facts) {
  Json& list = facts.list(key);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i < kMaxListed) facts.line("").say("{}", all[i].text());
    list.push_back(std::move(all[i].json()));
  }
  if (all.size() > kMaxListed) facts.line("").say("and {} smaller ones", all.size() - kMaxListed);
}

// A single component has no lines in the text.
void add_components(const MeshReport& report, Facts& facts) {
  std::vector<Facts> components;
  for (const ComponentReport& component : report.components) components.push_back(component_facts(component));
  const std::size_t count = components.size();
  if (count < 2) {
    facts.list("components");
    for (Facts& component : components) facts.json()["components"].push_back(std::move(component.json()));
    return;
  }
  const std::int64_t cavities = count_components(report, &ComponentReport::cavity);
  const std::int64_t nested = count_components(report, &ComponentReport::nested);
  const std::int64_t flipped = count_components(report, &ComponentReport::flipped);
  facts.line("components").say("{}", count);
  facts.say_if(cavities > 0, pluralize(cavities, "cavity", "cavities"));
  facts.say_if(nested > 0, "{} inside another", nested);
  facts.say_if(flipped > 0, "{} flipped", flipped);
  add_list("components", std::move(components), facts);
}

void add_holes(const MeshReport& report, Facts& facts) {
  std::vector<Facts> holes;
  for (const HoleReport& hole : report.holes) {
    holes.push_back(hole_facts(holes.size() + 1, hole, report.closing));
  }
  if (!holes.empty()) facts.line("holes").say("{}", holes.size());
  add_list("holes", std::move(holes), facts);
}

void say_overlap(const MeshReport& report, Facts& facts) {
  if (!report.intersecting_pairs) return;
  const std::int64_t pairs = *report.intersecting_pairs;
  facts.line("intersecting").say(pluralize(pairs, "pair of faces", "pairs of faces"));
  facts.say_if(report.intersections_cut_off, " at least, too many to count");
  const double share = report.overlap_volume.value_or(0.0) / report.volume;
  if (pairs == 0 && !(share > kMinOverlap)) return;
  facts.line("overlap");
  if (report.overlap_volume) {
    const double counted = share > kMinOverlap ? share : 0.0;
    facts.say("{:4} m^3 count more than once, {} of the volume (within some 0.1 %)", counted * report.volume,
              percent(counted));
  } else {
    facts.say(report.closed() ? "not known: what overlaps counts more than once"
                              : "not known before the mesh is closed");
  }
}

// Formats a share rounded up to two digits, so that it suffices as a limit.
std::string at_least(double share) {
  const double unit = std::pow(10.0, std::floor(std::log10(share)) - 1.0);
  return format_number(std::ceil(share / unit * (1.0 - 1e-9)) * unit, 3);
}

std::string quoted_for_shell(const std::string& path) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./+,:=@%";
  if (!path.empty() && path.find_first_not_of(kPlain) == std::string::npos) return path;
  std::string quoted = "'";
  for (const char c : path) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// Returns the axis across which the mesh looks like half a body, because much of its largest rim lies in the
// plane x = 0 or y = 0, at which the mesh ends; empty if there is none. Ships are symmetric in y more often
// than in x, and z = 0 is where panels end at the water.
std::string half_body_axis(const MeshReport& report) {
  constexpr double kMinShare = 0.3;
  const double tolerance = 1e-6 * report.diagonal;
  const HoleReport& rim = report.holes.front();
  std::string axis;
  double longest = kMinShare * rim.perimeter;
  for (const Eigen::Index i : {1, 0}) {
    const bool ends = report.box.min_B[i] >= -tolerance || report.box.max_B[i] <= tolerance;
    if (!ends || rim.length_in_planes[i] <= longest * (1.0 + 1e-9)) continue;
    longest = rim.length_in_planes[i];
    axis = "xyz"[i];
  }
  return axis;
}

}  // namespace

std::string closing_advice(const MeshReport& report) {
  if (!report.closing || report.holes.empty()) return "";
  const double bulge = report.closing->bulge / report.closing->volume;
  const double disagreement = report.closing->disagreement / report.closing->volume;
  const std::string repair = "buoyancy-mesh repair " + quoted_for_shell(report.name) + " OUTPUT.ply";
  const std::string axis = half_body_axis(report);
  std::string advice;
  if (!axis.empty()) {
    advice = "If this is half a body: " + repair + " --mirror " + axis + " --rims, or mirror = \"" + axis +
             "\" in a scene file. ";
  }
  if (disagreement > kMaxCapDisagreement) {
    return advice + "Closing all holes is ambiguous: caps over them differ by " + percent(disagreement) +
           " of the volume; model the missing surface";
  }
  std::string flags = "--close";
  if (bulge > kDefaultMaxChange) flags = "--rims";
  if (disagreement > kDefaultMaxChange) flags += " --max-change " + at_least(disagreement);
  return advice + "Close them: " + repair + " " + flags +
         ", or close_holes = " + at_least(std::max({bulge, disagreement, kDefaultMaxChange})) +
         " in a scene file; the volume is then " + format_number(report.closing->volume, 6) +
         " m^3, hemispheres over the caps would hold " + percent(bulge) +
         " of it, and different caps differ by " + percent(disagreement);
}

namespace {

// Returns the facts of the surface. Without triangles only their JSON is in the report, not their text.
Facts surface_facts(const MeshReport& report) {
  Facts facts;
  facts.line("edges").say(edges_text(report));
  facts.line("box").add("box", to_json(report.box)).say(kBoxWords, report.box.min_B, report.box.max_B);
  facts.add("diagonal", report.diagonal).say(" m, diagonal {:7} m", report.diagonal);
  facts.line("area").add("area", report.area, "{} m^2");
  facts.line("volume").add("volume", report.volume, "{} m^3");
  facts.say_if(!report.closed(), " about the box's centre; meaningless for an open mesh");
  facts.line("").add("volume_by_axis", report.volume_by_axis, "from x, y, z: {} m^3");
  facts.line("").add("area_vector", report.area_vector, "integral of n dA: {} m^2");
  facts.add("closed", report.closed()).add("boundary_edges", report.boundary_edges);
  facts.add("non_manifold_edges", report.non_manifold_edges).add("balanced_edges", report.balanced_edges);
  facts.add("misoriented_edges", report.misoriented_edges).add("degenerate_faces", report.degenerate_faces);
  facts.add("dropped_faces", report.dropped_faces).add("duplicate_faces", report.duplicate_faces);
  facts.add("intersecting_pairs", report.intersecting_pairs);
  facts.add("intersections_cut_off", report.intersections_cut_off);
  facts.add("overlap_volume", report.overlap_volume);
  add_components(report, facts);
  add_holes(report, facts);
  say_overlap(report, facts);
  facts.add("closing", to_json(report.closing)).add("advice", closing_advice(report));
  facts.add("turned", report.flipped);
  if (report.flipped) facts.line("flipped").say("was inside out: the winding of all faces was reversed");
  return facts;
}

}  // namespace

Facts mesh_report_facts(const MeshReport& report) {
  Facts source = source_facts(report.source);
  std::string polygons;
  if (report.source.polygons.polygons > 0) {
    Facts split = polygons_facts(report.source.polygons);
    polygons = split.text();
    source.add("polygons", std::move(split.json()));
  }
  const std::string faces = faces_text(report);
  const bool welded = report.weld == WeldKind::kTolerance;
  Facts facts;
  facts.heading("{}", report.name).add("name", report.name);
  if (!source.text().empty()) facts.line("source").say("{}", source.text());
  facts.add("source", std::move(source.json()));
  facts.line("surface").say("{}", state_text(report));
  facts.line("triangles").add("triangles", report.triangles, "{}");
  if (!polygons.empty()) facts.heading(polygons);
  facts.line("vertices").add("vertices_stored", report.vertices_stored, "{} stored");
  facts.add("vertices_welded", report.vertices_welded, "{} after welding");
  facts.add("weld", welded ? "tolerance" : "exact");
  facts.add("weld_largest_move", report.weld_largest_move,
            welded ? "; cracks closed by moving vertices up to {} m" : "");
  if (!faces.empty()) facts.line("faces").say(faces);
  facts.include("repair", repair_facts(report.repair));
  const Facts surface = surface_facts(report);
  if (report.triangles > 0) facts.heading(surface.text());
  facts.update(surface);
  return facts;
}

std::string to_text(const MeshReport& report) {
  return mesh_report_facts(report).text();
}

}  // namespace buoyancy
