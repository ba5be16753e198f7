#include "tests/random_search/wave_search.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <thread>
#include <utility>

#include "base/format.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "waves/sea_snapshot.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMaxFailures = 100;
constexpr std::int64_t kAllTargetsEvery = 16;
constexpr double kGoal = 0.05;  // of the oracle's error, over the bound
constexpr double kUndecided = 0.1;
constexpr double kBinsPerDecade = 20.0;

RandomPoses random_of(std::uint64_t seed, std::int64_t number, std::uint32_t purpose) {
  std::seed_seq mix{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U),
                    static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32), purpose};
  std::array<std::uint32_t, 2> bits{};
  mix.generate(bits.begin(), bits.end());
  return RandomPoses(std::uint64_t{bits[0]} << 32U | bits[1]);
}

struct TargetLoad {
  std::string target;
  WaveLoad load;
};

// A case with its sea, and what was evaluated. In place: the snapshot refers to the sea.
struct Run {
  Run(WaveRequest drawn, std::int64_t case_number)
      : number(case_number),
        request(std::move(drawn)),
        sea(Sea::make(request.description, request.water).value()),
        snapshot(sea),
        expansion(sea) {
    snapshot.set_time(request.utime, request.lead_time);
  }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  std::int64_t number;
  WaveRequest request;
  Sea sea;
  SeaSnapshot snapshot;
  SeaExpansion expansion;
  std::vector<TargetLoad> loads;
};

struct Group {
  WaveMesh mesh;
  std::vector<std::unique_ptr<Run>> runs;
};

Group make_group(std::uint64_t seed, std::int64_t mesh_number) {
  Group group;
  RandomPoses of_mesh = random_of(seed, mesh_number, 1);
  group.mesh = random_wave_mesh(of_mesh);
  for (std::int64_t i = 0; i < kWaveCasesPerMesh; ++i) {
    const std::int64_t number = mesh_number * kWaveCasesPerMesh + i;
    RandomPoses random = random_of(seed, number, 2);
    group.runs.push_back(std::make_unique<Run>(random_wave_request(group.mesh, random), number));
  }
  return group;
}

void evaluate_run(const WaveMesh& mesh, Run& run, const std::string& target, const EvaluateWaves& evaluate) {
  const WaveBody body{&mesh.mesh, &mesh.tree, run.request.tolerance};
  run.loads.push_back({target, evaluate(body, run.expansion, run.snapshot, run.request)});
}

ReferenceSea reference_sea_of(const WaveMesh& mesh, const Run& run) {
  return {run.sea, run.request.utime, run.request.lead_time, run.request.pose, mesh.mesh.center_B};
}

// With errors well below the smallest bound.
ReferenceLoad truth_of(const WaveMesh& mesh, const Run& run, const ReferenceSea& sea) {
  double force_bound = std::numeric_limits<double>::infinity();
  double torque_bound = force_bound;
  double volume_bound = force_bound;
  for (const TargetLoad& of_target : run.loads) {
    force_bound = std::min(force_bound, of_target.load.force_bound);
    torque_bound = std::min(torque_bound, of_target.load.torque_bound);
    volume_bound = std::min(volume_bound, of_target.load.volume_bound);
  }
  // Where the result is exact, as that of a dry body is.
  const double least = 1e-9 * mesh.mesh.volume;
  const double least_torque = least * mesh.mesh.max_lever_arm(run.request.reference_B);
  const auto goal = [](double bound, double at_least) { return std::max(kGoal * bound, at_least); };
  return reference_load(mesh.source_B, mesh.mesh.center_B, sea, run.request.reference_B,
                        {.force_error = goal(force_bound, least),
                         .torque_error = goal(torque_bound, least_torque),
                         .volume_error = goal(volume_bound, least)});
}

std::string violation(const char* what, const std::string& target, double error, double bound, double truth) {
  return std::string(what) + " on " + target + ": error " + format_number(error, 6) + ", bound " +
         format_number(bound, 6) + ", the truth's own error " + format_number(truth, 3);
}

