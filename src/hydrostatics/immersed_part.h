// The part of a body that is under water and its waterplane, as moments in the body's axes, and the
// hydrostatics that follow from them.
#pragma once

#include <optional>

#include "hydrostatics/displacement_moments.h"
#include "hydrostatics/hydrostatics.h"
#include "hydrostatics/tank.h"

namespace buoyancy {

struct ImmersedPart {
  DisplacementMoments<double> moments;  // B axes, about `point`
  Vec3 point = Vec3::Zero();            // [m], B axes, from an origin that the caller knows
  double wetted_area = 0.0;             // [m^2]
};

// mesh: with its tree. plane: about the mesh's centre c, which is the origin of the part's point. A
// waterplane whose area does not exceed its error bound counts as absent. Complexity: that of
// hydrostatics().
ImmersedPart immersed_part(const HydrostaticMesh& mesh, const WaterPlane& plane);

// [m^2], ImmersedPart::wetted_area alone.
double wetted_area(const HydrostaticMesh& mesh, const WaterPlane& plane);

// Adds the moments of a part of a body, times a factor, to a sum. offset_B: [m], from the sum's origin to the
// part's. The part's wetted area is added only if the factor is above 0.
void add_scaled(const ImmersedPart& part, const Vec3& offset_B, double factor, ImmersedPart& sum);

// Computes what hydrostatics() returns from an immersed part. origin_B: [m], from which `part.point` is
// measured. volume_tolerance: [m^3], below which a volume has no centre. center_of_mass_B: of the body with
// its liquids. liquids: about the reference point; they contribute to the stiffness and, by their free
// surfaces, to the metacentric heights. water: of one density; with layers see hydrostatics_in()
// (density_steps.h).
std::optional<Hydrostatics> hydrostatics_of(const ImmersedPart& part, const Vec3& origin_B,
                                            double volume_tolerance, const Eigen::Quaterniond& q_WB,
                                            const Water& water, const Vec3& reference_B,
                                            const std::optional<Vec3>& center_of_mass_B,
                                            const LiquidSum& liquids = {});

}  // namespace buoyancy
