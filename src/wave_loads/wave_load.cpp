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

// What does not depend on how the surface is known.
WaveQuery query_of(const WaveBody& body, const SeaSnapshot& sea, const Pose& pose, const Vec3& reference_B) {
  const HydrostaticMesh& mesh = *body.mesh;
  const Sea& of_sea = sea.sea();
  const Water& water = of_sea.water();
  const Eigen::Matrix3d R_WB = pose.q_WB.normalized().toRotationMatrix();
  const Vec3 c_W = pose.p_WB + R_WB * mesh.center_B;

  WaveQuery query;
  query.tree = body.tree;
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
  return query;
}

// The box of a mesh along the horizontal axes and up, from its centre c.
struct BoxInSea {
  BoxInSea(const HydrostaticMesh& mesh, const WaveQuery& query)
      : extent(0.5 * (mesh.box_max - mesh.box_min)), middle(0.5 * (mesh.box_max + mesh.box_min)) {
    reach_up = extent.dot(query.up_B.cwiseAbs());
    height = query.zeta + query.up_B.dot(middle);
  }

  Vec3 extent, middle;
  double reach_up, height;  // [m], height of the middle over the level
};

// Sets the displacement. Returns whether single precision suffices: its rounding leaves room for the
// tolerance.
bool set_precision(const WaveBody& body, const Pose& pose, const BoxInSea& box, WaveQuery& query) {
  const HydrostaticMesh& mesh = *body.mesh;
  const Water& water = query.sea->sea().water();
  const double heights =
      query.usual_elevation + (query.submerged ? 0.0 : 0.5 * (std::abs(box.height) + box.reach_up));
  const double single_rounding =
      kRoundingFactor * 0.5 * std::numeric_limits<float>::epsilon() * heights * body.tree->area;
  const bool single = body.tolerance >= 1e-4 && single_rounding <= 0.5 * query.budget;
  // The surface that is integrated is not quite where the body's is: the tree's grid, the rounding of the
  // body's position, and that of positions on the body.
  query.displacement =
      body.tree->displacement + 1e-15 * (pose.p_WB.norm() + mesh.center_B.norm() + std::abs(water.level)) +
      mesh.diagonal *
          (single ? std::numeric_limits<float>::epsilon() : std::numeric_limits<double>::epsilon());
  return single;
}

// Adds what the descent leaves out. crest: [m], bound on the elevation.
void complete(const WaveBody& body, const WaveQuery& query, const BoxInSea& box, double crest,
              WaveLoad& load) {
  const HydrostaticMesh& mesh = *body.mesh;
  if (query.submerged) {
    load.force += mesh.volume * query.up_B;
    const Vec3 lever = mesh.centroid - query.reference;
    load.torque += lever.cross(mesh.volume * query.up_B);
    load.volume = mesh.volume;
    load.volume_bound = 0.0;
    load.moment = mesh.volume * mesh.centroid;
  }
  // The displaced pressure, besides its change, moves the torque.
  const double deepest = query.submerged ? crest : std::max(box.reach_up - box.height, 0.0) + 2.0 * crest;
  load.torque_bound += query.displacement * body.tree->area * deepest;
}

// About the error of a wet patch over the third derivative and its mu3, as it is before it is refined.
constexpr double kThird = 4.0 / 6.0;

// In a sea on grids.
WaveLoad load_on_spline(const WaveBody& body, const SeaSnapshot& sea, const Pose& pose,
                        const Vec3& reference_B) {
  const ElevationBlend& surface = sea.surface();
  WaveQuery query = query_of(body, sea, pose, reference_B);
  const ElevationBounds bounds = surface.bounds_over(footprint_of(*body.mesh, pose, sea.sea().axes()));
  // Heights are over the middle of what the surface reaches there.
  query.mean_elevation = 0.5 * (static_cast<double>(bounds.low) + static_cast<double>(bounds.high));
  query.zeta -= query.mean_elevation;
  constexpr double kMargin = 1.0 + 1e-6;  // for the rounding of the middle
  query.max_elevation = kMargin * 0.5 * (static_cast<double>(bounds.high) - static_cast<double>(bounds.low)) +
                        1e-15 * std::abs(query.mean_elevation);
  const BoxInSea box(*body.mesh, query);
  if (box.height - box.reach_up > query.max_elevation) return {};
  query.submerged = box.height + box.reach_up < -query.max_elevation;
  query.usual_elevation = query.max_elevation;
  query.usual_wet_error = kThird * static_cast<double>(bounds.third);
  const bool single = set_precision(body, pose, box, query);
  for (std::size_t n = 0; n < surface.count; ++n) {
    const ElevationSpline& spline = *surface.parts[n].spline;
    query.displacement += 1e-15 * (spline.farthest() + pose.p_WB.norm() + body.mesh->center_B.norm());
    query.max_slope += surface.parts[n].share * spline.max_slope();
  }
  WaveLoad load =
      single ? descend_on_spline_in_single_precision(query) : descend_on_spline_in_double_precision(query);
  complete(body, query, box, query.max_elevation, load);
  return load;
}

}  // namespace

