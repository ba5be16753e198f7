#include "view/report/row_evaluation.h"

#include <algorithm>
#include <map>

#include "engine/state_evaluation.h"
#include "engine/water_at_time.h"
#include "view/common/scene_model.h"

namespace buoyancy::view {
namespace {

LoadRow unknown_loads() {
  LoadRow row;
  row.fill(kUnknown);
  return row;
}

LoadRow to_row(const BodyLoads& loads) {
  LoadRow row = unknown_loads();
  const auto put = [&row](std::size_t first, const std::array<double, 3>& values) {
    std::ranges::copy(values, row.begin() + static_cast<std::ptrdiff_t>(first));
  };
  row[kImmersion] = loads.immersion;
  put(kBuoyancyLoad, loads.buoyancy_force);
  put(kBuoyancyLoad + 3, loads.buoyancy_torque);
  put(kDragLoad, loads.drag_force);
  put(kDragLoad + 3, loads.drag_torque);
  put(kAddedMassLoad, loads.added_mass_force);
  put(kAddedMassLoad + 3, loads.added_mass_torque);
  put(kWaterVelocity, loads.water_velocity);
  return row;
}

WaterState water_of(const RowLoads& row, const Scene& scene, WaterAtTime& water) {
  if (!has_waves(scene)) return water.move_to(row.utime, row.lead_time).water;
  return row.sea ? water.move_to(row.sea, row.utime, row.lead_time).water : WaterState{};
}

}  // namespace

void add_loads(const Scene& scene, const Body& body, const std::vector<KeptRow>& rows, BodyRun& run) {
  WaterAtTime water(scene);
  run.loads.reserve(rows.size());
  for (const KeptRow& row : rows) {
    run.loads.push_back(unknown_loads());
    if (row.values[kStatus] != 0.0) continue;
    const RowLoads& source = *row.loads;
    if (source.recorded && source.recorded->status == BodyStatus::kOk) {
      run.loads.back() = to_row(*source.recorded);
      ++run.loads_recorded;
      continue;
    }
    const std::optional<BodyLoads> computed =
        evaluate_state(body, water_of(source, scene, water), scene.current(), source.state, source.lead_time,
                       row.condition.get())
            .loads;
    if (!computed) continue;
    run.loads.back() = to_row(*computed);
    ++run.loads_computed;
  }
}

void add_conditions(const Subdivision& subdivision, const std::vector<KeptRow>& rows, BodyRun& run) {
  const BodyCondition initial = initial_condition(subdivision);
  const auto is_initial = [&initial](const KeptRow& row) {
    return row.condition && *row.condition == initial;
  };
  if (std::ranges::all_of(rows, is_initial)) return;
  std::map<const BodyCondition*, std::uint32_t> places;
  run.condition_of_row.reserve(rows.size());
  for (const KeptRow& row : rows) {
    const auto [place, is_new] =
        places.emplace(row.condition.get(), static_cast<std::uint32_t>(run.conditions.size()));
    if (is_new) {
      run.conditions.push_back(row.condition ? std::optional(*row.condition) : std::nullopt);
    }
    run.condition_of_row.push_back(place->second);
  }
}

}  // namespace buoyancy::view