bool is_finite(const WaveLoad& load) {
  return load.force.allFinite() && load.torque.allFinite() && load.moment.allFinite() &&
         std::isfinite(load.volume) && std::isfinite(load.force_bound) && std::isfinite(load.torque_bound) &&
         std::isfinite(load.volume_bound) && load.force_bound >= 0.0 && load.torque_bound >= 0.0 &&
         load.volume_bound >= 0.0;
}

// The product's sea and the reference's at a few points of the body.
void compare_seas(const WaveMesh& mesh, const Run& run, const ReferenceSea& reference,
                  std::vector<std::string>& violations) {
  SeaPoints points;
  const std::size_t vertices = mesh.mesh.surface.vertex_count();
  for (std::size_t i = 0; i < 3; ++i) {
    points.add(mesh.mesh.surface.vertex(static_cast<std::int32_t>(i * (vertices - 1) / 2)));
  }
  reference.set_pressures(points);
  const Mat3 R_WB = run.request.pose.q_WB.normalized().toRotationMatrix();
  const double weight = run.request.water.density * run.request.water.gravity;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 y(points.x[i], points.y[i], points.z[i]);
    const Vec3 p_W = run.request.pose.p_WB + R_WB * (mesh.mesh.center_B + y);
    const WaterAtPoint water = run.snapshot.at(p_W);
    // Positions in the world are rounded.
    const double rounding =
        1e-15 * (p_W.norm() + run.request.pose.p_WB.norm()) * (1.0 + reference.max_slope());
    const double allowed = 2.0 * reference.error() + rounding + 1e-12 * reference.max_elevation();
    const double of_height = std::abs(water.height - points.height[i]);
    const double of_pressure =
        points.height[i] < 0.0 ? std::abs(water.pressure / weight - points.pressure[i]) : 0.0;
    if (of_height <= allowed && of_pressure <= 2.0 * allowed + 1e-14 * std::abs(points.pressure[i])) continue;
    violations.push_back(violation("the sea's own height or pressure", "a vertex",
                                   std::max(of_height, of_pressure), allowed, reference.error()));
  }
}

// Whether the mean wave is more than twice as long as the body.
bool has_long_waves(const WaveMesh& mesh, const Sea& sea) {
  double amplitudes = 0.0;
  double slopes = 0.0;
  for (std::size_t i = 0; i < sea.prepared().size(); ++i) {
    amplitudes += sea.prepared().amplitude[i];
    slopes += sea.prepared().amplitude[i] * sea.prepared().wave_number[i];
  }
  return 2.0 * std::numbers::pi * amplitudes > 2.0 * mesh.mesh.diagonal * slopes;
}

struct Checked {
  WaveFigures figures;
  std::vector<std::string> violations;
  ReferenceLoad truth;
};

