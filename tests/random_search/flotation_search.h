// The random search for attitudes that are no stable equilibria (docs/mathematics.md, "Equilibrium and
// righting arms"): random closed meshes with random masses and centres of mass, every second one with up to
// two tanks and with a share of its volume open to the sea.
//
// A body lighter than the water that it can displace floats in at least one attitude. Each attitude balances
// within its bounds, and the energy rises when the body is moved a little: turned about a random axis and
// raised or lowered.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "tests/random_search/random_mesh.h"
#include "tests/random_search/search_engine.h"

namespace buoyancy {

struct RandomTank {
  BoundingBox box{Vec3::Zero(), Vec3::Zero()};  // [m]
  double fill = 0.0;
  double share_of_mass = 0.0;  // of the mass of body and liquids
};

struct FlotationCase {
  RandomMesh mesh;
  double relative_density = 0.0;         // mass over that of the water that the body can displace
  Vec3 center_of_mass_B = Vec3::Zero();  // [m], the centroid, or in the bounding box
  double permeability = 0.0;             // of a compartment that is the whole mesh; 0: there is none
  std::vector<RandomTank> tanks;

  std::string text() const;
};
FlotationCase random_flotation_case(RandomPoses& random);

// An attitude that balances has residuals within their bounds: the largest of their shares, of force and
// torque, over the attitudes of a case. 0 if there is none.
struct BalanceShares {
  double force = 0.0, torque = 0.0;
};
BalanceShares balance_shares(const FlotationCase& flotation);

RandomSearch flotation_search();

}  // namespace buoyancy
