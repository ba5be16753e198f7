#include "tests/random_search/wave_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "base/format.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "tests/truth/reference_load.h"
#include "waves/sea_snapshot.h"

namespace buoyancy {
namespace {

constexpr std::int64_t kAllTargetsEvery = 16;
constexpr double kGoal = 0.05;  // of the oracle's error, over the bound
constexpr double kUndecided = 0.1;

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
  WaveSearchBody mesh;
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

void evaluate_run(const WaveSearchBody& mesh, Run& run, const std::string& target,
                  const EvaluateWaves& evaluate) {
  const WaveBody body{&mesh.mesh, &mesh.tree, run.request.tolerance};
  run.loads.push_back({target, evaluate(body, run.expansion, run.snapshot, run.request)});
}

ReferenceSea reference_sea_of(const WaveSearchBody& mesh, const Run& run) {
  return {run.sea, run.request.utime, run.request.lead_time, run.request.pose, mesh.mesh.center_B};
}

// With errors well below the smallest bound.
ReferenceLoad truth_of(const WaveSearchBody& mesh, const Run& run, const ReferenceSea& sea) {
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
void compare_seas(const WaveSearchBody& mesh, const Run& run, const ReferenceSea& reference,
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
bool has_long_waves(const WaveSearchBody& mesh, const Sea& sea) {
  double amplitudes = 0.0;
  double slopes = 0.0;
  for (std::size_t i = 0; i < sea.prepared().size(); ++i) {
    amplitudes += sea.prepared().amplitude[i];
    slopes += sea.prepared().amplitude[i] * sea.prepared().wave_number[i];
  }
  return 2.0 * std::numbers::pi * amplitudes > 2.0 * mesh.mesh.diagonal * slopes;
}

struct Checked {
  SearchFigures figures;
  std::vector<std::string> violations;
  ReferenceLoad truth;
};

// An error of a load, its bound, and what the truth is off.
struct ErrorInWaves {
  const char* what;
  double error, bound, of_truth;

  bool is_undecided() const { return of_truth > kUndecided * bound && bound > 0.0; }
};

std::array<ErrorInWaves, 3> errors_of(const WaveLoad& load, const ReferenceLoad& truth) {
  return {{{"force", (load.force - truth.force).norm(), load.force_bound, truth.force_error},
           {"torque", (load.torque - truth.torque).norm(), load.torque_bound, truth.torque_error},
           {"volume", std::abs(load.volume - truth.volume), load.volume_bound, truth.volume_error}}};
}

Checked check_run(const WaveSearchBody& mesh, const Run& run) {
  Checked checked;
  const ReferenceSea sea = reference_sea_of(mesh, run);
  compare_seas(mesh, run, sea, checked.violations);
  checked.truth = truth_of(mesh, run, sea);
  SearchFigures& figures = checked.figures;
  const auto count = [&figures](const char* what, bool holds) { figures.counts[what] += holds ? 1 : 0; };
  bool undecided = false;
  bool within = true;
  bool capped = false;
  bool too_steep = false;
  for (const TargetLoad& of_target : run.loads) {
    const WaveLoad& load = of_target.load;
    count("loads", true);
    if (!is_finite(load)) {
      checked.violations.push_back("not finite, on " + of_target.target);
      continue;
    }
    const auto errors = errors_of(load, checked.truth);
    for (const ErrorInWaves& one : errors) {
      undecided |= one.is_undecided();
      if (one.error <= one.bound + one.of_truth) continue;
      checked.violations.push_back(violation(one.what, of_target.target, one.error, one.bound, one.of_truth));
    }
    within &= load.force_bound <= run.request.tolerance * mesh.mesh.volume;
    capped |= load.capped;
    too_steep |= load.too_steep;
    if (!(load.force_bound > 0.0) || undecided) continue;
    for (const ErrorInWaves& one : errors) {
      // The volume of a body that is wet everywhere is exact.
      if (one.bound > 0.0) figures.largest[one.what].add(one.error / one.bound, run.number);
    }
    figures.add_ratio(load.force_bound / errors[0].error);
  }
  const bool long_waves = has_long_waves(mesh, run.sea);
  count("cases", true);
  count("undecided", undecided);
  count("capped", capped);
  count("too steep", too_steep);
  count("in long waves", long_waves);
  count("in long waves within the tolerance", long_waves && within);
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

std::string text_of(const WaveSearchBody& mesh, const Run& run, const ReferenceLoad& truth) {
  return "  " + mesh.kind + ", volume " + format_number(mesh.mesh.volume, 9) + " m^3\n" +
         describe(run.request) + results_text(run, truth);
}

SearchStats stats_of(const Group& group) {
  SearchStats stats;
  for (const auto& run : group.runs) {
    const Checked checked = check_run(group.mesh, *run);
    ++stats.cases;
    stats.rows[std::string(to_string(run->request.kind))] += checked.figures;
    if (checked.violations.empty()) continue;
    stats.add_violations(run->number, text_of(group.mesh, *run, checked.truth), checked.violations);
  }
  return stats;
}

double percent(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 100.0;
}

}  // namespace

WaveLoad product_load(const WaveBody& body, const SeaExpansion& expansion, const SeaSnapshot& sea,
                      const WaveRequest& request) {
  return wave_load(body, expansion, sea, request.pose, request.reference_B);
}

SearchStats search_waves(std::uint64_t seed, std::int64_t begin, std::int64_t end, unsigned threads,
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
  return sum_in_parallel(groups.size(), threads, [&](std::size_t i) { return stats_of(groups[i]); });
}

SearchFigures check_wave_load(const WaveSearchBody& mesh, const WaveRequest& request) {
  Run run(request, 0);
  evaluate_run(mesh, run, simd_target(), product_load);
  return check_run(mesh, run).figures;
}

SearchFailure replay_wave_case(std::uint64_t seed, std::int64_t number, const EvaluateWaves& evaluate) {
  const Group group = make_group(seed, number / kWaveCasesPerMesh);
  Run& run = *group.runs[static_cast<std::size_t>(number % kWaveCasesPerMesh)];
  for (const std::string& target : simd_targets()) {
    force_simd_target(target);
    evaluate_run(group.mesh, run, target, evaluate);
  }
  force_simd_target("");
  Checked checked = check_run(group.mesh, run);
  return {number, text_of(group.mesh, run, checked.truth), std::move(checked.violations)};
}

RandomSearch wave_search() {
  RandomSearch one;
  one.name = "waves";
  one.description = "Search for a load in waves that violates its bound";
  one.unit = kWaveCasesPerMesh;
  one.first_column = "sea";
  one.has_total = true;
  one.run = [](std::uint64_t seed, std::int64_t begin, std::int64_t end, unsigned threads) {
    return search_waves(seed, begin, end, threads, product_load);
  };
  one.replay = [](std::uint64_t seed, std::int64_t number) {
    return replay_wave_case(seed, number, product_load);
  };
  for (const SeaKind kind : kSeaKinds) one.rows.emplace_back(to_string(kind));
  one.columns = {count_column("cases", "cases"),
                 largest_column("largest error / bound, force", "force"),
                 largest_column("torque", "torque"),
                 largest_column("volume", "volume"),
                 {"median bound / error",
                  [](const SearchFigures& figures) { return format_number(figures.median_ratio(), 3); }},
                 {"long waves: bound within the tolerance",
                  [](const SearchFigures& figures) {
                    return format_number(percent(figures.count("in long waves within the tolerance"),
                                                 figures.count("in long waves")),
                                         4) +
                           " %";
                  }},
                 count_column("capped", "capped"),
                 count_column("too steep", "too steep"),
                 count_column("undecided", "undecided")};
  return one;
}

}  // namespace buoyancy
