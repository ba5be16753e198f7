// Calls the C interface with 10,000 random arguments, most of them malformed: every call returns a code with
// a reason, and none crashes.
#include <buoyancy/buoyancy.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { kMaxPoses = 16, kCalls = 10000 };

static uint64_t state = 0x9e3779b97f4a7c15u;
static int failures, successes;

static uint64_t draw(void) {
  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return state;
}

static int one_in(unsigned n) {
  return draw() % n == 0;
}

// Mostly about 1, else any bits: huge, tiny, infinite, NaN.
static double number(void) {
  if (one_in(12)) {
    const uint64_t bits = draw();
    double any;
    memcpy(&any, &bits, sizeof any);
    return any;
  }
  return (double)(draw() % 2001) * 1e-3 - 1.0;
}

// Mostly what the caller means, else a number that no array is as long as.
static int64_t count(int64_t meant) {
  const int64_t wrong[] = {
      -1, INT64_MIN, INT64_MAX, INT64_MAX / 3, (int64_t)1 << 62, -(int64_t)(draw() >> 1) - 1};
  return one_in(10) ? wrong[draw() % 6] : meant;
}

static int32_t enumerator(int32_t constants) {
  return one_in(10) ? (int32_t)draw() : (int32_t)(draw() % (uint64_t)constants);
}

static double numbers[36 * kMaxPoses];
static double results[12][36 * kMaxPoses];
static int32_t statuses[kMaxPoses];
static int64_t utimes[kMaxPoses];

static double* out(int n) {
  return one_in(8) ? NULL : one_in(40) ? (double*)(void*)((char*)results[n] + 4) : results[n];
}
static size_t size_of(size_t size) {
  return one_in(20) ? (size_t)(draw() % 300) : size;
}

static void judge(const char* function, buoyancy_error error) {
  if (error == BUOYANCY_OK) {
    ++successes;
    return;
  }
  ++failures;
  if (error > BUOYANCY_OK && error < BUOYANCY_ERROR_INTERNAL && strlen(buoyancy_last_error()) > 20) return;
  printf("%s returned %d: %s\n", function, (int)error, buoyancy_last_error());
  exit(1);
}

static buoyancy_poses random_poses(void) {
  for (int i = 0; i < 36 * kMaxPoses; ++i) numbers[i] = number();
  for (int i = 0; i < kMaxPoses; ++i) utimes[i] = one_in(4) ? (int64_t)draw() : 1790000000000000;
  if (!one_in(3)) {  // unit quaternions
    for (int i = 0; i < kMaxPoses; ++i) {
      const double unit[4] = {0.6, 0.0, 0.8, 0.0};
      memcpy(numbers + 4 * i, unit, sizeof unit);
    }
  }
  buoyancy_poses poses = {.size = size_of(sizeof poses), .count = count((int64_t)(draw() % (kMaxPoses + 1)))};
  poses.positions = one_in(20) ? NULL : numbers + 4 * kMaxPoses;
  poses.quaternions = one_in(20) ? NULL : numbers;
  poses.linear_velocities = one_in(3) ? NULL : numbers + 8 * kMaxPoses;
  poses.angular_velocities = one_in(3) ? NULL : numbers + 12 * kMaxPoses;
  poses.utimes = one_in(10) ? NULL : utimes;
  poses.utime_count = count(one_in(3) ? 1 : one_in(2) ? 0 : poses.count);
  return poses;
}

static buoyancy_wrenches random_wrenches(void) {
  const buoyancy_wrenches wrenches = {
      size_of(sizeof wrenches), one_in(8) ? NULL : statuses, out(0), out(1), out(2), out(3), out(4), out(5)};
  return wrenches;
}

static buoyancy_hydrostatics random_hydrostatics(void) {
  const buoyancy_hydrostatics hydrostatics = {size_of(sizeof hydrostatics),
                                              statuses,
                                              out(0),
                                              out(1),
                                              out(2),
                                              out(3),
                                              out(4),
                                              out(5),
                                              out(6),
                                              out(7),
                                              out(8),
                                              out(9),
                                              out(10)};
  return hydrostatics;
}

