// What the bodies of a scene have in common whose motions or attitudes are computed once.
#pragma once

#include <map>
#include <vector>

#include "scene/body_mass.h"

namespace buoyancy {

// Numbers that decide a result; bodies with equal keys share it.
using BodyKey = std::vector<double>;

template <typename Derived>
void append(const Eigen::MatrixBase<Derived>& matrix, BodyKey& key) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) key.push_back(matrix(i, j));
  }
}

// Of a unit vector: equal within some 1e-12, so that bodies of any heading share what depends on up alone.
void append_direction(const Vec3& direction, BodyKey& key);

// Keys of the bodies of one scene, which outlives it.
class BodyKeys {
 public:
  explicit BodyKeys(const Scene& scene);

  // Of what floats: mesh, mass, compartments and tanks as in the scene file.
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
