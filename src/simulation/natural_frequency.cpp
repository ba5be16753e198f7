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

// Gives access to a mesh that has a tree: the mesh itself, or a copy where its method needs no tree.
class MeshWithTree {
 public:
  explicit MeshWithTree(const HydrostaticMesh& mesh) : mesh_(&mesh) {
    if (mesh.tree) return;
    copy_ = mesh;
    copy_->tree = build_moment_tree(*copy_);
    mesh_ = &*copy_;
  }
  MeshWithTree(const MeshWithTree&) = delete;
  MeshWithTree& operator=(const MeshWithTree&) = delete;
  ~MeshWithTree() = default;

  const HydrostaticMesh& mesh() const { return *mesh_; }

 private:
  std::optional<HydrostaticMesh> copy_;
  const HydrostaticMesh* mesh_;
};

// Largest eigenvalue of a symmetric matrix, by cyclic Jacobi rotations, which converge quadratically.
// Eigen's fixed-size solver takes seconds to compile.
double max_eigenvalue(Mat6 matrix) {
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
  const std::optional<Hydrostatics> result =
      hydrostatics(mesh, pose_of(rigid, state), water, rigid.center_of_mass_B, std::nullopt);
  if (!result) return 0.0;
  const Mat3 axes_W = state.q_WB.toRotationMatrix() * rigid.principal_axes_B;
  // M^-1/2 K M^-1/2, with M^-1/2 = diag(by_mass, by_inertia): computed block by block, since products of
  // 6 x 6 matrices are expensive to compile.
  const double by_mass = 1.0 / std::sqrt(rigid.mass);
  const Mat3 by_inertia =
      axes_W * rigid.principal_inertia.cwiseSqrt().cwiseInverse().asDiagonal() * axes_W.transpose();
  const Mat6& K = result->stiffness;
  Mat6 scaled;
  scaled.topLeftCorner<3, 3>() = by_mass * by_mass * K.topLeftCorner<3, 3>();
  scaled.topRightCorner<3, 3>() = by_mass * K.topRightCorner<3, 3>() * by_inertia;
  scaled.bottomLeftCorner<3, 3>() = by_mass * by_inertia * K.bottomLeftCorner<3, 3>();
  scaled.bottomRightCorner<3, 3>() = by_inertia * K.bottomRightCorner<3, 3>() * by_inertia;
  scaled = (0.5 * (scaled + scaled.transpose())).eval();
  if (!scaled.allFinite()) return 0.0;
  return std::sqrt(std::max(max_eigenvalue(scaled), 0.0));
}

// Candidate up directions in B: along the principal axes and along the bisectors of each two and three of
// them, in both senses. The flat and the slender sides of most bodies face one of these directions.
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
  double min = std::numeric_limits<double>::infinity();   // [m]
  double max = -std::numeric_limits<double>::infinity();  // [m]
};

// Extent of the mesh along a direction, relative to the centre of mass.
Extent extent_along(const HydrostaticMesh& mesh, const RigidBody& rigid, const Vec3& up_B) {
  const double offset = up_B.dot(mesh.center_B - rigid.center_of_mass_B);
  Extent extent;
  for (const Triangle& triangle : mesh.surface.triangles) {
    for (const std::int32_t i : triangle) {
      const double height = up_B.dot(mesh.vertex(i)) + offset;
      extent.min = std::min(extent.min, height);
      extent.max = std::max(extent.max, height);
    }
  }
  return extent;
}

}  // namespace

double natural_frequency_bound(const Body& body, const RigidBody& rigid, const Water& water) {
  // K is the sum of a waterplane term, whose scaled trace is at most rho g A (1/m + l^2/I), and of a buoyancy
  // lever term, at most rho g V l / I. No waterplane is larger than the whole surface A, and V <= A l / 3.
  const HydrostaticMesh& mesh = body.prepared_mesh->mesh;
  const double lever = mesh.max_lever_arm(rigid.center_of_mass_B);
  const double levers = 4.0 / 3.0 * lever * lever / rigid.principal_inertia[0];
  return std::sqrt(water.density * water.gravity * mesh.area * (1.0 / rigid.mass + levers));
}

HighestNaturalFrequency highest_natural_frequency(const Body& body, const RigidBody& rigid,
                                                  const RigidBodyState& state, const Water& water) {
  const MeshWithTree with_tree(body.prepared_mesh->mesh);
  const HydrostaticMesh& mesh = with_tree.mesh();
  const Solver solver(mesh, Method::kHierarchical);
  const std::optional<double> energy = mechanical_energy(rigid, state, solver, water);
  if (!energy) return {};

  HighestNaturalFrequency highest;
  const auto consider = [&](const RigidBodyState& candidate, double draft) {
    const double frequency = frequency_at(mesh, rigid, candidate, water);
    if (frequency > highest.frequency) highest = {frequency, draft};
  };
  const double height = water.up_W.dot(state.center_W) - water.level;
  const auto sweep = [&](const Eigen::Quaterniond& q_WB) {
    const Extent extent = extent_along(mesh, rigid, q_WB.conjugate() * water.up_W);
    for (int i = 1; i <= kLevels; ++i) {
      // The drafts run from half a level spacing above the lowest vertex to the highest vertex.
      const double draft = (extent.max - extent.min) * (i < kLevels ? (i - 0.5) / (kLevels - 1) : 1.0);
      RigidBodyState candidate;
      candidate.q_WB = q_WB;
      candidate.center_W = water.up_W * (water.level - extent.min - draft);
      const std::optional<double> potential = mechanical_energy(rigid, candidate, solver, water);
      if (potential && *potential <= *energy) consider(candidate, draft);
    }
    return extent;
  };
  const Extent present = sweep(state.q_WB);
  consider(state, -(height + present.min));
  for (const Vec3& up_B : directions_B(rigid)) {
    sweep(rotation_between(up_B, water.up_W));
  }
  return highest;
}

}  // namespace buoyancy
