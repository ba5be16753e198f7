// The C interface of buoyancy: forces and torques on floating bodies in your own process, from C and from
// every language that calls C. Link with -lbuoyancy-c. docs/libraries.md has a first program.
//
// Conventions
//   SI units: m, kg, s, N, Pa, rad. Right-handed axes. W is the world's frame, B that of a body: its mesh's.
//   A pose is the position of B's origin in W, and the unit quaternion (w, x, y, z) that turns B's axes into
//   W's. Times are in microseconds.
//   Arrays are contiguous. n poses have 3 n doubles of positions: x, y, z of the first, of the second, and so
//   on. Matrices are stored row by row. Arrays that a call writes overlap no other array of the call.
//
// Errors
//   Every function that can fail returns a buoyancy_error: BUOYANCY_OK, or a code of which
//   buoyancy_last_error() gives the reason. A call that fails sets a handle that it was to create to NULL;
//   arrays of results may have been written in part. No function ends the process or lets a C++ exception
//   out. Calls check NULL, counts, enumerators, numbers, sizes of structs, and handles, but not whether an
//   array is as long as its count says. A pose that cannot be evaluated, such as one that contains NaN, is no
//   error of the call: the call returns BUOYANCY_OK, and the pose has its status in the array of statuses,
//   and zeros.
//
// Threads
//   Handles are immutable. Any number of threads may use one at once, in any function but the one that frees
//   it. Free a handle once, when no call is using it. A handle that was freed is recognised and gives
//   BUOYANCY_ERROR_HANDLE, unless a new one has its address: using one is a mistake nevertheless.
//   Functions that take `threads` share their work among that many: 1 is the caller's own thread, 0 all of
//   the machine, at most BUOYANCY_MAX_THREADS. Little work stays on the caller's thread. Results have the
//   same bits for every number of threads.
//   A thread that calls a function needs BUOYANCY_STACK_SIZE bytes of stack. A thread that calls none needs
//   none of them: what a thread keeps between calls is on the heap.
//
// Floating point
//   Results do not depend on the caller's rounding mode, its treatment of subnormal numbers or its
//   floating-point exceptions (traps), and a call changes none of them, nor the exception flags.
//
// Compatibility
//   Functions, constants and the order of the members of structs stay as they are in all versions of
//   libbuoyancy-c.so.1. Structs may grow at their end. Therefore every struct begins with its size in bytes:
//   set it to sizeof the struct, or call the function that sets the defaults. The library accepts every size
//   that a version of the struct has had, gives members that your version lacks their defaults, and writes no
//   others.
#ifndef BUOYANCY_BUOYANCY_H
#define BUOYANCY_BUOYANCY_H

// NOLINTBEGIN: this header is C, with the names and declarations of C.

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define BUOYANCY_API __attribute__((visibility("default")))
#else
#define BUOYANCY_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define BUOYANCY_MAX_THREADS 1024
#define BUOYANCY_STACK_SIZE 131072 /* [bytes] */

// ---------- version and errors

// Returns the version of the library that runs, such as "1.0.0". The string is never freed.
BUOYANCY_API const char* buoyancy_version(void);
// Returns 10000 major + 100 minor + patch of that version.
BUOYANCY_API int32_t buoyancy_version_number(void);

typedef int32_t buoyancy_error;
enum {
  BUOYANCY_OK = 0,
  BUOYANCY_ERROR_INVALID_ARGUMENT = 1,  // NULL, a count, an enumerator, a number, a struct's size
  BUOYANCY_ERROR_HANDLE = 2,            // a handle that is NULL, of another kind, freed, or none at all
  BUOYANCY_ERROR_FILE = 3,              // a file that does not exist or cannot be read
  BUOYANCY_ERROR_MESH = 4,              // a file or arrays that contain no usable mesh
  BUOYANCY_ERROR_SCENE = 5,             // an invalid text of a scene or a sea, or a body that a scene lacks
  BUOYANCY_ERROR_MEMORY = 6,            // not enough memory
  BUOYANCY_ERROR_INTERNAL = 7           // a mistake of the library; please report it
};

