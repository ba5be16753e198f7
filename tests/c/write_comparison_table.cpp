// Writes what C++ computes for 1,000 poses of each of five meshes, in water at rest and in waves, and of a
// body of a scene with drag. The comparisons in C, Python and C# read the table and compare byte for byte.
//
//   write_comparison_table DIRECTORY
//
// DIRECTORY/table.bin: the number of cases, and one case after the other, in numbers of 64 bits and arrays
// that are filled up to 64 bits:
//   header    vertices, faces, poses, utimes, method, body_id (-1: a mesh), bytes of text, bytes of path
//   numbers   tolerance, level, density, gravity, up (3)
//   text      a scene where body_id is not -1, else a sea; none: water at rest with the numbers above
//   path      of a mesh file; none: the mesh is made of the arrays
//   arrays    vertices (3 each), faces (3 each, int64), positions, quaternions, linear and angular
//   velocities,
//             utimes, statuses (int32), forces, torques, volumes, centres, bounds of force and torque
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "c/buoyancy.h"
#include "geometry/mesh_export.h"
#include "geometry/shapes.h"
#include "query/pose_evaluation.h"
#include "query/query_mesh.h"
#include "query/query_sea.h"
#include "tests/query/pose_table.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

constexpr std::size_t kPoses = 1000;
constexpr std::int64_t kNow = 1'790'000'000'000'000;  // [us], of 2026
constexpr const char* kWaves =
    "[world]\nup = [0.1, -0.2, 1]\n[water]\nlevel = 0.2\ndensity = 1010\ndepth = 20\n"
    "waves = { type = \"jonswap\", significant_wave_height = 0.4, peak_period = 3.0, seed = 3 }\n";
constexpr const char* kShapes[] = {
    R"({ type = "box", size = [2, 1, 0.5], segments = [4, 3, 2] })",
    R"({ type = "sphere", radius = 0.7, segments = 12 })",
    R"({ type = "torus_knot", radius = 1.0, tube = 0.2, tubular = 64 })",
    R"({ type = "wigley", length = 3.0, beam = 0.6, draft = 0.4, segments = 16, levels = 8 })",
    R"({ type = "rock", frequency = 6, radius = 1.0, seed = 5 })"};

struct Case {
  std::int64_t method = BUOYANCY_METHOD_HIERARCHICAL, body_id = -1;
  double tolerance = 0.0;
  Water water;  // up is not normalised yet in the table
  std::string text, path;
  std::vector<double> vertices;
  std::vector<std::int64_t> faces;
  PoseTable poses;
};

class TableWriter {
 public:
  explicit TableWriter(const std::filesystem::path& path) : file_(path, std::ios::binary) {}