static buoyancy_water random_water(const buoyancy_sea* sea) {
  buoyancy_water water;
  buoyancy_default_water(&water, sizeof water);
  if (one_in(3)) water.level = number();
  if (one_in(3)) water.density = number();
  if (one_in(3)) water.gravity = number();
  if (one_in(3)) water.up[draw() % 3] = number();
  water.size = size_of(sizeof water);
  water.sea = sea;
  return water;
}

// A handle of its kind, or of another, or none.
static void* any_handle(void* right, void* wrong) {
  if (!one_in(12)) return right;
  return one_in(3) ? NULL : one_in(2) ? wrong : (void*)(uintptr_t)draw();
}

static void create_random_mesh(void) {
  double vertices[3 * 8];
  int32_t faces[3 * 12];
  int64_t wide[3 * 12];
  const int cube[3 * 12] = {0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
                            2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};
  for (int i = 0; i < 24; ++i) vertices[i] = (i / 3 >> (2 - i % 3) & 1) + (one_in(30) ? number() : 0.0);
  for (int i = 0; i < 36; ++i) {
    wide[i] = one_in(200) ? (int64_t)draw() : cube[i];
    faces[i] = one_in(200) ? (int32_t)draw() : cube[i];
  }
  buoyancy_mesh_options options;
  buoyancy_default_mesh_options(&options, sizeof options);
  options.size = size_of(sizeof options);
  options.scale = one_in(3) ? number() : 1.0;
  options.open = enumerator(2);
  options.count_intersecting_pairs = enumerator(2);
  const buoyancy_mesh_options* given = one_in(3) ? NULL : &options;
  const int64_t n = count(8), m = count(one_in(4) ? (int64_t)(draw() % 13) : 12);
  const double* at = one_in(30) ? NULL : vertices;
  buoyancy_mesh* mesh = NULL;
  buoyancy_mesh** place = one_in(50) ? NULL : &mesh;
  const int narrow = one_in(2);
  const buoyancy_error error =
      narrow ? buoyancy_mesh_create(at, n, one_in(30) ? NULL : faces, m, given, place)
             : buoyancy_mesh_create_64(at, n, one_in(30) ? NULL : wide, m, given, place);
  judge("buoyancy_mesh_create", error);
  if ((error == BUOYANCY_OK) != (mesh != NULL)) exit(1);
  if (mesh == NULL) return;
  const buoyancy_poses poses = random_poses();
  const buoyancy_wrenches wrenches = random_wrenches();
  judge("buoyancy_mesh_query", buoyancy_mesh_query(mesh, NULL, enumerator(6), 0.0, &poses, &wrenches, 1));
  judge("buoyancy_mesh_free", buoyancy_mesh_free(mesh));
  judge("buoyancy_mesh_free", buoyancy_mesh_free(mesh));
}

static void parse_random_text(void) {
  char text[] =
      "[world]\nup = [0, 0, 1]\n[water]\nlevel = 0.25\nwaves = { type = \"regular\", height = 0.3, period = "
      "3 }\n";
  for (int i = 0; i < 3; ++i) {
    if (one_in(2)) text[draw() % (sizeof text - 1)] = (char)draw();
  }
  buoyancy_sea* sea = NULL;
  buoyancy_scene* scene = NULL;
  judge("buoyancy_sea_from_toml", buoyancy_sea_from_toml(text, one_in(3) ? "." : NULL, &sea));
  judge("buoyancy_scene_from_toml", buoyancy_scene_from_toml(text, NULL, &scene));
  buoyancy_sea_free(sea);
  buoyancy_scene_free(scene);
}

