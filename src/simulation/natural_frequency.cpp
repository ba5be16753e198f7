#include "simulation/natural_frequency.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "geometry/rotation_between.h"
#include "hydrostatics/hydrostatics.h"

namespace buoyancy {
namespace {

constexpr int kLevels = 16;

using Mat6 = Eigen::Matrix<double, 6, 6>;

// The mesh with its tree, which only some methods give it.
class TreeOf {
 public:
  explicit TreeOf(const HydrostaticMesh& mesh) : mesh_(&mesh) {
    if (mesh.tree) return;
    copy_ = mesh;
    copy_->tree = build_moment_tree(copy_->surface);
    mesh_ = &*copy_;
  }
  TreeOf(const TreeOf&) = delete;
  TreeOf& operator=(const TreeOf&) = delete;
  ~TreeOf() = default;

  const HydrostaticMesh& mesh() const { return *mesh_; }

 private:
  std::optional<HydrostaticMesh> copy_;
  const HydrostaticMesh* mesh_;
};

// Of a symmetric matrix, by cyclic Jacobi rotations, which converge quadratically. Eigen's solver of fixed
// size takes seconds to compile.
double largest_eigenvalue(Mat6 matrix) {
  constexpr int kMaxSweeps = 30;
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    bool diagonal = true;
    for (int p = 0; p < 5; ++p) {
      for (int q = p + 1; q < 6; ++q) {
        const double off = matrix(p, q);
        const double scale = std::abs(matrix(p, p)) + std::abs(matrix(q, q));
        if (std::abs(off) <= std::numeric_limits<double>::epsilon() * 0x1p-4 * scale) continue;
        diagonal = false;
        const double theta = (matrix(q, q) - matrix(p, p)) / (2.0 * off);
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
        const double c = 1.0 / std::hypot(t, 1.0);
        const double s = t * c;
        for (int k = 0; k < 6; ++k) {
          const double k_p = matrix(k, p);
          const double k_q = matrix(k, q);
          matrix(k, p) = c * k_p - s * k_q;
          matrix(k, q) = s * k_p + c * k_q;
        }
        for (int k = 0; k < 6; ++k) {
          const double p_k = matrix(p, k);
          const double q_k = matrix(q, k);
          matrix(p, k) = c * p_k - s * q_k;
          matrix(q, k) = s * p_k + c * q_k;
        }
        matrix(p, q) = matrix(q, p) = 0.0;
      }
    }
    if (diagonal) break;
  }
  return matrix.diagonal().maxCoeff();
}

double frequency_at(const HydrostaticMesh& mesh, const RigidBody& rigid, const RigidBodyState& state,
                    const Water& water) {
  const std::optional<Hydrostatics> found =
      hydrostatics(mesh, pose_of(rigid, state), water, rigid.center_of_mass_B, std::nullopt);
  if (!found) return 0.0;
  const Mat3 axes_W = state.q_WB.toRotationMatrix() * rigid.principal_axes_B;
  // M^-1/2 K M^-1/2, with M^-1/2 = diag(by_mass, by_inertia): block by block, since products of 6 x 6
  // matrices are expensive to compile.
  const double by_mass = 1.0 / std::sqrt(rigid.mass);
  const Mat3 by_inertia =
      axes_W * rigid.principal_inertia.cwiseSqrt().cwiseInverse().asDiagonal() * axes_W.transpose();
  const Mat6& K = found->stiffness;
  Mat6 scaled;
  scaled.topLeftCorner<3, 3>() = by_mass * by_mass * K.topLeftCorner<3, 3>();
  scaled.topRightCorner<3, 3>() = by_mass * K.topRightCorner<3, 3>() * by_inertia;
  scaled.bottomLeftCorner<3, 3>() = by_mass * by_inertia * K.bottomLeftCorner<3, 3>();
  scaled.bottomRightCorner<3, 3>() = by_inertia * K.bottomRightCorner<3, 3>() * by_inertia;
  scaled = (0.5 * (scaled + scaled.transpose())).eval();
  if (!scaled.allFinite()) return 0.0;
  return std::sqrt(std::max(largest_eigenvalue(scaled), 0.0));
}

// Up as seen from the body: along the principal axes and between each two and three of them, both ways. What
// is flat or upright about a body usually is so along these.
std::vector<Vec3> directions_B(const RigidBody& rigid) {
  std::vector<Vec3> directions;
  const auto components = {-1.0, 0.0, 1.0};
  for (const double x : components) {
    for (const double y : components) {
      for (const double z : components) {
        const Vec3 direction_P(x, y, z);
        if (direction_P == Vec3::Zero()) continue;
        directions.emplace_back(rigid.principal_axes_B * direction_P.normalized());
      }
    }
  }
  return directions;
}

struct Extent {
  double lowest = std::numeric_limits<double>::infinity();    // m
  double highest = -std::numeric_limits<double>::infinity();  // m
};

// Of the mesh along a direction, from the centre of mass.
Extent extent_along(const HydrostaticMesh& mesh, const RigidBody& rigid, const Vec3& up_B) {
  const double offset = up_B.dot(mesh.center_B - rigid.center_of_mass_B);
  Extent extent;
  for (const Triangle& triangle : mesh.surface.triangles) {
    for (const std::int32_t i : triangle) {
      const double height = up_B.dot(mesh.vertex(i)) + offset;
      extent.lowest = std::min(extent.lowest, height);
      extent.highest = std::max(extent.highest, height);
    }
  }
  return extent;
}

}  // namespace

