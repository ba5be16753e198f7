// Compares what the C interface computes with the table of write_comparison_table, byte for byte.
//
//   comparison TABLE
#include <buoyancy/buoyancy.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char* cursor;

// The next elements of the table.
static const void* next(size_t bytes) {
  const void* here = cursor;
  cursor += (bytes + 7) / 8 * 8;
  return here;
}

static void check(buoyancy_error error) {
  if (error == BUOYANCY_OK) return;
  printf("%s: %s\n", buoyancy_error_name(error), buoyancy_last_error());
  exit(1);
}

static void* allocate(size_t bytes) {
  void* memory = calloc(1, bytes + 1);
  if (memory == NULL) exit(1);
  return memory;
}

// A copy with a final zero byte.
static char* next_text(size_t bytes) {
  char* text = allocate(bytes);
  memcpy(text, next(bytes), bytes);
  return text;
}

static void expect_bytes(int64_t number, const char* what, const void* computed, size_t bytes) {
  if (memcmp(computed, next(bytes), bytes) == 0) return;
  printf("case %lld: the %s differ from those of C++\n", (long long)number, what);
  exit(1);
}

static buoyancy_mesh* make_mesh(const char* path, const double* vertices, int64_t vertex_count,
                                const int64_t* faces, int64_t face_count, int narrow) {
  buoyancy_mesh* mesh = NULL;
  if (path[0] != '\0') {
    check(buoyancy_mesh_load(path, NULL, &mesh));
  } else if (narrow) {
    int32_t* indices = allocate(sizeof(int32_t) * 3 * (size_t)face_count);
    for (int64_t i = 0; i < 3 * face_count; ++i) indices[i] = (int32_t)faces[i];
    check(buoyancy_mesh_create(vertices, vertex_count, indices, face_count, NULL, &mesh));
    free(indices);
  } else {
    check(buoyancy_mesh_create_64(vertices, vertex_count, faces, face_count, NULL, &mesh));
  }
  return mesh;
}

static void compare(int64_t number) {
  const int64_t* header = next(8 * sizeof(int64_t));
  const int64_t vertex_count = header[0], face_count = header[1], n = header[2], utime_count = header[3];
  const int64_t body_id = header[5];
  const double* numbers = next(7 * sizeof(double));
  char* text = next_text((size_t)header[6]);
  char* path = next_text((size_t)header[7]);
  const double* vertices = next(3 * sizeof(double) * (size_t)vertex_count);
  const int64_t* faces = next(3 * sizeof(int64_t) * (size_t)face_count);

  buoyancy_poses poses = {.size = sizeof poses, .count = n};
  poses.positions = next(3 * sizeof(double) * (size_t)n);
  poses.quaternions = next(4 * sizeof(double) * (size_t)n);
  poses.linear_velocities = next(3 * sizeof(double) * (size_t)n);
  poses.angular_velocities = next(3 * sizeof(double) * (size_t)n);
  poses.utimes = next(sizeof(int64_t) * (size_t)utime_count);
  poses.utime_count = utime_count;

  const size_t per_number = sizeof(double) * (size_t)n;
  buoyancy_wrenches wrenches = {.size = sizeof wrenches};
  wrenches.statuses = allocate(sizeof(int32_t) * (size_t)n);
  wrenches.forces = allocate(3 * per_number);
  wrenches.torques = allocate(3 * per_number);
  wrenches.volumes = allocate(per_number);
  wrenches.centers_of_buoyancy = allocate(3 * per_number);
  wrenches.force_error_bounds = allocate(per_number);
  wrenches.torque_error_bounds = allocate(per_number);

  if (body_id >= 0) {
    buoyancy_scene* scene = NULL;
    check(buoyancy_scene_from_toml(text, NULL, &scene));
    check(buoyancy_scene_query(scene, (int32_t)body_id, &poses, &wrenches, NULL, 0));
    check(buoyancy_scene_free(scene));
  } else {
    buoyancy_mesh* mesh = make_mesh(path, vertices, vertex_count, faces, face_count, number % 2 == 0);
    buoyancy_sea* sea = NULL;
    if (text[0] != '\0') check(buoyancy_sea_from_toml(text, NULL, &sea));
    const buoyancy_water water = {.size = sizeof water,
                                  .level = numbers[1],
                                  .density = numbers[2],
                                  .gravity = numbers[3],
                                  .up = {numbers[4], numbers[5], numbers[6]},
                                  .sea = sea};
    check(buoyancy_mesh_query(mesh, &water, (buoyancy_method)header[4], numbers[0], &poses, &wrenches, 0));
    check(buoyancy_sea_free(sea));
    check(buoyancy_mesh_free(mesh));
  }

  expect_bytes(number, "statuses", wrenches.statuses, sizeof(int32_t) * (size_t)n);
  expect_bytes(number, "forces", wrenches.forces, 3 * per_number);
  expect_bytes(number, "torques", wrenches.torques, 3 * per_number);
  expect_bytes(number, "volumes", wrenches.volumes, per_number);
  expect_bytes(number, "centres of buoyancy", wrenches.centers_of_buoyancy, 3 * per_number);
  expect_bytes(number, "bounds of the force", wrenches.force_error_bounds, per_number);
  expect_bytes(number, "bounds of the torque", wrenches.torque_error_bounds, per_number);
  free(wrenches.statuses);
  free(wrenches.forces);
  free(wrenches.torques);
  free(wrenches.volumes);
  free(wrenches.centers_of_buoyancy);
  free(wrenches.force_error_bounds);
  free(wrenches.torque_error_bounds);
  free(text);
  free(path);
}

int main(int argc, char** argv) {
  FILE* file = argc == 2 ? fopen(argv[1], "rb") : NULL;
  if (file == NULL) return 2;
  fseek(file, 0, SEEK_END);
  const size_t bytes = (size_t)ftell(file);
  rewind(file);
  char* table = allocate(bytes);
  if (fread(table, 1, bytes, file) != bytes) return 2;
  fclose(file);

  cursor = table;
  const int64_t cases = *(const int64_t*)next(sizeof(int64_t));
  for (int64_t number = 0; number < cases; ++number) compare(number);
  printf("%lld cases are equal to those of C++ bit for bit\n", (long long)cases);
  const int complete = cases == 11 && cursor == table + bytes;
  free(table);
  return complete ? 0 : 1;
}