int main(void) {
  buoyancy_sea* sea = NULL;
  buoyancy_scene* scene = NULL;
  buoyancy_mesh* mesh = NULL;
  const double tetrahedron[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const int32_t faces[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  if (buoyancy_sea_from_toml("[water]\nwaves = { type = \"regular\", height = 0.3, period = 3 }", NULL,
                             &sea) != 0 ||
      buoyancy_scene_from_toml(
          "[[body]]\nid = 1\nshape = { type = \"box\" }\n[body.drag]\nlinear = [1, 1, 1, 1, 1, 1]", NULL,
          &scene) != 0 ||
      buoyancy_mesh_create(tetrahedron, 4, faces, 4, NULL, &mesh) != 0) {
    printf("%s\n", buoyancy_last_error());
    return 1;
  }

  for (int call = 0; call < kCalls; ++call) {
    const buoyancy_poses poses = random_poses();
    const buoyancy_wrenches wrenches = random_wrenches();
    const buoyancy_hydrostatics hydrostatics = random_hydrostatics();
    const buoyancy_sea* waves = one_in(3) ? (buoyancy_sea*)any_handle(sea, mesh) : NULL;
    const buoyancy_water water = random_water(waves);
    const buoyancy_poses* at = one_in(30) ? NULL : &poses;
    const int32_t threads = one_in(10) ? (int32_t)draw() : (int32_t)(draw() % 3);
    const int64_t n = count((int64_t)(draw() % kMaxPoses));
    switch (draw() % 10) {
      case 9: {
        const buoyancy_grid grid = {size_of(sizeof grid), one_in(20) ? NULL : numbers, count(4),     count(5),
                                    {number(), number()}, {number(), number()},        enumerator(2)};
        buoyancy_sea* of_grid = NULL;
        judge("buoyancy_sea_from_grid",
              buoyancy_sea_from_grid(one_in(30) ? NULL : &grid, one_in(2) ? NULL : &water, &of_grid));
        buoyancy_sea_free(of_grid);
        break;
      }
      case 0:
        judge("buoyancy_mesh_query",
              buoyancy_mesh_query(any_handle(mesh, scene), one_in(3) ? NULL : &water, enumerator(6),
                                  one_in(3) ? number() : 0.0, at, one_in(30) ? NULL : &wrenches, threads));
        break;
      case 1:
        judge("buoyancy_mesh_hydrostatics",
              buoyancy_mesh_hydrostatics(any_handle(mesh, sea), &water, one_in(2) ? NULL : numbers, at,
                                         &hydrostatics, threads));
        break;
      case 2: {
        const buoyancy_loads loads = {size_of(sizeof loads),
                                      out(2),
                                      out(3),
                                      out(4),
                                      out(5),
                                      out(6),
                                      out(7),
                                      out(8),
                                      out(9),
                                      out(10),
                                      out(11)};
        judge("buoyancy_scene_query", buoyancy_scene_query(any_handle(scene, sea), enumerator(2), at,
                                                           &wrenches, one_in(3) ? NULL : &loads, threads));
        break;
      }
      case 3:
        judge(
            "buoyancy_scene_hydrostatics",
            buoyancy_scene_hydrostatics(any_handle(scene, mesh), enumerator(2), at, &hydrostatics, threads));
        break;
      case 4:
        judge("buoyancy_sea_elevations",
              buoyancy_sea_elevations(any_handle(sea, mesh), n, one_in(20) ? NULL : numbers, numbers, utimes,
                                      one_in(2) ? 1 : count(n), out(0), threads));
        break;
      case 5:
        judge("buoyancy_sea_water_at",
              buoyancy_sea_water_at(any_handle(sea, mesh), n, one_in(20) ? NULL : numbers, utimes,
                                    one_in(2) ? 1 : count(n), out(0), out(1), out(2), threads));
        break;
      case 6:
        parse_random_text();
        break;
      case 7: {
        buoyancy_mesh_info mesh_info = {.size = size_of(sizeof mesh_info)};
        buoyancy_body_info body = {.size = size_of(sizeof body)};
        buoyancy_sea_info sea_info = {.size = size_of(sizeof sea_info)};
        judge("buoyancy_mesh_get_info", buoyancy_mesh_get_info(any_handle(mesh, sea), &mesh_info));
        judge("buoyancy_scene_get_body", buoyancy_scene_get_body(any_handle(scene, sea), count(0), &body));
        judge("buoyancy_sea_get_info", buoyancy_sea_get_info(any_handle(sea, mesh), &sea_info));
        break;
      }
      default:
        create_random_mesh();
    }
  }
  buoyancy_mesh_free(mesh);
  buoyancy_scene_free(scene);
  buoyancy_sea_free(sea);
  printf("%d calls succeeded, %d returned an error with its reason\n", successes, failures);
  return successes > kCalls / 5 && failures > kCalls / 5 ? 0 : 1;
}
