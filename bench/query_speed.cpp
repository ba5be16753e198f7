// Time of queries by arrays of poses in C++, beside which scripts/measure python sets those from Python.
//
//   query_speed DIRECTORY
//
// Reads vertices.f64, faces.i64, and poses.f64 (rows of position and quaternion) from the directory. Prints
// the times [ns]: per query of one pose per call, and of all poses in one call on one and on all threads; and
// the sum of the vertical forces, which must have the same bits in Python.
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <time.h>

#include "fail.h"
#include "query/pose_evaluation.h"
#include "query/query_mesh.h"

namespace buoyancy::bench {
namespace {

constexpr std::size_t kSingle = 1000;  // poses that are queried one by one
constexpr int kRuns = 15;

template <typename Number>
std::vector<Number> read(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<Number> numbers(static_cast<std::size_t>(file ? std::streamoff(file.tellg()) : 0) /
                              sizeof(Number));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(numbers.data()),
            static_cast<std::streamsize>(numbers.size() * sizeof(Number)));
  if (!file || numbers.empty()) fail("cannot read " + path);
  return numbers;
}

// Of the quickest of several runs [ns]: of this thread's processor time, or of wall-clock time.
template <typename Task>
double time_of(clockid_t clock, Task task) {
  const auto now = [clock] {
    timespec time{};
    clock_gettime(clock, &time);
    return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
  };
  double best = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const double start = now();
    task();
    const double elapsed = now() - start;
    if (run == 0 || elapsed < best) best = elapsed;
  }
  return best;
}

void measure(const std::string& directory) {
  const auto mesh = value_or_exit(QueryMesh::make(read<double>(directory + "/vertices.f64"),
                                                  read<std::int64_t>(directory + "/faces.i64"), "mesh"));
  const std::vector<double> rows = read<double>(directory + "/poses.f64");
  const std::size_t count = rows.size() / 7;
  std::vector<double> positions;
  std::vector<double> quaternions;
  for (std::size_t i = 0; i < count; ++i) {
    positions.insert(positions.end(), &rows[7 * i], &rows[7 * i] + 3);
    quaternions.insert(quaternions.end(), &rows[7 * i] + 3, &rows[7 * i] + 7);
  }
  std::vector<std::int32_t> statuses(count);
  std::vector<double> forces(3 * count);
  std::vector<double> torques(3 * count);
  std::vector<double> volumes(count);
  std::vector<double> centers(3 * count);
  std::vector<double> force_bounds(count);
  std::vector<double> torque_bounds(count);
  const auto query = [&](std::size_t begin, std::size_t size, unsigned threads) {
    const auto body = value_or_exit(mesh->body(Method::kHierarchical, 0.0, false));
    PoseArrays poses;
    poses.positions = std::span(positions).subspan(3 * begin, 3 * size);
    poses.quaternions_wxyz = std::span(quaternions).subspan(4 * begin, 4 * size);
    evaluate_poses(
        *body, QueryWater{{}, nullptr, {}, true}, poses,
        {std::span(statuses).subspan(begin, size), std::span(forces).subspan(3 * begin, 3 * size),
         std::span(torques).subspan(3 * begin, 3 * size), std::span(volumes).subspan(begin, size),
         std::span(centers).subspan(3 * begin, 3 * size), std::span(force_bounds).subspan(begin, size),
         std::span(torque_bounds).subspan(begin, size)},
        {}, threads);
  };
  const double single = time_of(CLOCK_THREAD_CPUTIME_ID,
                                [&] {
                                  for (std::size_t i = 0; i < kSingle; ++i) query(i, 1, 1);
                                }) /
                        kSingle;
  const double one_thread = time_of(CLOCK_THREAD_CPUTIME_ID, [&] { query(0, count, 1); });
  const double all_threads = time_of(CLOCK_MONOTONIC, [&] { query(0, count, 0); });
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += forces[3 * i + 2];
  std::printf("%.17g %.17g %.17g %.17g\n", single, one_thread, all_threads, sum);
}

}  // namespace
}  // namespace buoyancy::bench

int main(int argc, char** argv) {
  if (argc != 2) buoyancy::bench::fail("expected one argument, the directory");
  buoyancy::bench::measure(argv[1]);
  return 0;
}