// Returns why the last failed call of this thread failed: one line of UTF-8 with the value at fault,
// what was expected, and often the likely cause and what to do. Empty if no call has failed. Valid until the
// thread's next call that fails. Calls that succeed leave it as it is.
BUOYANCY_API const char* buoyancy_last_error(void);
// Returns "OK", "INVALID_ARGUMENT" and so on, "UNKNOWN_ERROR" for any other value. It is never freed.
BUOYANCY_API const char* buoyancy_error_name(buoyancy_error error);

// Why a pose has no result. The values are those of the service's messages.
enum {
  BUOYANCY_STATUS_OK = 0,
  BUOYANCY_STATUS_NON_FINITE_POSE = 2,   // NaN or infinity in a position or quaternion
  BUOYANCY_STATUS_BAD_QUATERNION = 3,    // |norm - 1| > 1e-3; closer ones are normalised
  BUOYANCY_STATUS_NON_FINITE_TWIST = 4,  // NaN or infinity in a velocity, of a body with drag or added mass
  BUOYANCY_STATUS_OPEN_EDGE_WET = 6,     // the mesh is open, and part of its boundary is not dry
  BUOYANCY_STATUS_OUT_OF_RANGE =
      7,                       // the result is beyond double's range, or the body leaves the grid of a sea
  BUOYANCY_STATUS_NO_SEA = 8,  // the scene's waves come in messages, which a query does not receive
  BUOYANCY_STATUS_BAD_CONDITION = 9,  // of the service: a message about a compartment or tank is unusable
  // In waves: the bound on the force's error is above the weight of the water that the whole body displaces.
  BUOYANCY_STATUS_NOT_CERTIFIED = 10
};
// Returns "OK", "NON_FINITE_POSE" and so on, "UNKNOWN_STATUS" for any other value. It is never freed.
BUOYANCY_API const char* buoyancy_status_name(int32_t status);

// ---------- sea

// A surface with waves, or at rest, and a current that carries the waves.
typedef struct buoyancy_sea buoyancy_sea;

// toml: the sections [world] and [water] of a scene file (docs/scene_file.md), in UTF-8. An empty text is
// water at rest. directory: where files of wave components that the text names are looked up; NULL: the
// process's current one. Errors: SCENE, also for a sea that comes in messages. Complexity: O(wave
// components).
BUOYANCY_API buoyancy_error buoyancy_sea_from_toml(const char* toml, const char* directory,
                                                   buoyancy_sea** sea);
// Frees a handle; NULL is allowed. Errors: HANDLE.
BUOYANCY_API buoyancy_error buoyancy_sea_free(buoyancy_sea* sea);

typedef struct buoyancy_sea_info {
  size_t size;              // sizeof(buoyancy_sea_info)
  double level;             // [m]: the surface at rest is where up . x = level
  double density;           // [kg/m^3]
  double gravity;           // [m/s^2]
  double up[3];             // unit, W
  double axis1[3];          // unit, horizontal, W: of x1 in buoyancy_sea_elevations()
  double axis2[3];          // likewise of x2; axis2 = up x axis1
  double depth;             // [m], infinite in deep water and in water at rest
  double max_elevation;     // [m]: no crest is higher over the level, no trough deeper
  int64_t wave_components;  // 0: the water is at rest, or its surface is given on a grid
} buoyancy_sea_info;
// Sets all members but the size. Errors: HANDLE, INVALID_ARGUMENT.
BUOYANCY_API buoyancy_error buoyancy_sea_get_info(const buoyancy_sea* sea, buoyancy_sea_info* info);

// Sets elevations[i] [m] to the height of the surface over the level at x1[i], x2[i] [m], which are measured
// along axis1 and axis2 from the world's origin. x1, x2, elevations: count numbers. utimes [us]: utime_count
// of them, 1 for all points, which is quicker by far, or count. count: 0 to 2^40. In waves a point that is
// not finite gives NaN. Errors: HANDLE, INVALID_ARGUMENT. Complexity: O(count * wave components).
BUOYANCY_API buoyancy_error buoyancy_sea_elevations(const buoyancy_sea* sea, int64_t count, const double* x1,
                                                    const double* x2, const int64_t* utimes,
                                                    int64_t utime_count, double* elevations, int32_t threads);
