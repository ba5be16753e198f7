#include "geometry/mesh_report.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/format.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMaxListed = 8;  // components; holes
constexpr double kMinOverlap = 1e-6;   // of the volume

// Builds the text "a, b, c", or `otherwise` if the list is empty.
class Listing {
 public:
  void add_if(bool applies, const std::string& item) {
    if (!applies) return;
    if (!text_.empty()) text_ += ", ";
    text_ += item;
  }
  std::string text(const std::string& otherwise) const { return text_.empty() ? otherwise : text_; }

 private:
  std::string text_;
};

class AlignedLines {
 public:
  void add(std::string_view label, const std::string& value) {
    constexpr std::size_t kLabelWidth = 14;
    if (!text_.empty()) text_ += '\n';
    text_ += "  ";
    text_ += label;
    text_.append(label.size() < kLabelWidth ? kLabelWidth - label.size() : 1, ' ');
    text_ += value;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// Files hold single precision: more digits would be noise.
std::string coordinates(const Vec3& point_B) {
  return format_vector(point_B, 7);
}

std::string percent(double share) {
  return format_number(100.0 * share, 3) + " %";
}

std::string source_text(const MeshSource& source) {
  Listing listing;
  listing.add_if(!source.format.empty(), source.format);
  listing.add_if(!source.up_axis.empty(), "up axis " + source.up_axis);
  listing.add_if(source.nodes > 1, std::to_string(source.nodes) + " nodes");
  listing.add_if(source.ignored_primitives > 0,
                 pluralize(source.ignored_primitives, "point or line left out", "points and lines left out"));
  listing.add_if(!source.note.empty(), source.note);
  return listing.text("");
}

std::string polygons_text(const PolygonSplit& split) {
  std::string text = std::to_string(split.polygons) + " of four or more corners, split into triangles";
  if (split.non_planar == 0) return text;
  return text + "; " + std::to_string(split.non_planar) + " not planar, up to " +
         format_number(split.largest_distance, 4) + " m from a plane, between whose extreme splits lie " +
         format_number(split.split_volume, 4) + " m^3";
}

std::string vertices_text(const MeshReport& report) {
  std::string text = std::to_string(report.vertices_stored) + " stored, " +
                     std::to_string(report.vertices_welded) + " after welding";
  if (report.weld == WeldKind::kTolerance) {
    text += "; cracks closed by moving vertices up to " + format_number(report.weld_largest_move) + " m";
  }
  return text;
}

std::string edges_text(const MeshReport& report) {
  Listing listing;
  listing.add_if(report.boundary_edges > 0, std::to_string(report.boundary_edges) + " boundary");
  listing.add_if(report.non_manifold_edges > 0, std::to_string(report.non_manifold_edges) + " non-manifold");
  listing.add_if(report.misoriented_edges > 0, std::to_string(report.misoriented_edges) + " misoriented");
  listing.add_if(report.balanced_edges > 0, std::to_string(report.balanced_edges) + " balanced");
  if (!report.closed()) return listing.text("");
  return listing.text("each used once in each direction") +
         (report.balanced_edges > 0 ? " (shared by four or more faces)" : "");
}

std::string state_text(const MeshReport& report) {
  if (report.triangles == 0) return "none";
  if (report.closed()) return report.balanced_edges == 0 ? "closed" : "balanced";
  return report.non_manifold_edges == 0 && report.misoriented_edges == 0 ? "open" : "open or inconsistent";
}

std::string faces_text(const MeshReport& report) {
  Listing listing;
  listing.add_if(report.dropped_faces > 0,
                 std::to_string(report.dropped_faces) + " dropped for using a vertex twice");
  listing.add_if(report.degenerate_faces > 0, std::to_string(report.degenerate_faces) + " of zero area");
  listing.add_if(report.duplicate_faces > 0,
                 pluralize(report.duplicate_faces, "duplicate", "duplicates") + " of an earlier face");
  return listing.text("");
}

std::string component_text(const ComponentReport& component) {
  std::string text = pluralize(component.triangles, "triangle", "triangles") + ", " +
                     format_number(component.volume) + " m^3";
  if (!component.closed) text += ", open";
  if (component.cavity) text += ", a cavity";
  if (component.nested) text += ", inside another: its volume counts twice";
  if (component.flipped) text += ", was inside out: its winding was reversed";
  return text;
}

// closing: that of all holes, if it is known.
std::string hole_text(const HoleReport& hole, const std::optional<ClosingEstimate>& closing) {
  return pluralize(hole.edges, "edge", "edges") + ", from " + coordinates(hole.box.min_B) + " to " +
         coordinates(hole.box.max_B) + "; " + format_number(hole.perimeter, 4) + " m around, " +
         format_number(hole.area, 4) + " m^2, " + format_number(hole.bulge, 3) +
         " m^3 in a hemisphere over it" +
         (closing ? ", " + percent(hole.bulge / closing->volume) + " of the closed volume" : "") +
         (hole.slit ? "; a slit" : "");
}

std::int64_t count_components(const MeshReport& report, bool ComponentReport::*flag) {
  return std::count_if(report.components.begin(), report.components.end(),
                       [flag](const ComponentReport& component) { return component.*flag; });
}

void add_repair(const RepairReport& repair, AlignedLines& lines) {
  std::string_view label = "repair";
  for (const std::string& line : to_lines(repair)) {
    lines.add(label, line);
    label = "";
  }
}

void add_components(const MeshReport& report, AlignedLines& lines) {
  if (report.components.size() < 2) return;
  const std::int64_t cavities = count_components(report, &ComponentReport::cavity);
  const std::int64_t nested = count_components(report, &ComponentReport::nested);
  const std::int64_t flipped = count_components(report, &ComponentReport::flipped);
  Listing listing;
  listing.add_if(true, std::to_string(report.components.size()));
  listing.add_if(cavities > 0, pluralize(cavities, "cavity", "cavities"));
  listing.add_if(nested > 0, std::to_string(nested) + " inside another");
  listing.add_if(flipped > 0, std::to_string(flipped) + " flipped");
  lines.add("components", listing.text(""));
  for (std::size_t i = 0; i < report.components.size() && i < kMaxListed; ++i) {
    lines.add("", component_text(report.components[i]));
  }
  if (report.components.size() > kMaxListed) {
    lines.add("", "and " + std::to_string(report.components.size() - kMaxListed) + " smaller ones");
  }
}

void add_holes(const MeshReport& report, AlignedLines& lines) {
  if (report.holes.empty()) return;
  lines.add("holes", std::to_string(report.holes.size()));
  for (std::size_t i = 0; i < report.holes.size() && i < kMaxListed; ++i) {
    lines.add("", std::to_string(i + 1) + ": " + hole_text(report.holes[i], report.closing));
  }
  if (report.holes.size() > kMaxListed) {
    lines.add("", "and " + std::to_string(report.holes.size() - kMaxListed) + " smaller ones");
  }
}

void add_overlap(const MeshReport& report, AlignedLines& lines) {
  if (!report.intersecting_pairs) return;
  const std::int64_t pairs = *report.intersecting_pairs;
  lines.add("intersecting", pluralize(pairs, "pair of faces", "pairs of faces") +
                                (report.intersections_cut_off ? " at least, too many to count" : ""));
  const double share = report.overlap_volume.value_or(0.0) / report.volume;
  if (pairs == 0 && !(share > kMinOverlap)) return;
  if (report.overlap_volume) {
    const double counted = share > kMinOverlap ? share : 0.0;
    lines.add("overlap", format_number(counted * report.volume, 4) + " m^3 count more than once, " +
                             percent(counted) + " of the volume (within some 0.1 %)");
  } else {
    lines.add("overlap", report.closed() ? "not known: what overlaps counts more than once"
                                         : "not known before the mesh is closed");
  }
}

// Rounded up to two digits: what a limit has to be at least.
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

// The axis across which the mesh looks like half a body, because much of its largest rim lies in the plane x
// = 0 or y = 0, at which it ends; empty if there is none. Ships are symmetric in y more often than in x, and
// z = 0 is where panels end at the water.
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

std::string to_text(const MeshReport& report) {
  AlignedLines lines;
  const std::string source = source_text(report.source);
  if (!source.empty()) lines.add("source", source);
  lines.add("surface", state_text(report));
  lines.add("triangles", std::to_string(report.triangles));
  if (report.source.polygons.polygons > 0) lines.add("polygons", polygons_text(report.source.polygons));
  lines.add("vertices", vertices_text(report));
  const std::string faces = faces_text(report);
  if (!faces.empty()) lines.add("faces", faces);
  add_repair(report.repair, lines);
  if (report.triangles == 0) return report.name + "\n" + lines.text();
  lines.add("edges", edges_text(report));
  lines.add("box", "from " + coordinates(report.box.min_B) + " to " + coordinates(report.box.max_B) +
                       " m, diagonal " + format_number(report.diagonal, 7) + " m");
  lines.add("area", format_number(report.area) + " m^2");
  lines.add("volume", format_number(report.volume) + " m^3" +
                          (report.closed() ? "" : " about the box's centre; meaningless for an open mesh"));
  lines.add("", "from x, y, z: " + format_vector(report.volume_by_axis) + " m^3");
  lines.add("", "integral of n dA: " + format_vector(report.area_vector) + " m^2");
  add_components(report, lines);
  add_holes(report, lines);
  add_overlap(report, lines);
  if (report.flipped) lines.add("flipped", "was inside out: the winding of all faces was reversed");
  return report.name + "\n" + lines.text();
}

}  // namespace buoyancy
