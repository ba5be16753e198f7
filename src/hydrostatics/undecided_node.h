// What a node of the moment tree contributes while it is undecided: the water may cross it, but it is not
// looked into.
//
// The pressure of a point at height z is min(z, 0). Over a node whose heights lie in [-below, above] it is
// replaced by polynomials that the node's moments integrate without its triangles:
//   line      p1(z) = a (z - above / 2),   a = below / (below + above),         |p1 - min(z, 0)| <= a above /
//   2 parabola  p2(z) = z / 2 - z^2 / (2 d) - d / 16,  d = max(below, above),     |p2 - min(z, 0)| <= d / 16
// The volume and the lever of the node's middle y_m take p2, which is up to four times as good; what the
// node's points are away from its middle, up to `radius`, takes p1, since the moments know no third powers of
// y:
//   U = y_m int p2 n_k dA + int (y - y_m) p1 n_k dA.
// So its errors are at most e in volume and e L_r in torque/(rho g) about any point, with
//   e = (d / 16 + (a above / 2) radius / (L / 2)) int |n_k| dA,
// as L_r >= L / 2; or a above / 2 int |n_k| dA where the line serves both, whichever is less
// (docs/mathematics.md, "Tolerance").
#pragma once

#include <algorithm>
#include <cstdint>

namespace buoyancy {

struct UndecidedNode {
  std::uint32_t child;   // as in TreeNode
  std::uint32_t parent;  // index of the node whose child it is
  std::uint32_t place;   // among the parent's children
  float below, above;    // m, >= 0
  float error;           // m^3: e
  float line_error;      // m^3: where the line serves both, which is cheaper; not less than error
};

// p1 = slope z + offset and p2 - p1 = quadratic z^2 + linear z + constant; the latter zero where p1 serves
// both.
struct PressureFit {
  double slope, offset;
  double quadratic, linear, constant;
};

// curved: with a parabola; else the line serves both.
inline PressureFit fit_pressure(double below, double above, bool curved) {
  PressureFit fit{};
  fit.slope = below / (below + above);
  fit.offset = -0.5 * fit.slope * above;
  if (curved) {
    const double d = std::max(below, above);
    fit.quadratic = -0.5 / d;
    fit.linear = 0.5 - fit.slope;
    fit.constant = -d / 16.0 - fit.offset;
  }
  return fit;
}

}  // namespace buoyancy
