// A mesh that is prepared in the caller's process, for queries at any pose by any method.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/prepared_mesh.h"
#include "scene/scene.h"

namespace buoyancy {

struct QueryMeshOptions {
  // Places the coordinates in frame B; see orientation_with_up() for files whose up axis is another one.
  // Numbers that are not finite, a factor of 0 and a quaternion of norm 0 are errors.
  MeshPlacement placement{};
  MeshRepair repair{};  // a freeboard raises rims along z, after the placement
  OpenPolicy open = OpenPolicy::kRefuse;
  bool count_intersecting_pairs = false;  // for the report; takes several times as long as the rest
  ImportLimits limits{};                  // of a file
};

// Several threads may call its members at once.
class QueryMesh {
 public:
  // Reads a mesh file. Errors: those of import_mesh() and prepare_mesh(), a placement out of range. refused:
  // see prepare_mesh().
  static Expected<std::shared_ptr<const QueryMesh>> load(const std::filesystem::path& path,
                                                         const QueryMeshOptions& options = {},
                                                         MeshReport* refused = nullptr);
  // vertices: [m], B frame, 3 per vertex. faces: 3 vertex indices per triangle, counter-clockwise seen from
  // outside. name: identifies the mesh in errors. Errors: no face; sizes that are no multiples of 3; an index
  // out of range; those of prepare_mesh(), such as an open mesh or a vertex that is not finite; a
  // placement out of range.
  static Expected<std::shared_ptr<const QueryMesh>> make(std::span<const double> vertices,
                                                         std::span<const std::int64_t> faces,
                                                         const std::string& name,
                                                         const QueryMeshOptions& options = {},
                                                         MeshReport* refused = nullptr);

  QueryMesh(const QueryMesh&) = delete;
  QueryMesh& operator=(const QueryMesh&) = delete;

  const MeshReport& report() const { return prepared_.report; }
  const HydrostaticMesh& mesh() const { return prepared_.mesh; }
  const MassProperties& mass_properties() const { return prepared_.mass_properties; }

  // The mesh as a body with this method and tolerance, id 0 and the mesh's origin as its reference point.
  // It refers to the mesh, which must outlive it. tolerance: 0 to 1; in waves 0 stands for
  // kDefaultWaveTolerance. Errors: a tolerance out of range; in waves those of method_error_in_waves() and
  // size_error_in_waves(). The first call for a method, and the first in waves, prepares what it needs, in
  // O(n log n) for n triangles; later calls with the same arguments take 30 ns.
  Expected<std::shared_ptr<const Body>> body(Method method, double tolerance, bool in_waves) const;

 private:
  explicit QueryMesh(PreparedMesh prepared);
  Expected<void> prepare_for_waves() const;  // mutex_ is locked

  // wave_mesh and meshlets are set by body() under the mutex, before anything refers to them.
  mutable PreparedMesh prepared_;
  mutable std::mutex mutex_;
  mutable std::vector<std::shared_ptr<const Body>> bodies_;  // the most recently requested ones
};

}  // namespace buoyancy