Checked check_run(const WaveMesh& mesh, const Run& run) {
  Checked checked;
  const ReferenceSea sea = reference_sea_of(mesh, run);
  compare_seas(mesh, run, sea, checked.violations);
  checked.truth = truth_of(mesh, run, sea);
  const ReferenceLoad& truth = checked.truth;
  WaveFigures& figures = checked.figures;
  figures.cases = 1;
  const bool long_waves = has_long_waves(mesh, run.sea);
  bool undecided = false;
  bool within = true;
  bool capped = false;
  bool too_steep = false;
  for (const TargetLoad& of_target : run.loads) {
    const WaveLoad& load = of_target.load;
    ++figures.loads;
    if (!is_finite(load)) {
      checked.violations.push_back("not finite, on " + of_target.target);
      continue;
    }
    const double force = (load.force - truth.force).norm();
    const double torque = (load.torque - truth.torque).norm();
    const double volume = std::abs(load.volume - truth.volume);
    const auto require = [&](const char* what, double error, double bound, double own_error) {
      if (error <= bound + own_error) return;
      checked.violations.push_back(violation(what, of_target.target, error, bound, own_error));
    };
    require("force", force, load.force_bound, truth.force_error);
    require("torque", torque, load.torque_bound, truth.torque_error);
    require("volume", volume, load.volume_bound, truth.volume_error);
    undecided |= truth.force_error > kUndecided * load.force_bound && load.force_bound > 0.0;
    undecided |= truth.torque_error > kUndecided * load.torque_bound && load.torque_bound > 0.0;
    undecided |= truth.volume_error > kUndecided * load.volume_bound && load.volume_bound > 0.0;
    within &= load.force_bound <= run.request.tolerance * mesh.mesh.volume;
    capped |= load.capped;
    too_steep |= load.too_steep;
    if (!(load.force_bound > 0.0) || undecided) continue;
    const auto record = [&](double error, double bound, LargestInWaves& largest) {
      // The volume of a body that is wet everywhere is exact.
      if (bound > 0.0 && error > bound * largest.value) largest = {error / bound, run.number};
    };
    record(force, load.force_bound, figures.force);
    record(torque, load.torque_bound, figures.torque);
    record(volume, load.volume_bound, figures.volume);
    figures.ratios.add(load.force_bound / force);
  }
  figures.undecided = static_cast<std::int64_t>(undecided);
  figures.capped = static_cast<std::int64_t>(capped);
  figures.too_steep = static_cast<std::int64_t>(too_steep);
  figures.long_waves = static_cast<std::int64_t>(long_waves);
  figures.long_within = static_cast<std::int64_t>(long_waves && within);
  return checked;
}

std::string results_text(const Run& run, const ReferenceLoad& truth) {
  std::string text = "  truth: force " + format_vector(truth.force, 12) + " +- " +
                     format_number(truth.force_error, 3) + ", torque " + format_vector(truth.torque, 12) +
                     " +- " + format_number(truth.torque_error, 3) + ", volume " +
                     format_number(truth.volume, 12) + (truth.resolved ? "" : ", not resolved") + ", work " +
                     std::to_string(truth.work) + "\n";
  for (const TargetLoad& of_target : run.loads) {
    const WaveLoad& load = of_target.load;
    text += "  " + of_target.target + ": force " + format_vector(load.force, 12) + ", bound " +
            format_number(load.force_bound, 4) + ", error " +
            format_number((load.force - truth.force).norm(), 4) + "; torque " +
            format_vector(load.torque, 12) + ", bound " + format_number(load.torque_bound, 4) + ", error " +
            format_number((load.torque - truth.torque).norm(), 4) + "; volume " +
            format_number(load.volume, 12) + ", bound " + format_number(load.volume_bound, 4) + ", error " +
            format_number(std::abs(load.volume - truth.volume), 4) + (load.capped ? ", capped" : "") +
            (load.too_steep ? ", too steep" : "") + ", " + std::to_string(load.patches) + " patches\n";
  }
  return text;
}

WaveSearchStats stats_of(const Group& group) {
  WaveSearchStats stats;
  for (const auto& run : group.runs) {
    const Checked checked = check_run(group.mesh, *run);
    stats.figures[static_cast<std::size_t>(run->request.kind)] += checked.figures;
    if (checked.violations.empty()) continue;
    ++stats.failed_cases;
    stats.failures.push_back({run->number,
                              "  " + group.mesh.kind + ", volume " +
                                  format_number(group.mesh.mesh.volume, 9) + " m^3\n" +
                                  describe(run->request) + results_text(*run, checked.truth),
                              checked.violations});
  }
  return stats;
}

template <typename Work>
void in_parallel(std::size_t count, unsigned threads, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto loop = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> others;
  for (unsigned n = 1; n < threads; ++n) others.emplace_back(loop);
  loop();
}

}  // namespace

void RatioHistogram::add(double ratio) {
  const double place = std::isfinite(ratio) ? kBinsPerDecade * std::log10(ratio) : kBins - 1.0;
  ++counts[static_cast<std::size_t>(std::clamp(place, 0.0, kBins - 1.0))];
}

RatioHistogram& RatioHistogram::operator+=(const RatioHistogram& other) {
  for (std::size_t i = 0; i < kBins; ++i) counts[i] += other.counts[i];
  return *this;
}

