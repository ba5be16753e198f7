// Reports what the repair of a mesh did: the automatic one (mesh_repair.h) and that which a user asked for
// (mirroring.h, hole_closing.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec3.h"

namespace buoyancy {

// What a step counts is in brackets.
enum class RepairKind {
  kWeld,              // merged vertices within 1e-6 L of each other [vertices]
  kInsertVertices,    // inserted vertices into edges of other faces on which they lie [vertices]
  kRemoveDuplicates,  // removed copies of faces, of the same winding [faces]
  kRemoveBackFaces,   // removed one of the two sides of faces that are stored for both sides [faces]
  kRemoveOpposites,  // removed both of two faces that are each other's opposite: they enclose nothing [faces]
  kTurnFaces,        // reversed the winding of single faces [faces]
  kRemoveInnerFaces,  // removed faces inside the surface that bounds the body [faces]
  kRemoveSheets,      // removed faces of zero thickness that bound nothing [faces]
  kCapHoles,          // closed holes that are negligibly small [holes]
  kMirror,            // added the mirror image [faces]
  kRaiseRims,         // added walls along rims [rims]
  kCloseHoles,        // closed holes as asked for [holes]
};
std::string_view to_string(RepairKind kind);

struct EnclosedSolid {
  double volume = 0.0;             // [m^3]
  Vec3 centroid_B = Vec3::Zero();  // [m]
};

struct RepairStep {
  RepairKind kind = RepairKind::kWeld;
  std::int64_t count = 0;
  double area = 0.0;      // of the faces that it moved, removed, turned or added [m^2]
  double max_move = 0.0;  // of a vertex, or of a vertex from the edge into which it was inserted [m]
  // What the mesh encloses, where its edges are matched.
  std::optional<EnclosedSolid> before, after;
};

enum class RepairObstacle {
  kTooMany,           // the step would take too long
  kNotOrientable,     // faces of one surface that cannot all have a consistent winding (a Moebius strip)
  kSelfIntersection,  // faces cross or touch each other, so that inside and outside cannot be told apart
  kLeak,              // the outside reaches the inside, as through a hole
  kAmbiguous,         // sheets that might be parts of a surface
  kTooThin,           // moved vertices might have changed the volume by more than 1 %
  kBulge,             // the holes are larger than the user allows
  kDisagreement,      // caps over the holes enclose volumes that differ by more than the user allows
  kNoRim,             // no rim faces up
  kStillOpen,         // what was asked for leaves holes
};
std::string_view to_string(RepairObstacle obstacle);

// Faults that a step found and left as they are.
struct SkippedRepair {
  RepairKind kind = RepairKind::kWeld;
  RepairObstacle obstacle = RepairObstacle::kTooMany;
  std::int64_t faces = 0;  // affected; for kWeld and kInsertVertices unmatched edges, for kCloseHoles holes
  double share = 0.0;      // of the volume; for kBulge and kDisagreement

  bool operator==(const SkippedRepair&) const = default;
};

struct RepairReport {
  std::vector<RepairStep> steps;  // in the order in which they were made
  std::vector<SkippedRepair> skipped;
  // Bound on the volume between the surfaces before and after all welds and insertions of vertices, Vol(A xor
  // B) for closed surfaces A and B: sum of area times move [m^3].
  double volume_bound = 0.0;
  // Estimate, not a bound, of the volume that the true surface over the capped holes may add or remove: that
  // of a hemisphere over each [m^3].
  double cap_bulge = 0.0;
  // Estimate of how much the volumes under different caps of the holes that a user closes differ [m^3].
  double cap_disagreement = 0.0;

  bool empty() const { return steps.empty() && skipped.empty(); }
};

// Adds what a later repair of the same body, or that of another part of it, did.
void append(const RepairReport& more, RepairReport& report);

}  // namespace buoyancy
