// What it takes to start with a large mesh, stage by stage, and to compute with a small one.
//
//   startup [--quick] [--csv FILE]
//
// Markdown on standard output. --csv writes a row per measurement: mesh,triangles,format,stage,milliseconds,
// and for the mesh `small`, a box of 12 triangles, nanoseconds per pose in place of milliseconds. Every time
// is the least of several runs. The stages are those of one process, `ready` is the time from the start of
// buoyancyd to its line "ready", which is looked for every 2 ms. Exits with 1 if a result is wrong.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "c/buoyancy.h"
#include "cli/tool_command_line.h"
#include "engine/request_handler.h"
#include "geometry/mesh_export.h"
#include "markdown_table.h"
#include "service_process.h"
#include "wave_loads/wave_buoyancy.h"

namespace buoyancy::bench {
namespace {

constexpr int kPoses = 128;
constexpr int kReplayedPoses = 300'000;

struct Row {
  std::string mesh;
  std::size_t triangles;
  std::string format, stage;
  double time;  // [ms]; small: [ns]
};

// Returns the least time of several runs [s].
template <typename Task>
double least(int runs, const Task& task) {
  using Clock = std::chrono::steady_clock;
  double best = std::numeric_limits<double>::infinity();
  for (int run = 0; run < runs; ++run) {
    const auto start = Clock::now();
    task();
    best = std::min(best, std::chrono::duration<double>(Clock::now() - start).count());
  }
  return best;
}

void measure_start(std::int32_t frequency, int runs, const TempDir& directory, std::vector<Row>& rows) {
  const TriangleMesh rock = make_shape(RockShape{.frequency = frequency});
  for (const char* const extension : {"obj", "stl", "ply"}) {
    const std::string path =
        directory.write("rock." + std::string(extension),
                        export_mesh(rock, export_format("rock." + std::string(extension)).value()));
    const auto add = [&](const char* stage, double seconds) {
      rows.push_back({"rock", rock.triangles.size(), extension, stage, 1e3 * seconds});
    };
    ImportedMesh imported;
    add("import", least(runs, [&] { imported = value_or_exit(import_mesh(path)); }));
    double validation = std::numeric_limits<double>::infinity();
    for (int run = 0; run < runs; ++run) {
      ImportedMesh copy = imported;
      validation =
          std::min(validation, least(1, [&] { value_or_exit(prepare_mesh(std::move(copy), path, {})); }));
    }
    add("validation", validation);
    PreparedMesh prepared = value_or_exit(prepare_mesh(std::move(imported), path, {}));
    if (prepared.mesh.surface.triangles.size() != rock.triangles.size()) fail("another mesh");
    add("tree", least(runs, [&] { prepared.mesh.tree = build_moment_tree(prepared.mesh); }));
    add("waves", least(runs, [&] { make_wave_mesh(prepared.mesh); }));
    const std::string scene = directory.write("scene.toml", bodies_of(1, "mesh = \"" + path + "\""));
    add("ready", least(runs, [&] {
          ReadyProcess({built_program("buoyancyd"), "--scene", scene, "-l", "memq://"});
        }));
  }
}

// Poses of a box about 2 m high that crosses the water, in any orientation.
struct Poses {
  std::array<double, 3 * kPoses> positions{};
  std::array<double, 4 * kPoses> quaternions{};