double natural_frequency_bound(const Body& body, const RigidBody& rigid, const Water& water) {
  // The parts of K are the waterplane's, which scaled have the trace rho g A (1/m + l^2/I) at most, and the
  // buoyancy's lever, at most rho g V l / I. No waterplane is larger than the whole surface A, and
  // V <= A l / 3.
  const HydrostaticMesh& mesh = body.prepared_mesh->mesh;
  const double lever = mesh.max_lever_arm(rigid.center_of_mass_B);
  const double levers = 4.0 / 3.0 * lever * lever / rigid.principal_inertia[0];
  return std::sqrt(water.density * water.gravity * mesh.area * (1.0 / rigid.mass + levers));
}

HighestNaturalFrequency highest_natural_frequency(const Body& body, const RigidBody& rigid,
                                                  const RigidBodyState& state, const Water& water) {
  const TreeOf tree(body.prepared_mesh->mesh);
  const HydrostaticMesh& mesh = tree.mesh();
  const Solver solver(mesh, Method::kHierarchical);
  const std::optional<double> energy = mechanical_energy(rigid, state, solver, water);
  if (!energy) return {};

  HighestNaturalFrequency fastest;
  const auto consider = [&](const RigidBodyState& candidate, double draft) {
    const double frequency = frequency_at(mesh, rigid, candidate, water);
    if (frequency > fastest.frequency) fastest = {frequency, draft};
  };
  const double height = water.up_W.dot(state.center_W) - water.level;
  const auto sweep = [&](const Eigen::Quaterniond& q_WB) {
    const Extent extent = extent_along(mesh, rigid, q_WB.conjugate() * water.up_W);
    for (int i = 1; i <= kLevels; ++i) {
      // From half a level's distance above the lowest vertex to the highest.
      const double draft = (extent.highest - extent.lowest) * (i < kLevels ? (i - 0.5) / (kLevels - 1) : 1.0);
      RigidBodyState candidate;
      candidate.q_WB = q_WB;
      candidate.center_W = water.up_W * (water.level - extent.lowest - draft);
      const std::optional<double> potential = mechanical_energy(rigid, candidate, solver, water);
      if (potential && *potential <= *energy) consider(candidate, draft);
    }
    return extent;
  };
  const Extent present = sweep(state.q_WB);
  consider(state, -(height + present.lowest));
  for (const Vec3& up_B : directions_B(rigid)) {
    sweep(rotation_between(up_B, water.up_W));
  }
  return fastest;
}

}  // namespace buoyancy