// Evaluates the water at positions [m], W, 3 count. Sets those arrays that are not NULL: gauge pressures
// [Pa], of the waves and of the water at rest together, 0 above the surface, count; velocities [m/s], of
// current and waves, and accelerations [m/s^2], W, 3 count, above the surface those of the surface below.
// Accelerations are those that an observer sees who drifts with the current. Everything else is as in
// buoyancy_sea_elevations().
BUOYANCY_API buoyancy_error buoyancy_sea_water_at(const buoyancy_sea* sea, int64_t count,
                                                  const double* positions, const int64_t* utimes,
                                                  int64_t utime_count, double* pressures, double* velocities,
                                                  double* accelerations, int32_t threads);

// The water of a query of a mesh.
typedef struct buoyancy_water {
  size_t size;              // sizeof(buoyancy_water)
  double level;             // [m], finite; default 0
  double density;           // [kg/m^3], 0 or more; default 1025
  double gravity;           // [m/s^2], 0 or more; default 9.80665
  double up[3];             // a direction in W, of any length above 0; default (0, 0, 1)
  const buoyancy_sea* sea;  // NULL: the surface is at rest. A sea has a level, a density and so on of its
                            // own, which apply: the members above are then the defaults or equal to the sea's
} buoyancy_water;
// Sets all members to their defaults. size: sizeof(buoyancy_water). Errors: INVALID_ARGUMENT.
BUOYANCY_API buoyancy_error buoyancy_default_water(buoyancy_water* water, size_t size);

// Samples of a surface.
typedef struct buoyancy_grid {
  size_t size;               // sizeof(buoyancy_grid)
  const double* elevations;  // [m], over the level, -1000 to 1000, row after row: rows * columns
  int64_t rows;              // along axis2 of buoyancy_sea_info, 4 to 4096
  int64_t columns;           // along axis1, 4 to 4096
  double origin[2];          // [m], of elevations[0], along axis1 and axis2 from the world's origin
  double spacing[2];         // [m], 0.001 to 10000, between neighbours along axis1 and along axis2
  int32_t periodic;          // 1: the surface repeats after columns * spacing[0] and rows * spacing[1]; 0: it
                             // ends at the outermost samples, and elevations beyond are NaN
} buoyancy_grid;
// Makes a sea whose surface is the bicubic spline through samples, which are copied, at rest at all times.
// Its pressure is hydrostatic. water: level, density, gravity and up; NULL: their defaults; its sea is NULL.
// Errors: HANDLE, INVALID_ARGUMENT, SCENE for a number out of range. Complexity: 20 ns per sample.
BUOYANCY_API buoyancy_error buoyancy_sea_from_grid(const buoyancy_grid* grid, const buoyancy_water* water,
                                                   buoyancy_sea** sea);

// ---------- arrays of poses

typedef struct buoyancy_poses {
  size_t size;                      // sizeof(buoyancy_poses)
  int64_t count;                    // n, 0 to 2^40
  const double* positions;          // [m], W, of B's origin; 3 n
  const double* quaternions;        // w, x, y, z; 4 n
  const double* linear_velocities;  // [m/s], W, of B's origin; 3 n, or NULL: at rest. For drag and added mass
  const double* angular_velocities;  // [rad/s], W; 3 n, or NULL: at rest. For drag and added mass
  const int64_t* utimes;             // [us]; NULL if utime_count is 0. For waves
  int64_t utime_count;               // n, or 1: the time of all poses, or 0: their time is 0
} buoyancy_poses;

// The results, one per pose. Set to NULL what you do not want.
typedef struct buoyancy_wrenches {
  size_t size;                  // sizeof(buoyancy_wrenches)
  int32_t* statuses;            // BUOYANCY_STATUS_...; n. A pose whose status is not OK has zeros
  double* forces;               // [N], W; 3 n
  double* torques;              // [N m], W, about B's origin, or about a scene's reference point; 3 n
  double* volumes;              // [m^3], under water; n
  double* centers_of_buoyancy;  // [m], W's axes, from the position; 3 n. Zeros if there is hardly any volume
  double* force_error_bounds;   // [N], of the norm of the error; n
  double* torque_error_bounds;  // [N m], likewise; n
} buoyancy_wrenches;

