// The righting arms of a box, from a clipped rectangle: independent of the meshes and solvers.
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace buoyancy {

struct BoxSection {
  double beam = 0.0;   // [m]
  double depth = 0.0;  // [m]
  double draft = 0.0;  // [m], upright

  // [m], KN at a heel to starboard [rad].
  double kn(double heel) const {
    const double area = beam * draft;
    double low = -beam - depth;
    double high = -low;
    for (int round = 0; round < 100; ++round) {
      const double level = 0.5 * (low + high);
      (wet(heel, level).area < area ? low : high) = level;
    }
    const Wet part = wet(heel, low);
    return std::sin(heel) * part.z / part.area - std::cos(heel) * part.y / part.area;
  }
  double gz(double heel, double kg) const { return kn(heel) - kg * std::sin(heel); }
  // [m rad], by Simpson's rule.
  double area(double from, double to, double kg) const {
    constexpr int kPanels = 400;
    const double step = (to - from) / kPanels;
    double sum = gz(from, kg) + gz(to, kg);
    for (int i = 1; i < kPanels; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * gz(from + i * step, kg);
    return sum * step / 3.0;
  }

 private:
  struct Wet {
    double area = 0.0, y = 0.0, z = 0.0;  // y: to port; z: over the keel
  };

  Wet wet(double heel, double level) const {
    const std::vector<std::pair<double, double>> corners{
        {-0.5 * beam, 0.0}, {0.5 * beam, 0.0}, {0.5 * beam, depth}, {-0.5 * beam, depth}};
    std::vector<std::pair<double, double>> polygon;
    const auto height = [&](const auto& p) {
      return std::sin(heel) * p.first + std::cos(heel) * p.second - level;
    };
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& a = corners[i];
      const auto& b = corners[(i + 1) % 4];
      const double at_a = height(a);
      const double at_b = height(b);
      if (at_a <= 0.0) polygon.push_back(a);
      if ((at_a <= 0.0) == (at_b <= 0.0)) continue;
      const double share = at_a / (at_a - at_b);
      polygon.emplace_back(a.first + share * (b.first - a.first), a.second + share * (b.second - a.second));
    }
    Wet sum;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const auto& [y0, z0] = polygon[i];
      const auto& [y1, z1] = polygon[(i + 1) % polygon.size()];
      const double cross = y0 * z1 - y1 * z0;
      sum.area += 0.5 * cross;
      sum.y += cross * (y0 + y1) / 6.0;
      sum.z += cross * (z0 + z1) / 6.0;
    }
    return sum;
  }
};

}  // namespace buoyancy