HorizontalBox footprint_of(const HydrostaticMesh& mesh, const Pose& pose, const HorizontalAxes& axes) {
  const Eigen::Matrix3d R_WB = pose.q_WB.normalized().toRotationMatrix();
  const Vec3 middle_W = pose.p_WB + R_WB * (mesh.center_B + 0.5 * (mesh.box_max + mesh.box_min));
  const Vec3 extent = 0.5 * (mesh.box_max - mesh.box_min);
  HorizontalBox box;
  for (std::size_t n = 0; n < 2; ++n) {
    const Vec3& axis_W = n == 0 ? axes.e1_W : axes.e2_W;
    const double middle = axis_W.dot(middle_W);
    const double reach = extent.dot((R_WB.transpose() * axis_W).cwiseAbs()) + 1e-6 * mesh.diagonal;
    box.low[n] = middle - reach;
    box.high[n] = middle + reach;
  }
  return box;
}

WaveLoad wave_load(const WaveBody& body, const SeaExpansion& expansion, const SeaSnapshot& sea,
                   const Pose& pose, const Vec3& reference_B) {
  if (sea.surface().count > 0) return load_on_spline(body, sea, pose, reference_B);
  WaveQuery query = query_of(body, sea, pose, reference_B);
  query.expansion = &expansion;
  query.k_max = expansion.k_max;
  const double crest = sea.amplitude_factor() * expansion.amplitude_sums[0];
  query.max_elevation = crest;
  query.max_slope = sea.amplitude_factor() * expansion.amplitude_sums[1];
  const BoxInSea box(*body.mesh, query);
  if (box.height - box.reach_up > crest) return {};
  query.submerged = box.height + box.reach_up < -crest;
  query.usual_elevation = 2.0 * sea.amplitude_factor() * expansion.typical_elevation;
  const double k = expansion.k_max;
  query.usual_wet_error = kThird * sea.amplitude_factor() * expansion.typical_third * k * k * k;
  query.usual_decay = query.hydrostatic ? 0.0 : k * expansion.typical_decay;
  const bool single = set_precision(body, pose, box, query);
  // What a cell leaves out at its corners, over the whole surface and relative to the tolerance. It grows
  // with the ninth power of the distance from the centre: on average it is less than a tenth of this.
  // Fine tolerances need more of the tolerance for themselves. Chosen for the least time at 1e-2 to 1e-5.
  const double of_usual = body.tolerance / 1e-3;
  const double truncation_share = 3.0 * std::sqrt(of_usual) * std::min(1.0 + 0.1 * of_usual, 2.0);
  const double reach =
      expansion.reach_within(truncation_share * query.budget / (body.tree->area * sea.amplitude_factor()));
  const double reach_1 = box.extent.dot(query.e1_B.cwiseAbs());
  const double reach_2 = box.extent.dot(query.e2_B.cwiseAbs());
  const double middle_1 = query.e1_B.dot(box.middle);
  const double middle_2 = query.e2_B.dot(box.middle);
  const double top = std::clamp(box.height + box.reach_up + query.usual_elevation, -query.depth, 0.0);
  const double bottom = std::clamp(box.height - box.reach_up - query.usual_elevation, -query.depth, top);
  query.grid = grid_over({k * (middle_1 - reach_1), k * (middle_2 - reach_2), k * bottom},
                         {k * (middle_1 + reach_1), k * (middle_2 + reach_2), k * top}, reach);
  WaveLoad load = single ? descend_in_single_precision(query) : descend_in_double_precision(query);
  complete(body, query, box, crest, load);
  return load;
}

}  // namespace buoyancy