// Hydrostatics, one per pose. Undefined values are NaN, such as a waterplane's centroid where there is no
// waterplane. The first of a pair belongs to the smaller second moment of the waterplane. Set to NULL what
// you do not want.
typedef struct buoyancy_hydrostatics {
  size_t size;                        // sizeof(buoyancy_hydrostatics)
  int32_t* statuses;                  // n
  double* volumes;                    // [m^3], under water; n
  double* centers_of_buoyancy;        // [m], W's axes, from the position; 3 n
  double* wetted_areas;               // [m^2]; n
  double* waterplane_areas;           // [m^2]; n
  double* waterplane_centroids;       // [m], W's axes, from the position; 3 n
  double* waterplane_second_moments;  // [m^4], about the axes below through the centroid; 2 n
  double* waterplane_axes;            // unit, horizontal, W, the first, then the second = up x first; 6 n
  double* metacentric_radii;          // BM [m], for heel about these axes; 2 n
  double* metacenters;                // [m], W's axes, from the position; 6 n
  double* metacentric_heights;        // GM [m], NaN where the centre of mass is unknown; 2 n
  double* stiffnesses;  // -d(force, torque)/d(position, rotation), 6 by 6, of buoyancy alone: rows
                        // [N, N m], columns [m, rad], W's axes; 36 n
} buoyancy_hydrostatics;

// ---------- mesh

typedef int32_t buoyancy_method;
enum {
  BUOYANCY_METHOD_HIERARCHICAL = 0,  // exact to rounding, or within a tolerance: use this one
  BUOYANCY_METHOD_FAST = 1,          // the five methods of the paper; FAST, IMPROVED, EXACT: not in waves
  BUOYANCY_METHOD_IMPROVED = 2,
  BUOYANCY_METHOD_EXACT = 3,
  BUOYANCY_METHOD_FAST_SURFACE = 4,
  BUOYANCY_METHOD_EXACT_SURFACE = 5
};

enum {
  BUOYANCY_OPEN_REFUSE = 0,       // an open mesh is an error
  BUOYANCY_OPEN_DRY_BOUNDARY = 1  // it is accepted, and evaluated where its whole boundary is dry
};

typedef struct buoyancy_mesh_options {
  size_t size;                       // sizeof(buoyancy_mesh_options)
  double scale;                      // factor of the coordinates, above 0; default 1
  int32_t open;                      // BUOYANCY_OPEN_...; default BUOYANCY_OPEN_REFUSE
  int32_t count_intersecting_pairs;  // 0 or 1, for the report: several times the time of the rest; default 0
} buoyancy_mesh_options;
// Sets all members to their defaults. size: sizeof(buoyancy_mesh_options). Errors: INVALID_ARGUMENT.
BUOYANCY_API buoyancy_error buoyancy_default_mesh_options(buoyancy_mesh_options* options, size_t size);

// A mesh that is validated and prepared for queries.
typedef struct buoyancy_mesh buoyancy_mesh;

// Reads a file: OBJ, STL, PLY, OFF, DAE, glTF, GLB, FBX, 3DS, WAMIT .gdf or Nemoh .dat. Coordinates are those
// of the file, whichever of its axes is up. options: NULL for the defaults. Starts a process that imports it,
// so that a damaged file cannot damage yours. Errors: FILE, MESH, INVALID_ARGUMENT.
// Complexity: O(m log m) for m triangles.
BUOYANCY_API buoyancy_error buoyancy_mesh_load(const char* path, const buoyancy_mesh_options* options,
                                               buoyancy_mesh** mesh);
// Copies a mesh from arrays. vertices [m], B: 3 vertex_count numbers. faces: 3 face_count vertex numbers that
// begin at 0, counter-clockwise seen from outside. Both counts: 0 to 2^31 - 1. options: NULL for the
// defaults. Errors: MESH for an index out of range, a vertex that is not finite, an open mesh and so on;
// INVALID_ARGUMENT. Complexity: O(n log n).
BUOYANCY_API buoyancy_error buoyancy_mesh_create(const double* vertices, int64_t vertex_count,
                                                 const int32_t* faces, int64_t face_count,
                                                 const buoyancy_mesh_options* options, buoyancy_mesh** mesh);
