// Keys that identify equal bodies of a scene, so that their motions and attitudes are computed only once.
#pragma once

#include <map>
#include <vector>

#include "scene/body_mass.h"

namespace buoyancy {

// The numbers on which a result depends: bodies with equal keys share it.
using BodyKey = std::vector<double>;

template <typename Derived>
void append(const Eigen::MatrixBase<Derived>& matrix, BodyKey& key) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) key.push_back(matrix(i, j));
  }
}

// Appends a unit vector, rounded to 1e-12: bodies of any heading then share what depends on up alone.
void append_direction(const Vec3& direction, BodyKey& key);

// Makes the keys of the bodies of one scene, which must outlive this object.
class BodyKeys {
 public:
  explicit BodyKeys(const Scene& scene);

  // Returns the mesh, the mass, and the compartments and tanks as in the scene file.
  BodyKey floating(const Body& body, const RigidBodyMass& own) const;

 private:
  double index_of(const PreparedMesh& mesh) const;

  std::map<const PreparedMesh*, double> mesh_index_;
};

// Gives access to meshes with trees: those of the scene, or copies where their methods need no trees.
class MeshesWithTrees {
 public:
  // The reference is valid as long as this object.
  const HydrostaticMesh& of(const PreparedMesh& prepared);

 private:
  std::map<const PreparedMesh*, HydrostaticMesh> copies_;
};

}  // namespace buoyancy
