// Writes meshes, scenes, poses and the wrenches that the service's request handler gives for them, as binary
// files that the tests of the Python module compare with its results.
//
//   python_reference DIRECTORY
//
// poses.f64      1,000 rows of position (3), quaternion (4), linear (3) and angular velocity (3)
// utimes.i64     one per pose
// NAME.vertices.f64, NAME.faces.i64
// WATER.toml     a scene with the bodies 1 to 5, one per mesh, and 6 with drag, added mass and loads
// WATER.ID.f64   per pose: status, force, torque, volume, centre of buoyancy, both error bounds
// WATER.lcmlog   the requests and responses about them, as lcm-logger records them
// WATER.6.loads.f64   per pose: drag force (3), added mass (36)
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include "engine/request_handler.h"
#include "geometry/shapes.h"
#include "tests/query/pose_table.h"
#include "tests/support/recorded_log.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

constexpr std::size_t kPoses = 1000;
constexpr std::size_t kPosesPerTime = 50;
constexpr std::int64_t kStart = 1'790'000'000'000'000;  // [us], of 2026

struct NamedShape {
  std::string name, toml;
  Shape shape;
};

std::vector<NamedShape> shapes() {
  return {{"rock", R"({ type = "rock", frequency = 8, seed = 5 })", RockShape{.frequency = 8, .seed = 5}},
          {"sphere", R"({ type = "sphere", segments = 20 })", SphereShape{.segments = 20}},
          {"knot", R"({ type = "torus_knot" })", TorusKnotShape{}},
          {"hull", R"({ type = "wigley" })", WigleyShape{}},
          {"cone", R"({ type = "cone" })", ConeShape{}}};
}

std::string scene_text(const std::string& water) {
  std::string text = water;
  int id = 0;
  for (const NamedShape& shape : shapes()) {
    text += "[[body]]\nid = " + std::to_string(++id) + "\nshape = " + shape.toml + "\n";
  }
  return text +
         "[[body]]\nid = 6\nname = \"rov\"\nshape = { type = \"rock\", frequency = 8, seed = 5 }\noutputs = "
         "[\"wrench\", "
         "\"loads\"]\nreference_point = [0.5, -0.5, 1]\n[body.drag]\nlinear = [20, 60, 60, 5, 5, "
         "8]\n[body.added_mass]\n"
         "matrix = [5, 126, 126, 1, 33, 33]\n";
}

template <typename Number>
void write(const std::filesystem::path& path, const std::vector<Number>& numbers) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(numbers.data()),
             static_cast<std::streamsize>(numbers.size() * sizeof(Number)));
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

void write_shape(const std::filesystem::path& directory, const NamedShape& named) {
  const TriangleMesh mesh = make_shape(named.shape);
  std::vector<double> vertices;
  for (std::size_t i = 0; i < mesh.x.size(); ++i)
    vertices.insert(vertices.end(), {mesh.x[i], mesh.y[i], mesh.z[i]});
  std::vector<std::int64_t> faces;
  for (const auto& triangle : mesh.triangles) faces.insert(faces.end(), triangle.begin(), triangle.end());
  write(directory / (named.name + ".vertices.f64"), vertices);
  write(directory / (named.name + ".faces.i64"), faces);
}

void append(std::span<const double> values, std::vector<double>& row) {
  row.insert(row.end(), values.begin(), values.end());
}

void append(const BodyWrench& wrench, std::vector<double>& rows) {
  rows.push_back(static_cast<double>(wrench.status));
  append(wrench.force, rows);
  append(wrench.torque, rows);
  rows.push_back(wrench.submerged_volume);
  append(wrench.center_of_buoyancy, rows);
  rows.push_back(wrench.force_error_bound);
  rows.push_back(wrench.torque_error_bound);
}

// Requests the poses of each time together, and appends the messages to a log.
void write_wrenches(const std::filesystem::path& directory, const std::string& water, const Scene& scene,
                    const PoseTable& poses, std::int32_t body_id, RecordedLog& log) {
  RequestHandler handler(scene);
  std::vector<double> rows;
  std::vector<double> loads_rows;
  for (std::size_t begin = 0; begin < poses.size(); begin += kPosesPerTime) {
    WrenchRequest request{{poses.utimes[begin], 1, static_cast<std::int64_t>(begin)}, 0.0, {}};
    for (std::size_t i = begin; i < begin + kPosesPerTime; ++i)
      request.bodies.push_back(poses.state(i, body_id));
    const ByteVector bytes = encoded(request);
    const Bytes responded = handler.handle(bytes);
    log.add(request.id.utime, kStatesChannel, bytes);
    log.add(request.id.utime, kWrenchesChannel, responded);
    for (const BodyWrench& wrench : decoded<WrenchResponse>(responded).bodies) append(wrench, rows);
    if (handler.last_loads().empty()) continue;
    for (const BodyLoads& body : decoded<BodiesLoads>(handler.last_loads()).bodies) {
      append(body.drag_force, loads_rows);
      for (const auto& row : body.added_mass) append(row, loads_rows);
    }
  }
  const std::string stem = water + "." + std::to_string(body_id);
  write(directory / (stem + ".f64"), rows);
  if (!loads_rows.empty()) write(directory / (stem + ".loads.f64"), loads_rows);
}

PoseTable poses_and_times(const std::filesystem::path& directory) {
  PoseTable poses = random_poses(kPoses, 1.0, 7);
  poses.quaternions[4 * 10] += 0.1;
  poses.positions[3 * 20] = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> rows;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses.utimes.push_back(kStart + static_cast<std::int64_t>(i / kPosesPerTime) * 1'234'567);
    append(std::span(poses.positions).subspan(3 * i, 3), rows);
    append(std::span(poses.quaternions).subspan(4 * i, 4), rows);
    append(std::span(poses.linear_velocities).subspan(3 * i, 3), rows);
    append(std::span(poses.angular_velocities).subspan(3 * i, 3), rows);
  }
  write(directory / "poses.f64", rows);
  write(directory / "utimes.i64", poses.utimes);
  return poses;
}

void write_all(const std::filesystem::path& directory) {
  for (const NamedShape& shape : shapes()) write_shape(directory, shape);
  const PoseTable poses = poses_and_times(directory);
  const std::vector<std::pair<std::string, std::string>> waters{
      {"rest", ""},
      {"tilted", "[world]\ngravity = 3.7\nup = [0.3, -0.2, 2]\n[water]\nlevel = 0.1\ndensity = 998.2\n"},
      {"waves",
       "[water]\ndepth = 30\nwaves = { type = \"jonswap\", significant_wave_height = 0.5, peak_period = 4.0, "
       "frequencies = 40, seed = 3 }\n"}};
  for (const auto& [name, toml] : waters) {
    const std::string text = scene_text(toml);
    std::ofstream(directory / (name + ".toml")) << text;
    const Scene scene = scene_of(text);
    RecordedLog log;
    for (const Body& body : scene.bodies()) write_wrenches(directory, name, scene, poses, body.id, log);
    write(directory / (name + ".lcmlog"), std::vector<char>(log.text().begin(), log.text().end()));
  }
}

}  // namespace
}  // namespace buoyancy

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: python_reference DIRECTORY\n";
    return 2;
  }
  try {
    buoyancy::write_all(argv[1]);
  } catch (const std::exception& error) {
    std::cerr << "python_reference: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
