#include "tests/truth/ball.h"

#include <cmath>
#include <optional>

#include "tests/truth/exact_oracle-inl.h"

namespace buoyancy {

Ball Ball::around(const Rational& number) {
  Ball ball;
  const auto high = number.convert_to<double>();
  ball.mid = static_cast<long double>(high) + (number - Rational(high)).convert_to<double>();
  ball.rad = std::abs(ball.mid) * 0x1p-60L;
  return ball;
}

bool Ball::contains(const Rational& number) const {
  const Rational distance = number - Rational(static_cast<double>(mid)) -
                            Rational(static_cast<double>(mid - static_cast<double>(mid)));
  return abs(distance) <= Rational(static_cast<double>(rad)) * Rational(1.0 + 0x1p-40);
}

template <>
ExactPlane<Ball> exact_plane<Ball>(const Pose& pose, const Water& water, const Vec3& o_B) {
  const auto plane = exact_plane<Rational>(pose, water, o_B);
  return {{Ball::around(plane.up_B.x()), Ball::around(plane.up_B.y()), Ball::around(plane.up_B.z())},
          Ball::around(plane.h)};
}

// Takes a height from rational arithmetic if its ball does not determine the sign and twelve digits: heights
// decide what is wet and where an edge is cut.
template <>
class SettledHeights<Ball> {
 public:
  SettledHeights(const TriangleMesh& mesh, const Pose& pose, const Water& water)
      : mesh_(&mesh), pose_(&pose), water_(&water) {}

  Ball settled(std::size_t vertex, const Ball& height) {
    if (height.rad <= std::abs(height.mid) * 0x1p-40L) return height;
    if (!plane_) plane_ = exact_plane<Rational>(*pose_, *water_);
    const Vec3T<Rational> x = mesh_->vertex(static_cast<std::int32_t>(vertex)).cast<Rational>();
    return Ball::around(Rational(plane_->up_B.dot(x) - plane_->h));
  }

 private:
  const TriangleMesh* mesh_;
  const Pose* pose_;
  const Water* water_;
  std::optional<ExactPlane<Rational>> plane_;
};

template struct ExactDisplacement<Ball>;
template Vec3T<Ball> exactly_in_world<Ball>(const Pose&, const Vec3T<Ball>&);
template ExactDisplacement<Ball> exact_displacement<Ball>(const TriangleMesh&, const Pose&, const Water&);

}  // namespace buoyancy
