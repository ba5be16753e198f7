#include "tests/truth/exact_oracle.h"

#include "tests/truth/exact_oracle-inl.h"
#include "tests/truth/rational.h"

namespace buoyancy {

template struct ExactDisplacement<Rational>;
template Vec3T<Rational> exactly_in_world<Rational>(const Pose&, const Vec3T<Rational>&);
template ExactPlane<Rational> exact_plane<Rational>(const Pose&, const Water&, const Vec3&);
template ExactDisplacement<Rational> exact_displacement<Rational>(const TriangleMesh&, const Pose&,
                                                                  const Water&);

template struct ExactDisplacement<long double>;
template ExactDisplacement<long double> exact_displacement<long double>(const TriangleMesh&, const Pose&,
                                                                        const Water&);

}  // namespace buoyancy
