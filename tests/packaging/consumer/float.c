// Computes the buoyancy of a half-submerged tetrahedron with the installed C library. Exits with 0 if the result is
// correct and a mesh without its last face is refused with the reason.
#include <buoyancy/buoyancy.h>
#include <math.h>
#include <stdio.h>

int main(void) {
  const double vertices[] = {0, 0, -1, 1, 0, 1, 0, 1, 1, -1, -1, 1};  // its tip is down, 2 m below its base
  const int32_t faces[] = {0, 2, 1, 0, 3, 2, 0, 1, 3, 1, 2, 3};
  const double position[] = {0, 0, 0}, quaternion[] = {1, 0, 0, 0};
  double force[3] = {0, 0, 0};
  int32_t status = -1;
  const buoyancy_poses poses = {
      .size = sizeof poses, .count = 1, .positions = position, .quaternions = quaternion};
  const buoyancy_wrenches wrenches = {.size = sizeof wrenches, .statuses = &status, .forces = force};
  buoyancy_mesh* mesh = NULL;
  if (buoyancy_mesh_create(vertices, 4, faces, 4, NULL, &mesh) != BUOYANCY_OK ||
      buoyancy_mesh_query(mesh, NULL, BUOYANCY_METHOD_HIERARCHICAL, 0.0, &poses, &wrenches, 1) != BUOYANCY_OK) {
    printf("%s\n", buoyancy_last_error());
    return 1;
  }
  buoyancy_mesh_free(mesh);
  const double expected = 1025.0 * 9.80665 * (1.5 * 2.0 / 3.0) / 8.0;  // half of its height is an eighth of it
  printf("C library %s: %.17g N, expected %.17g N\n", buoyancy_version(), force[2], expected);
  if (status != BUOYANCY_STATUS_OK || fabs(force[2] - expected) > 1e-12 * expected) return 1;
  if (buoyancy_mesh_create(vertices, 4, faces, 3, NULL, &mesh) != BUOYANCY_ERROR_MESH) return 1;
  printf("%s\n", buoyancy_last_error());
  return 0;
}
