// Time and error of the loads of waves: `hierarchical` with its bound, beside two methods that sum over all
// components at points of the whole wetted surface and do not know their error, in one run.
//
//   wave_speed [--quick | --smoke] [--csv FILE]
//
// Prints tables; --csv writes a row per measurement (wave_measurement.h). The reference is exact_surface in
// double on the same surface with each triangle cut into 4 to 4,096. Its own error is estimated by half as
// many cuts of every edge; on the meshes of up to 1,200 triangles it is compared with the tests' adaptive
// integration. Exit codes: 0 measured; 1 the error of a result exceeds its own bound, or the file cannot be
// written; 2 invalid arguments.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/format.h"
#include "benchmark_meshes.h"
#include "cli/tool_command_line.h"
#include "clock_cost.h"
#include "fail.h"
#include "geometry/shapes.h"
#include "median.h"
#include "pose_sweep.h"
#include "tests/truth/reference_load.h"
#include "wave_loads/wave_surface_methods.h"
#include "wave_measurement.h"

namespace buoyancy::bench {
namespace {

enum class Extent { kFull, kQuick, kSmoke };

struct PlannedMesh {
  BenchmarkMesh (*make)();
  int cuts;           // of each edge, for the reference; even
  bool is_compared;   // whether the reference is compared with adaptive integration
  bool quick, smoke;  // runs that include the mesh; the full one includes all
};

BenchmarkMesh box_of(const char* name, double size, std::int32_t segments) {
  TriangleMesh source = make_shape(BoxShape{{size, size, size}, {segments, segments, segments}});
  HydrostaticMesh mesh = make_hydrostatic_mesh({source, {}}, WithTree::kNo);
  return {name, std::move(source), std::move(mesh)};
}

BenchmarkMesh cylinder_of(const char* name, std::int32_t stacks) {
  TriangleMesh source = make_shape(CylinderShape{0.213, 4.9, 40, stacks});
  HydrostaticMesh mesh = make_hydrostatic_mesh({source, {}}, WithTree::kNo);
  return {name, std::move(source), std::move(mesh)};
}

constexpr std::array kPlan{
    PlannedMesh{[] { return box_of("box", 2.0, 1); }, 64, true, true, true},
    // A pontoon of long triangles, and the same of short ones.
    PlannedMesh{[] { return cylinder_of("pontoon", 1); }, 64, true, true, true},
    PlannedMesh{[] { return cylinder_of("pontoon", 40); }, 4, true, true, true},
    PlannedMesh{[] { return box_of("crate", 1.0, 10); }, 4, true, true, true},
    PlannedMesh{[] { return rock(16); }, 4, false, true, false},
    PlannedMesh{[] { return rock(39); }, 2, false, true, false},
    PlannedMesh{[] { return rock(122); }, 2, false, true, false},
    PlannedMesh{[] { return rock(224); }, 2, false, false, false},
};

constexpr std::array kTolerances{1e-2, 1e-3, 1e-4};
constexpr int kTableComponents = 200;

std::vector<int> components_of(Extent extent) {
  if (extent == Extent::kSmoke) return {1, kTableComponents};
  return {1, 50, kTableComponents, 512};
}

int poses_of(Extent extent) {
  return extent == Extent::kFull ? 20 : extent == Extent::kQuick ? 6 : 2;
}

int sweeps_of(Extent extent, std::size_t triangles, int components) {
  if (extent == Extent::kSmoke) return 1;
  const auto affordable = static_cast<int>((extent == Extent::kFull ? 60e6 : 10e6) /
                                           (static_cast<double>(triangles) * (components + 20)));
  return extent == Extent::kFull ? std::clamp(affordable, 3, 31) : std::clamp(affordable, 3, 9);
}

SeaDescription sea_of(int components, WavePressure pressure) {
  SeaDescription description;
  description.pressure = pressure;
  if (components == 1) {
    description.systems = {RegularWave{0.5, 3.0, 0.0, 0.0}};
    return description;
  }
  IrregularWaves waves;
  waves.significant_wave_height = 0.5;
  waves.peak_period = 3.0;
  waves.spreading = 10.0;
  // About as many frequencies for every number of components: where they are few, the shortest wave is
  // longer, which costs less whatever the number of components.
  waves.directions = components == 50 ? 1 : components == 200 ? 5 : 8;
  waves.frequencies = components / waves.directions;
  description.systems = {waves};
  return description;
}

// How long a method's turn lasts at least, ns: several passes over the poses for a method of microseconds,
// and more of them where slow methods allow few sweeps, so that each of its poses meets a quick moment of the
// machine.
double turn_of(Extent extent, int sweeps) {
  constexpr double kShortest = 10e6;
  constexpr double kOfAllSweeps = 0.3e9;
  return extent == Extent::kSmoke ? 0.0 : std::max(kShortest, kOfAllSweeps / sweeps);
}

// The surface with every edge cut into `cuts`, which does not change it.
HydrostaticMesh with_cut_triangles(const TriangleMesh& source, int cuts) {
  TriangleMesh mesh;
  for (const Triangle& t : source.triangles) {
    const Vec3 a = source.vertex(t[0]);
    const Vec3 ab = (source.vertex(t[1]) - a) / cuts;
    const Vec3 ac = (source.vertex(t[2]) - a) / cuts;
    const auto first = static_cast<std::int32_t>(mesh.vertex_count());
    for (int i = 0; i <= cuts; ++i) {
      for (int j = 0; j <= cuts - i; ++j) mesh.add_vertex(a + i * ab + j * ac);
    }
    const auto at = [first, cuts](int i, int j) { return first + i * (cuts + 1) - i * (i - 1) / 2 + j; };
    for (int i = 0; i < cuts; ++i) {
      for (int j = 0; j < cuts - i; ++j) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (j < cuts - i - 1) mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  return make_hydrostatic_mesh({mesh, {}}, WithTree::kNo);
}

// A body at one place and time in a sea.
struct WavePose {
  Pose pose;
  SeaSnapshot snapshot;
};

std::vector<WavePose> poses_in(const Sea& sea, const TriangleMesh& mesh, Extent extent) {
  std::vector<WavePose> poses;
  for (Pose& pose : sweep_of_poses(mesh, poses_of(extent))) {
    const auto n = static_cast<double>(poses.size());
    pose.p_WB.x() = 7.3 * n;
    pose.p_WB.y() = -4.1 * n;
    poses.push_back({pose, SeaSnapshot(sea)});
    poses.back().snapshot.set_time(static_cast<std::int64_t>(1.7e6 * n));
  }
  return poses;
}

struct WaveTruth {
  WaveLoad load;
  double force_error, torque_error;  // estimates
};

class WaveReference {
 public:
  WaveReference(const BenchmarkMesh& model, const PlannedMesh& planned)
      : model_(model),
        is_compared_(planned.is_compared),
        fine_(with_cut_triangles(model.source, planned.cuts)),
        coarse_(with_cut_triangles(model.source, planned.cuts / 2)) {}

  std::vector<WaveTruth> of(const std::vector<WavePose>& poses) const {
    std::vector<WaveTruth> truth;
    for (const WavePose& at : poses) {
      const WaveLoad fine = exact_surface_in_double(fine_, at.snapshot, at.pose, Vec3::Zero());
      const WaveLoad coarse = exact_surface_in_double(coarse_, at.snapshot, at.pose, Vec3::Zero());
      // The error falls with the fourth power of the cuts, by 16, down to rounding.
      constexpr double kFall = 8.0;
      const double rounding = 1e-12 * model_.mesh.volume;
      truth.push_back({fine, (fine.force - coarse.force).norm() / kFall + rounding,
                       (fine.torque - coarse.torque).norm() / kFall + rounding * model_.mesh.diagonal});
    }
    return truth;
  }

  // Compares the first pose's, which is at the origin of time, with adaptive integration.
  void check(const std::vector<WavePose>& poses, const std::vector<WaveTruth>& truth) const {
    if (!is_compared_) return;
    const Vec3& center_B = model_.mesh.center_B;
    const double goal = 1e-6 * model_.mesh.volume;
    const ReferenceSea sea(poses[0].snapshot.sea(), 0, 0.0, poses[0].pose, center_B);
    const ReferenceLoad load = reference_load(
        model_.source, center_B, sea, Vec3::Zero(),
        {.force_error = goal, .torque_error = goal * model_.mesh.diagonal, .volume_error = goal});
    const double difference = (load.force - truth[0].load.force).norm();
    // Both errors are estimates, of which either may happen to be small where the waterline crosses a piece
    // of the surface.
    constexpr double kScatter = 10.0;
    if (difference > kScatter * (load.force_error + truth[0].force_error)) {
      fail("the reference's force on the " + model_.name + " differs from that of adaptive integration by " +
           format_number(difference, 3) +
           " m^3 (over rho g); estimated errors: " + format_number(truth[0].force_error, 3) +
           " m^3 of the reference, " + format_number(load.force_error, 3) + " m^3 of the integration");
    }
  }

 private:
  const BenchmarkMesh& model_;
  bool is_compared_;
  HydrostaticMesh fine_, coarse_;
};

struct TimedMethod {
  WaveMeasurement row;
  std::function<WaveLoad(const WavePose&)> load;
  std::vector<double> min_ns;  // per pose
};

void measure_errors(TimedMethod& method, const HydrostaticMesh& mesh, const std::vector<WavePose>& poses,
                    const std::vector<WaveTruth>& truth) {
  WaveMeasurement& row = method.row;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const WaveLoad load = method.load(poses[i]);
    const double force_error = (load.force - truth[i].load.force).norm();
    const double torque_error = (load.torque - truth[i].load.torque).norm();
    const bool within = force_error <= load.force_bound + truth[i].force_error &&
                        torque_error <= load.torque_bound + truth[i].torque_error;
    if (!within) {  // also where an error is not a number
      fail(row.method + " on the " + row.mesh + " of " + std::to_string(row.triangles) + " triangles, " +
           std::to_string(row.components) + " components, " + row.pressure + ", tolerance " +
           std::to_string(row.tolerance) + ", pose " + std::to_string(i) + ": errors " +
           std::to_string(force_error) + " m^3 and " + std::to_string(torque_error) +
           " m^4 (over rho g) exceed their bounds " + std::to_string(load.force_bound) + " and " +
           std::to_string(load.torque_bound));
    }
    const double whole = mesh.volume;
    const double moment = mesh.volume * mesh.diagonal;
    row.force_error = std::max(row.force_error, force_error / whole);
    row.torque_error = std::max(row.torque_error, torque_error / moment);
    row.force_bound = std::max(row.force_bound, load.force_bound / whole);
    row.torque_bound = std::max(row.torque_bound, load.torque_bound / moment);
    row.capped += static_cast<int>(load.capped);
  }
}

volatile double result_sink;  // so that the compiler cannot omit a query

// The methods take turns, so that all of them meet the same states of the machine. A query of one method
// displaces what another one keeps in the caches. In use there is one method, so a turn goes over the poses
// until it has lasted for `turn_ns`: the least time of a pose is that with the caches as the method's own
// queries leave them.
void time_methods(std::vector<TimedMethod>& methods, const std::vector<WavePose>& poses, int sweeps,
                  double turn_ns) {
  const double clock_ns = clock_cost_ns();
  for (TimedMethod& method : methods) {
    method.min_ns.assign(poses.size(), std::numeric_limits<double>::max());
  }
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (TimedMethod& method : methods) {
      const auto turn_start = Clock::now();
      do {
        for (std::size_t i = 0; i < poses.size(); ++i) {
          const auto start = Clock::now();
          result_sink = method.load(poses[i]).volume;
          const double ns = std::max(0.0, nanoseconds(start, Clock::now()) - clock_ns);
          method.min_ns[i] = std::min(method.min_ns[i], ns);
        }
      } while (nanoseconds(turn_start, Clock::now()) < turn_ns);
    }
  }
  for (TimedMethod& method : methods) method.row.median_ns = median(method.min_ns);
}

void measure_sea(const BenchmarkMesh& model, const PatchTree& tree, const WaveReference& reference,
                 int components, WavePressure pressure, Extent extent,
                 std::vector<WaveMeasurement>& measurements) {
  const Sea sea = value_or_exit(Sea::make(sea_of(components, pressure), Water{}));
  const SeaExpansion expansion(sea);
  const std::vector<WavePose> poses = poses_in(sea, model.source, extent);
  const std::vector<WaveTruth> truth = reference.of(poses);
  if (components <= kTableComponents) reference.check(poses, truth);

  WaveMeasurement row;
  row.mesh = model.name;
  row.triangles = model.source.triangles.size();
  row.pressure = to_string(pressure);
  row.components = components;
  std::vector<TimedMethod> methods;
  for (const double tolerance : kTolerances) {
    row.method = "hierarchical";
    row.tolerance = tolerance;
    const WaveBody body{&model.mesh, &tree, tolerance};
    methods.push_back({row,
                       [body, &expansion](const WavePose& at) {
                         return wave_load(body, expansion, at.snapshot, at.pose, Vec3::Zero());
                       },
                       {}});
  }
  row.tolerance = 0.0;
  row.method = "exact_surface";
  methods.push_back({row,
                     [&model](const WavePose& at) {
                       return exact_surface_in_waves(model.mesh, at.snapshot, at.pose, Vec3::Zero());
                     },
                     {}});
  row.method = "fast_surface";
  methods.push_back({row,
                     [&model](const WavePose& at) {
                       return fast_surface_in_waves(model.mesh, at.snapshot, at.pose, Vec3::Zero());
                     },
                     {}});
  for (TimedMethod& method : methods) measure_errors(method, model.mesh, poses, truth);
  const int sweeps = sweeps_of(extent, row.triangles, components);
  time_methods(methods, poses, sweeps, turn_of(extent, sweeps));
  for (const TimedMethod& method : methods) measurements.push_back(method.row);
}

std::vector<WaveMeasurement> measure_all(Extent extent) {
  std::vector<WaveMeasurement> measurements;
  for (const PlannedMesh& planned : kPlan) {
    if ((extent == Extent::kQuick && !planned.quick) || (extent == Extent::kSmoke && !planned.smoke))
      continue;
    const BenchmarkMesh model = planned.make();
    const PatchTree tree = build_patch_tree(model.mesh.surface);
    const WaveReference reference(model, planned);
    for (const WavePressure pressure : {WavePressure::kWheeler, WavePressure::kHydrostatic}) {
      for (const int components : components_of(extent)) {
        std::fprintf(stderr, "%s of %zu triangles, %s, %d components\n", model.name.c_str(),
                     model.source.triangles.size(), std::string(to_string(pressure)).c_str(), components);
        measure_sea(model, tree, reference, components, pressure, extent, measurements);
      }
    }
  }
  return measurements;
}

int run(int argc, char** argv) {
  ToolCommandLine command_line("Measure time and error of the loads of waves");
  bool quick = false;
  bool smoke = false;
  std::string csv_path;
  command_line.add_flag("--quick", quick, "Use fewer meshes, components and poses: less than a minute");
  command_line.add_flag("--smoke", smoke,
                        "Use two small meshes, 2 poses and one sweep: times are meaningless", "--quick");
  command_line.add_option("--csv", csv_path, "Write a row per measurement to this file");
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;

  // The file is opened first, so that an error is reported before the measurements.
  std::FILE* csv = nullptr;
  if (!csv_path.empty()) {
    csv = std::fopen(csv_path.c_str(), "w");
    if (csv == nullptr) {
      std::perror(csv_path.c_str());
      return EXIT_FAILURE;
    }
  }
  const auto measurements = measure_all(smoke ? Extent::kSmoke : quick ? Extent::kQuick : Extent::kFull);
  print_wave_report(stdout, measurements, kTableComponents);
  if (csv != nullptr) {
    write_csv(csv, measurements);
    const bool failed = std::ferror(csv) != 0;
    if (std::fclose(csv) != 0 || failed) {
      std::perror(csv_path.c_str());
      return EXIT_FAILURE;
    }
  }
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace buoyancy::bench

int main(int argc, char** argv) {
  return buoyancy::bench::run(argc, argv);
}