// Does the same with vertex numbers of 64 bits.
BUOYANCY_API buoyancy_error buoyancy_mesh_create_64(const double* vertices, int64_t vertex_count,
                                                    const int64_t* faces, int64_t face_count,
                                                    const buoyancy_mesh_options* options,
                                                    buoyancy_mesh** mesh);
// Frees a handle; NULL is allowed. Errors: HANDLE.
BUOYANCY_API buoyancy_error buoyancy_mesh_free(buoyancy_mesh* mesh);

// What validation found.
typedef struct buoyancy_mesh_info {
  size_t size;                 // sizeof(buoyancy_mesh_info)
  int64_t triangles;           // that are used
  int64_t vertices_stored;     // as given
  int64_t vertices_welded;     // after equal ones were joined
  double box_min[3];           // [m], B
  double box_max[3];           // [m], B
  double diagonal;             // [m], of that box
  double area;                 // [m^2]
  double volume;               // [m^3]; meaningless for an open mesh
  double centroid[3];          // [m], B, of the volume
  double inertia[9];           // [m^5], about the centroid, B's axes: kg m^2 at a density of 1 kg/m^3
  int64_t boundary_edges;      // of one face
  int64_t non_manifold_edges;  // of three or more, not equally often in both directions
  int64_t misoriented_edges;   // of two faces that run along it in the same direction
  int64_t degenerate_faces;    // of zero area
  int64_t dropped_faces;       // that used a vertex twice
  int64_t duplicate_faces;     // with the vertices of another
  int64_t intersecting_pairs;  // of faces, at least; -1: not counted
  int64_t components;          // parts that share no edge
  int64_t holes;               // loops of boundary edges
  int32_t closed;              // 1: every edge has two faces
  int32_t flipped;             // 1: the mesh was inside out and has been turned
} buoyancy_mesh_info;
// Sets all members but the size. Errors: HANDLE, INVALID_ARGUMENT.
BUOYANCY_API buoyancy_error buoyancy_mesh_get_info(const buoyancy_mesh* mesh, buoyancy_mesh_info* info);
// Writes the report of validation as lines of UTF-8, cut to capacity bytes that include a final zero byte,
// and sets length to the number of bytes of all of it without the zero, also if text is NULL and capacity 0.
// length may be NULL. Errors: HANDLE, INVALID_ARGUMENT.
BUOYANCY_API buoyancy_error buoyancy_mesh_report(const buoyancy_mesh* mesh, char* text, size_t capacity,
                                                 size_t* length);

// Evaluates the mesh at n poses. water: NULL for the defaults. tolerance: 0 to 1, of the weight of the whole
// displacement; used by HIERARCHICAL alone, 0 is exact, and in waves stands for 0.001. Results have the bits
// of the service's responses to the same poses. The first query with a method, and the first in waves,
// prepares the mesh for it, in O(m log m) for m triangles. Errors: HANDLE, INVALID_ARGUMENT. Complexity: per
// pose O(triangles that the water cuts + log m) by HIERARCHICAL, O(m) by the others; with a tolerance less.
BUOYANCY_API buoyancy_error buoyancy_mesh_query(const buoyancy_mesh* mesh, const buoyancy_water* water,
                                                buoyancy_method method, double tolerance,
                                                const buoyancy_poses* poses,
                                                const buoyancy_wrenches* wrenches, int32_t threads);
// Evaluates hydrostatics at n poses in water at rest, without a sea with waves. center_of_mass [m], B: 3
// numbers, for GM; NULL: unknown. Errors and complexity: those of HIERARCHICAL.
BUOYANCY_API buoyancy_error buoyancy_mesh_hydrostatics(const buoyancy_mesh* mesh, const buoyancy_water* water,
                                                       const double* center_of_mass,
                                                       const buoyancy_poses* poses,
                                                       const buoyancy_hydrostatics* hydrostatics,
                                                       int32_t threads);

// ---------- scene

// The water, the waves and the bodies of a scene file (docs/scene_file.md).
typedef struct buoyancy_scene buoyancy_scene;

