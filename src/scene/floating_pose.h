// Finds the draft at which a body floats in a given attitude.
#pragma once

#include <optional>

#include "flotation/floating_body.h"
#include "hydrostatics/hydrostatics.h"

namespace buoyancy {

struct FloatingPose {
  Pose pose;                  // p_WB on the line through W's origin along up
  double draft = 0.0;         // [m], depth of the lowest vertex
  Hydrostatics hydrostatics;  // about the centre of mass
};

// The pose with this attitude at which the body displaces `volume` [m^3], its weight over that of a cubic
// metre of water. Only the force is balanced there: the centre of buoyancy need not lie above or below the
// centre of mass. mesh: with its tree. q_WB: unit.
//
// Returns nullopt where there is no such pose: `volume` is not between 0 and that of the mesh, or an open
// mesh would take in water first; and where a number is beyond double's range.
//
// The volume decreases as the body rises. The root is bracketed by the heights at which the body is fully
// submerged and dry, and found by false position and bisection; it ends with a volume within the larger of
// G_V (HydrostaticMesh::volume_tolerance) and the waterplane area times the rounding of the height.
// Complexity: O(triangles) for the draft, one hydrostatic query, and some eight of the volume, at most 200.
std::optional<FloatingPose> find_floating_pose(const HydrostaticMesh& mesh, const Eigen::Quaterniond& q_WB,
                                               double volume, const Water& water,
                                               const Vec3& center_of_mass_B);

// The same for a closed body with compartments and tanks: it displaces its mass, with the liquids. The
// hydrostatics are those of floating_state(). Complexity: some ten of floating_state().
std::optional<FloatingPose> find_floating_pose(const FloatingBody& body, const Eigen::Quaterniond& q_WB,
                                               const Water& water);

}  // namespace buoyancy