  Poses() {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> height(-0.9, 0.9);
    std::normal_distribution<double> component;
    for (std::size_t i = 0; i < kPoses; ++i) {
      positions[3 * i + 2] = height(random);
      Eigen::Quaterniond q(component(random), component(random), component(random), component(random));
      q.normalize();
      for (std::size_t n = 0; n < 4; ++n)
        quaternions[4 * i + n] = n == 0 ? q.w() : q.coeffs()[static_cast<int>(n) - 1];
    }
  }
};

const Shape kBox = BoxShape{.size = {2.0, 3.0, 2.0}};

void check(buoyancy_error error) {
  if (error != BUOYANCY_OK) fail(buoyancy_last_error());
}

void measure_queries(const Poses& poses, int runs, std::vector<Row>& rows) {
  const TriangleMesh box = make_shape(kBox);
  std::vector<double> vertices;
  std::vector<std::int32_t> faces;
  for (std::size_t v = 0; v < box.vertex_count(); ++v)
    vertices.insert(vertices.end(), {box.x[v], box.y[v], box.z[v]});
  for (const Triangle& triangle : box.triangles) faces.insert(faces.end(), triangle.begin(), triangle.end());
  buoyancy_mesh* mesh = nullptr;
  check(buoyancy_mesh_create(vertices.data(), static_cast<std::int64_t>(box.vertex_count()), faces.data(),
                             static_cast<std::int64_t>(box.triangles.size()), nullptr, &mesh));
  std::array<double, kPoses> volumes{};
  const auto query = [&](std::size_t first, std::size_t count) {
    buoyancy_poses at{};
    at.size = sizeof at;
    at.count = static_cast<std::int64_t>(count);
    at.positions = poses.positions.data() + 3 * first;
    at.quaternions = poses.quaternions.data() + 4 * first;
    std::array<double, 3 * kPoses> forces;
    std::array<double, 3 * kPoses> torques;
    buoyancy_wrenches out{};
    out.size = sizeof out;
    out.forces = forces.data();
    out.torques = torques.data();
    out.volumes = volumes.data() + first;
    check(buoyancy_mesh_query(mesh, nullptr, BUOYANCY_METHOD_HIERARCHICAL, 0.0, &at, &out, 1));
  };
  const auto add = [&](const char* stage, double seconds) {
    rows.push_back({"small", box.triangles.size(), "C", stage, 1e9 * seconds / kPoses});
  };
  add("a pose a call", least(runs, [&] {
        for (std::size_t i = 0; i < kPoses; ++i) query(i, 1);
      }));
  const std::array<double, kPoses> one_by_one = volumes;
  add("batch", least(runs, [&] { query(0, kPoses); }));
  if (volumes != one_by_one) fail("a batch has other bits than its poses one by one");
  check(buoyancy_mesh_free(mesh));
}

// The service's work for a request about boxes that all move, from bytes to bytes, less that for the same
// boxes where none of them has moved.
void measure_service(const Poses& poses, int runs, std::vector<Row>& rows) {
  const Scene scene = scene_of(bodies_of(kPoses, "shape = { type = \"box\", size = [2, 3, 2] }"));
  RequestHandler handler(scene, {.threads = 1});
  WrenchRequest request;
  request.bodies.resize(kPoses);
  const auto bytes_of = [&](std::int64_t seq, double shift) {
    request.id.seq = seq;
    for (std::size_t i = 0; i < kPoses; ++i) {
      BodyState& state = request.bodies[i];
      state.body_id = static_cast<std::int32_t>(i + 1);
      std::copy_n(poses.positions.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, state.position.begin());
      std::copy_n(poses.quaternions.begin() + static_cast<std::ptrdiff_t>(4 * i), 4,
                  state.quaternion_wxyz.begin());
      state.position[0] += shift;
    }
    std::vector<std::uint8_t> bytes;
    encode(request, bytes);
    return bytes;
  };
  double moving = std::numeric_limits<double>::infinity();
  double at_rest = moving;
  for (int run = 0; run < runs; ++run) {
    const std::vector<std::uint8_t> moved = bytes_of(2 * run, 0.01 * run);
    const std::vector<std::uint8_t> same = bytes_of(2 * run + 1, 0.01 * run);
    moving = std::min(moving, least(1, [&] { handler.handle(moved); }));
    at_rest = std::min(at_rest, least(1, [&] { handler.handle(same); }));
  }
  rows.push_back({"small", 12, "service", "a moving body", 1e9 * (moving - at_rest) / kPoses});
}

void measure_replay(const Poses& poses, int runs, const TempDir& directory, std::vector<Row>& rows) {
  const std::string scene =
      directory.write("box.toml", bodies_of(1, "shape = { type = \"box\", size = [2, 3, 2] }"));
  const std::string input = directory.path() / "poses.csv";
  std::ofstream file(input);
  file.precision(17);
  file << "utime,body_id,px,py,pz,qw,qx,qy,qz\n";
  for (int row = 0; row < kReplayedPoses; ++row) {
    const auto i = static_cast<std::size_t>(row % kPoses);
    file << row << ",1";
    for (std::size_t n = 0; n < 3; ++n) file << ',' << poses.positions[3 * i + n];
    for (std::size_t n = 0; n < 4; ++n) file << ',' << poses.quaternions[4 * i + n];
    file << '\n';
  }
  file.close();
  const std::vector<std::string> command{
      built_program("buoyancy-replay"), "--scene", scene, "--jobs", "1", input,
      directory.path() / "wrenches.csv"};
  const double seconds = least(runs, [&] {
    if (run_to_end(command_of(command), 60.0).exit_code != 0) fail("buoyancy-replay failed");
  });
  rows.push_back({"small", 12, "csv", "buoyancy-replay", 1e9 * seconds / kReplayedPoses});
}

void print(const std::vector<Row>& rows) {
  MarkdownTable starts({"mesh", "triangles", "format", "import", "validation", "tree", "waves", "ready"});
  MarkdownTable small({"box of 12 triangles", "ns per pose"});
  std::vector<std::string> cells;
  for (const Row& row : rows) {
    if (row.mesh == "small") {
      small.add({row.format + ", " + row.stage, format_cell("%.0f", row.time)});
      continue;
    }
    if (cells.empty()) cells = {row.mesh, std::to_string(row.triangles), row.format};
    cells.push_back(format_cell("%.1f", row.time));
    if (row.stage != "ready") continue;
    starts.add(std::move(cells));
    cells.clear();
  }
  starts.print(stdout, 1);
  small.print(stdout, 1);
}

void write_csv(const std::string& path, const std::vector<Row>& rows) {
  std::ofstream file(path);
  file << "mesh,triangles,format,stage,milliseconds\n";
  for (const Row& row : rows) {
    file << row.mesh << ',' << row.triangles << ',' << row.format << ',' << row.stage << ',' << row.time
         << '\n';
  }
  if (!file.flush()) fail("cannot write " + path);
}

}  // namespace
}  // namespace buoyancy::bench

int main(int argc, char** argv) {
  using namespace buoyancy::bench;  // NOLINT(google-build-using-namespace): the program's own
  buoyancy::ToolCommandLine command_line(
      "Times of starting with large meshes and of computing with small ones.");
  bool quick = false;
  std::string csv;
  command_line.add_flag("--quick", quick, "no mesh of a million triangles, fewer runs");
  command_line.add_option("--csv", csv, "also write a row per measurement to this file");
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;
  const buoyancy::TempDir directory;
  std::vector<Row> rows;
  const int runs = quick ? 3 : 7;
  measure_start(16, runs, directory, rows);
  measure_start(71, runs, directory, rows);
  if (!quick) measure_start(224, runs, directory, rows);
  const Poses poses;
  measure_queries(poses, 2000, rows);
  measure_service(poses, 2000, rows);
  measure_replay(poses, runs, directory, rows);
  print(rows);
  if (!csv.empty()) write_csv(csv, rows);
  return 0;
}
