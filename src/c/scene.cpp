// Scenes of the C interface.
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "c/pose_arguments.h"
#include "hydrostatics/hydrostatics.h"

namespace buoyancy {
namespace {

CallResult store_scene(const Expected<SceneDescription>& description, buoyancy_scene** out) {
  if (!description) return failure(BUOYANCY_ERROR_SCENE, description.error());
  Expected<Scene> scene = Scene::prepare(*description);
  if (!scene) return failure(BUOYANCY_ERROR_SCENE, std::move(scene.error()));
  hand_over(std::make_unique<buoyancy_scene>(*std::move(scene), description->sea), out);
  return {};
}

bool has_hydrostatics(const buoyancy_scene& scene, const Body& body) {
  return body.solver.mesh().tree.has_value() && scene.water.waves == nullptr && scene.water.is_known;
}

// Returns a failure unless the scene has the body.
CallResult find_body(const buoyancy_scene& scene, std::int32_t id, const Body*& body) {
  body = scene.scene.find(id);
  if (body != nullptr) return {};
  return failure(BUOYANCY_ERROR_SCENE,
                 {scene.scene.name(), "body_id = " + std::to_string(id), "the id of a body of the scene", "",
                  "buoyancy_scene_get_body() lists them"});
}

void set_info(const buoyancy_scene& scene, const Body& body, buoyancy_body_info& info) {
  constexpr std::array kMethods{BUOYANCY_METHOD_FAST,          BUOYANCY_METHOD_IMPROVED,
                                BUOYANCY_METHOD_EXACT,         BUOYANCY_METHOD_FAST_SURFACE,
                                BUOYANCY_METHOD_EXACT_SURFACE, BUOYANCY_METHOD_HIERARCHICAL};
  static_assert(kMethods.size() == kAllMethods.size());
  info.name = body.name.c_str();
  info.id = body.id;
  info.method = kMethods[static_cast<std::size_t>(body.solver.method())];
  info.tolerance = body.solver.tolerance();
  const Vec3 center = body.center_of_mass_B.value_or(Vec3::Constant(kNaN));
  for (int axis = 0; axis < 3; ++axis) {
    info.reference_point[axis] = body.reference_B[axis];
    info.center_of_mass[axis] = center[axis];
  }
  info.volume = body.prepared_mesh->report.volume;
  info.triangles = body.prepared_mesh->report.triangles;
  info.has_loads = body.hydrodynamics != nullptr ? 1 : 0;
  info.has_hydrostatics = has_hydrostatics(scene, body) ? 1 : 0;
}

void evaluate_with_loads(const Body& body, const QueryWater& water, const PoseArrays& poses,
                         const WrenchArrays& wrenches, const buoyancy_loads& loads, unsigned threads) {
  std::vector<BodyLoads> block;
  for (std::size_t first = 0; first < poses.size(); first += kBlock) {
    const std::size_t n = std::min(kBlock, poses.size() - first);
    block.assign(n, BodyLoads{});  // poses that cannot be evaluated keep the zeros
    evaluate_poses(body, water, part_of(poses, first, n), part_of(wrenches, first, n), block, threads);
    store_loads(block, loads, first);
  }
}

}  // namespace
}  // namespace buoyancy

using buoyancy::ArgumentChecks;
using buoyancy::CallResult;
using buoyancy::run_call;

buoyancy_error buoyancy_scene_load(const char* path, buoyancy_scene** scene) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_scene_load");
    checks.out_handle("scene", scene);
    const std::string_view file = checks.text("path", path);
    if (checks.failed()) return checks.failure();
    const auto description = buoyancy::read_scene_file(file);
    if (!description && !buoyancy::is_readable_file(file)) {
      return buoyancy::failure(BUOYANCY_ERROR_FILE, description.error());
    }
    return buoyancy::store_scene(description, scene);
  });
}

buoyancy_error buoyancy_scene_from_toml(const char* toml, const char* directory, buoyancy_scene** scene) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_scene_from_toml");
    checks.out_handle("scene", scene);
    const std::string_view text = checks.text("toml", toml);
    if (checks.failed()) return checks.failure();
    return buoyancy::store_scene(buoyancy::parse_scene(text, "scene", directory == nullptr ? "" : directory),
                                 scene);
  });
}

buoyancy_error buoyancy_scene_free(buoyancy_scene* scene) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_scene_free");
    checks.free("scene", scene);
    return checks.failure();
  });
}

