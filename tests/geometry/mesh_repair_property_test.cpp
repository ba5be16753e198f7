// Closed meshes damaged in known ways: repair restores volume and centroid, or the mesh is refused.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "geometry/mass_properties.h"
#include "geometry/mesh_validation.h"
#include "tests/geometry/damaged_mesh.h"

namespace buoyancy {
namespace {

// BUOYANCY_REPAIR_CASES=10000 runs more cases than the suite does.
std::uint64_t number_of_cases() {
  const char* const text = std::getenv("BUOYANCY_REPAIR_CASES");  // NOLINT(concurrency-mt-unsafe)
  return text == nullptr ? 400 : std::strtoull(text, nullptr, 10);
}

TEST(MeshRepairProperty, RestoresDamagedMeshesOrRefusesThem) {
  std::uint64_t accepted = 0;
  std::uint64_t refused = 0;
  const std::uint64_t cases = number_of_cases();
  for (std::uint64_t seed = 0; seed < cases; ++seed) {
    const DamagedMesh damaged = make_damaged_mesh(seed);
    const MassProperties truth = mass_properties(damaged.clean);
    const MeshValidation validation = validate_mesh({damaged.damaged, {}}, "damaged");
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + damaged.damage + "\n" + to_text(validation.report));
    if (!validation.mesh) {
      ++refused;
      // Nothing but a hole above the limit may make it unusable.
      EXPECT_GT(damaged.missing_bulge, 0.9e-5 * truth.volume) << validation.refusal->message();
      continue;
    }
    ++accepted;
    EXPECT_LE(damaged.missing_bulge, 1.1e-5 * truth.volume);
    const double size = validation.report.diagonal;
    const MassProperties properties = mass_properties(validation.mesh->mesh);
    const double volume_error = std::abs(properties.volume - truth.volume);
    const double centroid_error = (properties.centroid_B - truth.centroid_B).norm();
    // A centroid moves by at most the moment of that volume, all of it L away.
    const double volume_tolerance = 1e-12 * truth.volume + 3.0 * validation.report.repair.volume_bound;
    EXPECT_LE(volume_error, volume_tolerance);
    EXPECT_LE(centroid_error, 1e-12 * size + 2.0 * size * volume_tolerance / truth.volume);
    // Holes narrower than the tolerance are closed by moving their vertices.
    if (!damaged.moved && damaged.missing_bulge == 0.0) {
      EXPECT_LE(validation.report.repair.volume_bound, 1e-12 * truth.volume);
    }
    // The result needs no further repair.
    const MeshValidation again = validate_mesh({validation.mesh->mesh, {}}, "repaired");
    ASSERT_TRUE(again.mesh);
    EXPECT_TRUE(again.report.repair.steps.empty()) << to_text(again.report);
    EXPECT_EQ(again.mesh->mesh.triangles, validation.mesh->mesh.triangles);
  }
  RecordProperty("accepted", static_cast<int>(accepted));
  RecordProperty("refused", static_cast<int>(refused));
  EXPECT_GT(accepted, 8 * refused);
  EXPECT_GT(refused, cases / 200);
}

}  // namespace
}  // namespace buoyancy