  template <typename Number>
  void write(std::span<const Number> numbers) {
    write_bytes(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
  }
  void write(std::int64_t number) { write(std::span<const std::int64_t>(&number, 1)); }
  void write(const std::string& text) { write_bytes(text.data(), text.size()); }

  void write(const Case& of, WrenchTable& expected) {
    for (const std::size_t count :
         {of.vertices.size() / 3, of.faces.size() / 3, of.poses.size(), of.poses.utimes.size()})
      write(static_cast<std::int64_t>(count));
    write(of.method);
    write(of.body_id);
    write(static_cast<std::int64_t>(of.text.size()));
    write(static_cast<std::int64_t>(of.path.size()));
    const double numbers[] = {of.tolerance,      of.water.level,    of.water.density, of.water.gravity,
                              of.water.up_W.x(), of.water.up_W.y(), of.water.up_W.z()};
    write(std::span<const double>(numbers));
    write(of.text);
    write(of.path);
    write(std::span(of.vertices));
    write(std::span(of.faces));
    write(std::span(of.poses.positions));
    write(std::span(of.poses.quaternions));
    write(std::span(of.poses.linear_velocities));
    write(std::span(of.poses.angular_velocities));
    write(std::span(of.poses.utimes));
    write(std::span<const std::int32_t>(expected.statuses));
    for (const std::vector<double>* const array :
         {&expected.forces, &expected.torques, &expected.volumes, &expected.centers, &expected.force_bounds,
          &expected.torque_bounds})
      write(std::span<const double>(*array));
  }

  bool close() {
    file_.close();
    return file_.good();
  }

 private:
  template <typename Number>
  void write(std::span<Number> numbers) {
    write(std::span<const Number>(numbers));
  }
  void write_bytes(const char* bytes, std::size_t count) {
    file_.write(bytes, static_cast<std::streamsize>(count));
    file_.write("\0\0\0\0\0\0\0", static_cast<std::streamsize>((8 - count % 8) % 8));
  }

  std::ofstream file_;
};

// The value of a result that is no error.
template <typename T>
T checked(Expected<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return *std::move(result);
}

TriangleMesh shape_of(const std::string& shape) {
  const std::string text = "[[body]]\nid = 1\nshape = " + shape + "\n";
  return make_shape(std::get<Shape>(checked(parse_scene(text, "shape", {})).bodies[0].mesh.source));
}

PoseTable poses_with_times(std::uint64_t seed) {
  PoseTable poses = random_poses(kPoses, 1.0, seed);
  for (std::size_t i = 0; i < kPoses; ++i)
    poses.utimes.push_back(kNow + static_cast<std::int64_t>(i / 50) * 1'234'567);
  poses.positions[3 * 17 + 1] = std::numeric_limits<double>::quiet_NaN();
  poses.quaternions[4 * 19] += 0.5;
  return poses;
}

WrenchTable expected_of_mesh(const Case& of) {
  const auto mesh = of.path.empty() ? checked(QueryMesh::make(of.vertices, of.faces, "mesh"))
                                    : checked(QueryMesh::load(of.path));
  QueryWater water{.at_rest = of.water, .waves = nullptr, .current = {}};
  water.at_rest.up_W = (of.water.up_W / of.water.up_W.cwiseAbs().maxCoeff()).normalized();
  if (!of.text.empty()) water = water_of(checked(QuerySea::parse(of.text, "sea", {})));
  const Method method =
      of.method == BUOYANCY_METHOD_EXACT_SURFACE ? Method::kExactSurface : Method::kHierarchical;
  const auto body = checked(mesh->body(method, of.tolerance, water.waves != nullptr));
  WrenchTable wrenches(of.poses.size());
  evaluate_poses(*body, water, of.poses.arrays(), wrenches.arrays());
  return wrenches;
}

void write_meshes(const std::string& directory, TableWriter& table) {
  for (std::size_t n = 0; n < std::size(kShapes); ++n) {
    const TriangleMesh mesh = shape_of(kShapes[n]);
    Case of;
    if (n % 2 == 1) {
      of.path = directory + "/mesh" + std::to_string(n) + ".obj";
      std::ofstream(of.path) << export_mesh(mesh, ExportFormat::kObj);
    } else {
      for (std::size_t i = 0; i < mesh.vertex_count(); ++i)
        of.vertices.insert(of.vertices.end(), {mesh.x[i], mesh.y[i], mesh.z[i]});
      for (const Triangle& triangle : mesh.triangles)
        of.faces.insert(of.faces.end(), triangle.begin(), triangle.end());
    }
    of.poses = poses_with_times(n);
    of.water = {
        .up_W = {0.1 * static_cast<double>(n), 0.0, 2.0}, .level = 0.1, .density = 998.0, .gravity = 9.81};
    for (const bool waves : {false, true}) {
      if (waves) of.water = {};
      of.text = waves ? kWaves : "";
      of.method = n == 1 ? BUOYANCY_METHOD_EXACT_SURFACE : BUOYANCY_METHOD_HIERARCHICAL;
      of.tolerance = n == 2 ? 1e-4 : 0.0;
      WrenchTable expected = expected_of_mesh(of);
      table.write(of, expected);
    }
  }
}

void write_scene(TableWriter& table) {
  Case of;
  of.body_id = 7;
  of.text = std::string(kWaves) +
            "[water.current]\nvelocity = [0.3, -0.2, 0.1]\n[[body]]\nid = 7\nshape = " + kShapes[4] +
            "\nreference_point = [0.1, 0, 0.2]\n[body.drag]\nlinear = [20, 60, 60, 5, 5, 8]\n"
            "[body.added_mass]\nmatrix = [5, 126, 126, 1, 33, 33]\n";
  of.poses = poses_with_times(9);
  const Scene scene = scene_of(of.text);
  WrenchTable expected(of.poses.size());
  evaluate_poses(*scene.find(7), water_of(scene), of.poses.arrays(), expected.arrays());
  table.write(of, expected);
}

}  // namespace
}  // namespace buoyancy

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "write_comparison_table DIRECTORY\n";
    return 2;
  }
  try {
    std::filesystem::create_directories(argv[1]);
    buoyancy::TableWriter table(std::filesystem::path(argv[1]) / "table.bin");
    table.write(std::int64_t{2 * std::size(buoyancy::kShapes) + 1});
    buoyancy::write_meshes(argv[1], table);
    buoyancy::write_scene(table);
    return table.close() ? 0 : 1;
  } catch (const std::exception& exception) {
    std::cerr << exception.what() << '\n';
    return 1;
  }
}