buoyancy_error buoyancy_scene_sea(const buoyancy_scene* scene, buoyancy_sea** sea) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_scene_sea");
    checks.out_handle("sea", sea);
    const buoyancy_scene* const of = checks.handle("scene", scene);
    if (checks.failed()) return checks.failure();
    if (!of->water.is_known) {
      return buoyancy::failure(
          BUOYANCY_ERROR_SCENE,
          {of->scene.name(), buoyancy::to_string(of->scene.sea_messages()), "the wave systems themselves",
           "no messages are received in a query", "List the systems in the scene"});
    }
    buoyancy::Expected<buoyancy::QuerySea> made = buoyancy::QuerySea::make(of->sea, of->scene.water());
    if (!made) return buoyancy::failure(BUOYANCY_ERROR_SCENE, std::move(made.error()));
    buoyancy::hand_over(std::make_unique<buoyancy_sea>(*std::move(made)), sea);
    return {};
  });
}

buoyancy_error buoyancy_scene_body_count(const buoyancy_scene* scene, int64_t* count) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_scene_body_count");
    const buoyancy_scene* const of = checks.handle("scene", scene);
    checks.not_null("count", count);
    if (!checks.failed()) *count = static_cast<std::int64_t>(of->scene.bodies().size());
    return checks.failure();
  });
}

buoyancy_error buoyancy_scene_get_body(const buoyancy_scene* scene, int64_t index, buoyancy_body_info* info) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_scene_get_body");
    const buoyancy_scene* const of = checks.handle("scene", scene);
    buoyancy_body_info* const out = checks.output("info", info);
    if (checks.failed()) return checks.failure();
    checks.count("index", index, static_cast<std::int64_t>(of->scene.bodies().size()) - 1);
    if (!checks.failed()) {
      buoyancy::set_info(*of, of->scene.bodies()[static_cast<std::size_t>(index)], *out);
    }
    return checks.failure();
  });
}

buoyancy_error buoyancy_scene_query(const buoyancy_scene* scene, int32_t body_id, const buoyancy_poses* poses,
                                    const buoyancy_wrenches* wrenches, const buoyancy_loads* loads,
                                    int32_t threads) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_scene_query");
    const buoyancy_scene* const of = checks.handle("scene", scene);
    const buoyancy::PoseArrays at = buoyancy::check_poses(checks, poses);
    const unsigned on = checks.threads(threads);
    if (loads != nullptr && checks.given("loads", loads) != nullptr) {
      buoyancy::check_loads(checks, *loads, at.size());
    }
    const buoyancy::WrenchOutput out(checks, wrenches, at.size());
    if (checks.failed()) return checks.failure();
    const buoyancy::Body* body = nullptr;
    if (CallResult missing = buoyancy::find_body(*of, body_id, body)) return missing;
    if (loads == nullptr) {
      evaluate_poses(*body, of->water, at, out.arrays(), {}, on);
    } else {
      buoyancy::evaluate_with_loads(*body, of->water, at, out.arrays(), *loads, on);
    }
    return {};
  });
}

buoyancy_error buoyancy_scene_hydrostatics(const buoyancy_scene* scene, int32_t body_id,
                                           const buoyancy_poses* poses,
                                           const buoyancy_hydrostatics* hydrostatics, int32_t threads) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_scene_hydrostatics");
    const buoyancy_scene* const of = checks.handle("scene", scene);
    const buoyancy::PoseArrays at = buoyancy::check_poses(checks, poses);
    const unsigned on = checks.threads(threads);
    if (checks.given("hydrostatics", hydrostatics) != nullptr) {
      buoyancy::check_hydrostatics(checks, *hydrostatics, at.size());
    }
    if (checks.failed()) return checks.failure();
    const buoyancy::Body* body = nullptr;
    if (CallResult missing = buoyancy::find_body(*of, body_id, body)) return missing;
    if (!buoyancy::has_hydrostatics(*of, *body)) {
      return buoyancy::failure(
          BUOYANCY_ERROR_SCENE,
          {of->scene.name(), "body " + std::to_string(body_id) + " has no hydrostatics",
           "a scene without waves, and the method hierarchical or the output \"hydrostatics\"", "",
           "Add outputs = [\"wrench\", \"hydrostatics\"] to the body, or remove the waves"});
    }
    buoyancy::evaluate_hydrostatics(*body, of->scene.water(), at, *hydrostatics, on);
    return {};
  });
}