double RatioHistogram::median() const {
  std::int64_t total = 0;
  for (const std::int64_t count : counts) total += count;
  std::int64_t below = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    below += counts[i];
    if (2 * below >= total && total > 0) {
      return std::pow(10.0, (static_cast<double>(i) + 0.5) / kBinsPerDecade);
    }
  }
  return 0.0;
}

WaveFigures& WaveFigures::operator+=(const WaveFigures& other) {
  cases += other.cases;
  loads += other.loads;
  undecided += other.undecided;
  capped += other.capped;
  too_steep += other.too_steep;
  long_waves += other.long_waves;
  long_within += other.long_within;
  const auto keep_larger = [](LargestInWaves& largest, const LargestInWaves& candidate) {
    if (candidate.value > largest.value) largest = candidate;
  };
  keep_larger(force, other.force);
  keep_larger(torque, other.torque);
  keep_larger(volume, other.volume);
  ratios += other.ratios;
  return *this;
}

std::int64_t WaveSearchStats::cases() const {
  return total().cases;
}

WaveFigures WaveSearchStats::total() const {
  WaveFigures sum;
  for (const WaveFigures& of_kind : figures) sum += of_kind;
  return sum;
}

WaveSearchStats& WaveSearchStats::operator+=(const WaveSearchStats& other) {
  failed_cases += other.failed_cases;
  for (std::size_t i = 0; i < figures.size(); ++i) figures[i] += other.figures[i];
  for (const FailedWaveCase& failure : other.failures) {
    if (failures.size() < kMaxFailures) failures.push_back(failure);
  }
  return *this;
}

WaveLoad product_load(const WaveBody& body, const SeaExpansion& expansion, const SeaSnapshot& sea,
                      const WaveRequest& request) {
  return wave_load(body, expansion, sea, request.pose, request.reference_B);
}

WaveSearchStats search_waves(std::uint64_t seed, std::int64_t begin, std::int64_t end, unsigned threads,
                             const EvaluateWaves& evaluate) {
  std::vector<Group> groups(static_cast<std::size_t>((end - begin) / kWaveCasesPerMesh));
  const std::int64_t first = begin / kWaveCasesPerMesh;
  in_parallel(groups.size(), threads,
              [&](std::size_t i) { groups[i] = make_group(seed, first + static_cast<std::int64_t>(i)); });
  const std::vector<std::string> targets = simd_targets();
  for (std::size_t t = 0; t < targets.size(); ++t) {
    force_simd_target(targets[t]);
    in_parallel(groups.size(), threads, [&](std::size_t i) {
      for (const auto& run : groups[i].runs) {
        const auto number = static_cast<std::size_t>(run->number);
        if (number % targets.size() == t || run->number % kAllTargetsEvery == 0) {
          evaluate_run(groups[i].mesh, *run, targets[t], evaluate);
        }
      }
    });
  }
  force_simd_target("");
  std::vector<WaveSearchStats> of_groups(groups.size());
  in_parallel(groups.size(), threads, [&](std::size_t i) { of_groups[i] = stats_of(groups[i]); });
  WaveSearchStats total;
  for (const WaveSearchStats& stats : of_groups) total += stats;
  return total;
}

WaveReplay replay_wave_case(std::uint64_t seed, std::int64_t number, const EvaluateWaves& evaluate) {
  const Group group = make_group(seed, number / kWaveCasesPerMesh);
  Run& run = *group.runs[static_cast<std::size_t>(number % kWaveCasesPerMesh)];
  for (const std::string& target : simd_targets()) {
    force_simd_target(target);
    evaluate_run(group.mesh, run, target, evaluate);
  }
  force_simd_target("");
  Checked checked = check_run(group.mesh, run);
  return {"  " + group.mesh.kind + ", volume " + format_number(group.mesh.mesh.volume, 9) + " m^3\n" +
              describe(run.request) + results_text(run, checked.truth),
          std::move(checked.violations)};
}

}  // namespace buoyancy