// Loads a scene file. Errors: FILE for the file itself; SCENE for everything in it, meshes included. See
// buoyancy_mesh_load() for the import of meshes.
BUOYANCY_API buoyancy_error buoyancy_scene_load(const char* path, buoyancy_scene** scene);
// toml: the text of a scene file, in UTF-8. directory: where files that it names are looked up; NULL: the
// process's current one. Errors: SCENE.
BUOYANCY_API buoyancy_error buoyancy_scene_from_toml(const char* toml, const char* directory,
                                                     buoyancy_scene** scene);
// Frees a handle; NULL is allowed. Errors: HANDLE.
BUOYANCY_API buoyancy_error buoyancy_scene_free(buoyancy_scene* scene);
// Makes a handle of the scene's sea, to be freed like any other. Errors: SCENE where waves are received.
BUOYANCY_API buoyancy_error buoyancy_scene_sea(const buoyancy_scene* scene, buoyancy_sea** sea);

typedef struct buoyancy_body_info {
  size_t size;       // sizeof(buoyancy_body_info)
  const char* name;  // UTF-8; valid as long as the scene
  int32_t id;
  buoyancy_method method;
  double tolerance;
  double reference_point[3];  // [m], B: the torque is about it
  double center_of_mass[3];   // [m], B; NaN: unknown
  double volume;              // [m^3], of the whole mesh
  int64_t triangles;
  int32_t has_loads;         // 1: drag or added mass, so that velocities matter
  int32_t has_hydrostatics;  // 1: buoyancy_scene_hydrostatics() works for it
} buoyancy_body_info;
// Sets the number of bodies. Errors: HANDLE, INVALID_ARGUMENT.
BUOYANCY_API buoyancy_error buoyancy_scene_body_count(const buoyancy_scene* scene, int64_t* count);
// Sets all members but the size. index: 0 to the number of bodies - 1, in the order of the file. Errors:
// HANDLE, INVALID_ARGUMENT.
BUOYANCY_API buoyancy_error buoyancy_scene_get_body(const buoyancy_scene* scene, int64_t index,
                                                    buoyancy_body_info* info);

// The parts of the wrench of a body, and matrices that a simulator adds to its own: docs/loads.md. Torques
// are about the reference point. Set to NULL what you do not want.
typedef struct buoyancy_loads {
  size_t size;                 // sizeof(buoyancy_loads)
  double* immersions;          // 0 (dry) to 1 (fully submerged); n
  double* buoyancy_forces;     // [N], W; 3 n
  double* buoyancy_torques;    // [N m], W; 3 n
  double* drag_forces;         // [N], W; 3 n
  double* drag_torques;        // [N m], W; 3 n
  double* added_mass_forces;   // [N], W, without the part that the matrix below gives; 3 n
  double* added_mass_torques;  // [N m], W; 3 n
  double* added_masses;        // 6 by 6 [kg, kg m, kg m^2], W's axes; 36 n
  double* dampings;            // -d(force, torque)/d(velocity), 6 by 6: rows [N, N m], columns
                               // [m/s, rad/s], W's axes; 36 n
  double* water_velocities;    // [m/s], W; 3 n
} buoyancy_loads;

// Evaluates a body at n poses in the scene's water, by its method, with its drag and added mass. loads: NULL
// if you want none. Errors: HANDLE; SCENE if there is no body of this id; INVALID_ARGUMENT. Complexity: see
// buoyancy_mesh_query().
BUOYANCY_API buoyancy_error buoyancy_scene_query(const buoyancy_scene* scene, int32_t body_id,
                                                 const buoyancy_poses* poses,
                                                 const buoyancy_wrenches* wrenches,
                                                 const buoyancy_loads* loads, int32_t threads);
// Evaluates hydrostatics of a body at n poses. Errors: those of buoyancy_scene_query(); SCENE for a scene
// with waves, and for a body of another method than HIERARCHICAL whose outputs do not list "hydrostatics".
BUOYANCY_API buoyancy_error buoyancy_scene_hydrostatics(const buoyancy_scene* scene, int32_t body_id,
                                                        const buoyancy_poses* poses,
                                                        const buoyancy_hydrostatics* hydrostatics,
                                                        int32_t threads);

#ifdef __cplusplus
}
#endif

// NOLINTEND
#endif
