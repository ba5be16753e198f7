#include "wave_loads/wave_load.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Geometry>

#include "wave_loads/wave_query.h"

namespace buoyancy {

namespace {

// As few cells as keep every point of a box within `reach` of a centre. low, high: corners of the box, over
// 1 / k_max.
CellGrid grid_over(const std::array<double, 3>& low, const std::array<double, 3>& high, double reach) {
  CellGrid grid;
  std::array<double, 3> cells{1.0, 1.0, 1.0};
  constexpr double kShortest = 1e-3;
  const auto edge = [&](std::size_t axis) {
    return std::max(high[axis] - low[axis], kShortest) / cells[axis];
  };
  const auto longest = [&] {
    std::size_t axis = 0;
    for (std::size_t other = 1; other < 3; ++other) {
      if (edge(other) > edge(axis)) axis = other;
    }
    return axis;
  };
  // Of very long boxes, most at once.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double fewest = std::floor(edge(axis) / (2.0 * reach));
    cells[axis] = std::max(1.0, fewest > 16.0 ? std::floor(1.6 * fewest) : fewest);
  }
  while (std::hypot(edge(0), edge(1), edge(2)) > 2.0 * reach) cells[longest()] += 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis) grid.edge[axis] = edge(axis);
  grid.origin = {low[0], low[1], high[2]};
  return grid;
}

}  // namespace

WaveLoad wave_load(const WaveBody& body, const SeaExpansion& expansion, const SeaSnapshot& sea,
                   const Pose& pose, const Vec3& reference_B) {
  const HydrostaticMesh& mesh = *body.mesh;
  const Sea& of_sea = sea.sea();
  const Water& water = of_sea.water();
  const Eigen::Matrix3d R_WB = pose.q_WB.normalized().toRotationMatrix();
  const Vec3 c_W = pose.p_WB + R_WB * mesh.center_B;

  WaveQuery query;
  query.tree = body.tree;
  query.expansion = &expansion;
  query.sea = &sea;
  query.e1_B = R_WB.transpose() * of_sea.axes().e1_W;
  query.e2_B = R_WB.transpose() * of_sea.axes().e2_W;
  query.up_B = R_WB.transpose() * water.up_W;
  query.reference = reference_B - mesh.center_B;
  query.x1 = of_sea.axes().e1_W.dot(c_W);
  query.x2 = of_sea.axes().e2_W.dot(c_W);
  query.zeta = water.up_W.dot(c_W) - water.level;
  query.depth = of_sea.depth();
  query.hydrostatic = of_sea.pressure() == WavePressure::kHydrostatic;
  query.max_lever = mesh.max_lever_arm(reference_B);
  query.budget = body.tolerance * std::abs(mesh.volume);

  const Vec3 extent = (mesh.box_max - mesh.box_min) * 0.5;
  const Vec3 middle = 0.5 * (mesh.box_max + mesh.box_min);
  const double reach_up = extent.dot(query.up_B.cwiseAbs());
  const double height = query.zeta + query.up_B.dot(middle);
  const double crest = sea.amplitude_factor() * expansion.amplitude_sums[0];
  if (height - reach_up > crest) return {};
  query.submerged = height + reach_up < -crest;
  query.usual_elevation = 2.0 * sea.amplitude_factor() * expansion.typical_elevation;
  // Single precision where its rounding leaves room for the tolerance.
  const double heights =
      query.usual_elevation + (query.submerged ? 0.0 : 0.5 * (std::abs(height) + reach_up));
  const double single_rounding =
      kRoundingFactor * 0.5 * std::numeric_limits<float>::epsilon() * heights * body.tree->area;
  const bool single = body.tolerance >= 1e-4 && single_rounding <= 0.5 * query.budget;
  // The surface that is integrated is not quite where the body's is: the tree's grid, the rounding of the
  // body's position, and that of positions on the body.
  query.displacement =
      body.tree->displacement + 1e-15 * (pose.p_WB.norm() + mesh.center_B.norm() + std::abs(water.level)) +
      mesh.diagonal *
          (single ? std::numeric_limits<float>::epsilon() : std::numeric_limits<double>::epsilon());
  // What a cell leaves out at its corners, over the whole surface and relative to the tolerance. It grows
  // with the ninth power of the distance from the centre: on average it is less than a tenth of this.
  // Fine tolerances need more of the tolerance for themselves. Chosen for the least time at 1e-2 to 1e-5.
  const double of_usual = body.tolerance / 1e-3;
  const double truncation_share = 3.0 * std::sqrt(of_usual) * std::min(1.0 + 0.1 * of_usual, 2.0);
  const double reach =
      expansion.reach_within(truncation_share * query.budget / (body.tree->area * sea.amplitude_factor()));
  const double k = expansion.k_max;
  const double reach_1 = extent.dot(query.e1_B.cwiseAbs());
  const double reach_2 = extent.dot(query.e2_B.cwiseAbs());
  const double middle_1 = query.e1_B.dot(middle);
  const double middle_2 = query.e2_B.dot(middle);
  const double top = std::clamp(height + reach_up + query.usual_elevation, -query.depth, 0.0);
  const double bottom = std::clamp(height - reach_up - query.usual_elevation, -query.depth, top);
  query.grid = grid_over({k * (middle_1 - reach_1), k * (middle_2 - reach_2), k * bottom},
                         {k * (middle_1 + reach_1), k * (middle_2 + reach_2), k * top}, reach);
  WaveLoad load = single ? descend_in_single_precision(query) : descend_in_double_precision(query);
  if (query.submerged) {
    load.force += mesh.volume * query.up_B;
    const Vec3 lever = mesh.centroid - query.reference;
    load.torque += lever.cross(mesh.volume * query.up_B);
    load.volume = mesh.volume;
    load.volume_bound = 0.0;
    load.moment = mesh.volume * mesh.centroid;
  }
  // The displaced pressure, besides its change, moves the torque.
  const double deepest = query.submerged ? crest : std::max(reach_up - height, 0.0) + 2.0 * crest;
  load.torque_bound += query.displacement * body.tree->area * deepest;
  return load;
}

}  // namespace buoyancy
